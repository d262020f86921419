import { readFileSync } from 'node:fs';
import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import type { ConnectionState } from '../src/channel';
import { encodeServer, type FrameHeader } from '../src/protocol/messages.gen';
import { Connection } from '../src/worker/connection';

const kGolden = new URL('../../protocol/golden/', import.meta.url);
const firstOf = (name: string) => readFileSync(new URL(`${name}.jsonl`, kGolden), 'utf8').split('\n')[0] ?? '';

/** A socket that says only what a test lets it say. */
class FakeSocket {
  static readonly OPEN = 1;
  static newest: FakeSocket;
  readyState = FakeSocket.OPEN;
  onopen?: () => void;
  onmessage?: (event: { data: string | ArrayBuffer }) => void;
  constructor() {
    FakeSocket.newest = this;
  }
  send(): void {}
  close(): void {}
}

/** A description of a scene of which this large a picture is made. */
const sceneOf = (width: number, height: number) =>
  JSON.stringify({ ...(JSON.parse(firstOf('server_scene')) as object), width, height });

function connect() {
  const states: ConnectionState['kind'][] = [];
  const connection = new Connection('ws://x/ws', null, {
    onState: (state) => void states.push(state.kind),
    onOpen: () => {},
    onMessage: () => {},
    onBinary: () => ({ kind: 'file' }) as FrameHeader,
    onFault: () => {},
    hello: () => ({ op: 'hello', version: 1, client: 'test' }),
  });
  connection.open();
  const hear = (data: string | ArrayBuffer) => FakeSocket.newest.onmessage?.({ data });
  FakeSocket.newest.onopen?.();
  hear(firstOf('server_hello'));
  return { states, hear };
}

describe('Connection', () => {
  beforeEach(() => {
    vi.useFakeTimers();
    vi.stubGlobal('WebSocket', FakeSocket);
  });
  afterEach(() => {
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  it('gives up a server that falls silent', () => {
    const { states, hear } = connect();
    expect(states).toEqual(['connecting', 'connected']);
    hear(sceneOf(1, 1));
    vi.advanceTimersByTime(15_000);
    expect(states.at(-1)).toBe('connected');
    vi.advanceTimersByTime(5_000);
    expect(states.at(-1)).toBe('reconnecting');
  });

  it('has more time for the first description, and for a large picture after it', () => {
    const { states, hear } = connect();
    vi.advanceTimersByTime(70_000);
    expect(states.at(-1)).toBe('connected');
    hear(sceneOf(2048, 2048));
    vi.advanceTimersByTime(110_000);
    expect(states.at(-1)).toBe('connected');
    vi.advanceTimersByTime(5_000);
    expect(states.at(-1)).toBe('reconnecting');
  });

  it('waits for a file that was told of, and no longer once it is here', () => {
    const { states, hear } = connect();
    hear(sceneOf(1, 1));
    hear(encodeServer({ op: 'saved', seq: 2, bytes: 65_536 * 60, encoding: 'exr' }));
    vi.advanceTimersByTime(70_000);
    expect(states.at(-1)).toBe('connected');
    hear(new ArrayBuffer(0));
    vi.advanceTimersByTime(20_000);
    expect(states.at(-1)).toBe('reconnecting');
  });
});
