import { describe, expect, it } from 'vitest';
import { backoffMs } from '../src/worker/backoff';
import { DecodeQueue, isOlder, replaces, type EncodedFrame } from '../src/worker/decode_queue';
import { kFrameFinal, kFrameFull, kFrameLossless, type FrameHeader } from '../src/protocol/messages.gen';

const kLossless = kFrameFull | kFrameLossless | kFrameFinal;
const header = (frameId: number, sceneRevision = 1, viewRevision = 1, flags = kFrameFull) =>
  ({ frameId, sceneRevision, viewRevision, flags }) as FrameHeader;
const frame = (...args: Parameters<typeof header>): EncodedFrame => ({
  header: header(...args),
  payload: new Uint8Array(),
  receivedMs: 0,
});

/** A queue whose decoder waits for `finish`. */
function makeQueue() {
  const log: string[] = [];
  const open: (() => void)[] = [];
  const queue = new DecodeQueue<number>({
    decode: (f) =>
      new Promise((resolve, reject) =>
        open.push(() => (f.payload.length > 0 ? reject(new Error('bad')) : resolve(f.header.frameId))),
      ),
    present: async (f) => void log.push(`shown ${f.header.frameId}`),
    discard: (picture) => void log.push(`discarded ${picture}`),
    acknowledge: (f, dropped) => void log.push(`${dropped ? 'dropped' : 'acked'} ${f.header.frameId}`),
    failed: (f) => void log.push(`failed ${f.header.frameId}`),
  });
  const settle = () => new Promise((resolve) => setTimeout(resolve));
  const finish = async () => {
    open.shift()?.();
    await settle();
  };
  return { queue, log, finish };
}

describe('DecodeQueue', () => {
  it('shows frames in order and acknowledges after showing', async () => {
    const { queue, log, finish } = makeQueue();
    queue.push(frame(1));
    await finish();
    queue.push(frame(2));
    await finish();
    expect(log).toEqual(['shown 1', 'acked 1', 'shown 2', 'acked 2']);
  });

  it('keeps only the newest of those that wait, and says so', async () => {
    const { queue, log, finish } = makeQueue();
    [1, 2, 3].forEach((id) => queue.push(frame(id)));
    await finish();
    await finish();
    expect(log).toEqual(['dropped 2', 'shown 1', 'acked 1', 'shown 3', 'acked 3']);
  });

  it('does not drop a lossless frame for a lossy one of the same state', async () => {
    const { queue, log, finish } = makeQueue();
    queue.push(frame(1));
    queue.push(frame(2, 1, 1, kLossless));
    queue.push(frame(3));
    for (let i = 0; i < 3; i++) await finish();
    expect(log).toContain('shown 2');
    expect(log.filter((line) => line.startsWith('dropped'))).toEqual([]);
  });

  it('never goes back to an older revision', async () => {
    const { queue, log, finish } = makeQueue();
    queue.push(frame(1, 5, 5));
    await finish();
    queue.push(frame(2, 4, 6));
    await finish();
    expect(log).toEqual(['shown 1', 'acked 1', 'dropped 2']);
  });

  it('starts anew on a new connection: old frames are neither shown nor acknowledged', async () => {
    const { queue, log, finish } = makeQueue();
    queue.push(frame(8, 9, 9));
    queue.push(frame(9, 9, 9));
    queue.reset();
    queue.push(frame(1, 1, 1));
    await finish();
    await finish();
    expect(log).toEqual(['discarded 8', 'shown 1', 'acked 1']);
  });

  it('gives the credit of a frame that cannot be decoded back', async () => {
    const { queue, log, finish } = makeQueue();
    queue.push({ ...frame(1), payload: new Uint8Array(1) });
    await finish();
    queue.push(frame(2));
    await finish();
    expect(log).toEqual(['failed 1', 'dropped 1', 'shown 2', 'acked 2']);
  });
});

describe('replaces', () => {
  it.each([
    ['a newer frame of the same state', header(2), header(1), true],
    ['a newer state over a lossless frame', header(2, 2, 1), header(1, 1, 1, kLossless), true],
    ['lossy over lossless', header(2), header(1, 1, 1, kLossless), false],
    ['an older scene', header(2, 1, 5), header(1, 2, 5), false],
    ['a part of a picture', header(2, 1, 1, 0), header(1), false],
  ])('%s', (_, next, waiting, expected) => expect(replaces(next, waiting)).toBe(expected));
  it('orders revisions', () => {
    expect(isOlder(header(1, 1, 2), header(1, 1, 3))).toBe(true);
    expect(isOlder(header(1, 1, 3), header(1, 1, 3))).toBe(false);
  });
});

describe('backoffMs', () => {
  it('doubles from 250 ms to 8 s, with jitter of a half', () => {
    const high = [0, 1, 2, 3, 4, 5, 6, 20].map((attempt) => backoffMs(attempt, () => 1));
    expect(high).toEqual([250, 500, 1000, 2000, 4000, 8000, 8000, 8000]);
    expect(backoffMs(3, () => 0)).toBe(1000);
  });
});
