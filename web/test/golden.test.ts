// The examples in protocol/golden are read and written again byte for byte, as by the C++ side.
import { readFileSync, readdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { describe, expect, it } from 'vitest';
import * as protocol from '../src/protocol/messages.gen';

const kGolden = fileURLToPath(new URL('../../protocol/golden/', import.meta.url));

function lines(side: string): [string, string][] {
  return readdirSync(kGolden)
    .filter((name) => name.startsWith(side) && name.endsWith('.jsonl'))
    .flatMap((name) => readFileSync(kGolden + name, 'utf8').trimEnd().split('\n')
      .map((line, i): [string, string] => [`${name}:${i + 1}`, line]));
}

function frameBytes(name: string): ArrayBuffer {
  const hex = readFileSync(`${kGolden}${name}.hex`, 'utf8').replace(/\s/g, '');
  return Uint8Array.from(hex.match(/../g) ?? [], (byte) => parseInt(byte, 16)).buffer;
}

function failure(action: () => unknown): protocol.ProtocolError {
  try {
    action();
  } catch (error) {
    if (error instanceof protocol.ProtocolError) return error;
    throw error;
  }
  throw new Error('nothing was thrown');
}

describe('golden messages', () => {
  it.each(lines('client_'))('%s is written as it was read', (_place, line) => {
    expect(protocol.encodeClient(protocol.decodeClient(line))).toBe(line);
  });

  it.each(lines('server_'))('%s is written as it was read', (_place, line) => {
    expect(protocol.encodeServer(protocol.decodeServer(line, true))).toBe(line);
  });
});

describe('golden frames', () => {
  it.each(['frame_moving', 'frame_final', 'frame_file'])('%s says what its description says', (name) => {
    const text = readFileSync(`${kGolden}${name}.json`, 'utf8');
    const expected: unknown = JSON.parse(text, (_key, value: unknown) => (value === 'Infinity' ? Infinity : value));
    const frame = protocol.decodeFrame(frameBytes(name));
    expect(frame.header).toEqual(expected);
    expect(frame.payload.length).toBe(frame.header.payloadBytes);
  });

  it.each(['frame_moving', 'frame_final', 'frame_file'])('%s is written as it was read', (name) => {
    const { header, payload } = protocol.decodeFrame(frameBytes(name));
    expect(new Uint8Array(protocol.encodeFrame(header, payload))).toEqual(new Uint8Array(frameBytes(name)));
  });

  it('a changed payload is found by its CRC', () => {
    const bytes = frameBytes('frame_moving');
    new Uint8Array(bytes)[protocol.kFrameHeaderBytes] = 0;
    expect(failure(() => protocol.decodeFrame(bytes)).message).toContain('CRC');
  });

  it('every truncation is refused', () => {
    const bytes = frameBytes('frame_final');
    for (let length = 0; length < bytes.byteLength; ++length) {
      expect(failure(() => protocol.decodeFrame(bytes.slice(0, length))).code).toBe('bad-message');
    }
  });
});

describe('refusals', () => {
  it.each([
    ['not JSON', '{', 'bad-message', ''],
    ['an unknown op', '{"op":"dance","seq":1}', 'unknown-op', '/op'],
    ['an inherited name as op', '{"op":"constructor","seq":1}', 'unknown-op', '/op'],
    ['a missing field', '{"op":"load","seq":1}', 'bad-message', '/uri'],
    ['a number out of range', '{"op":"batch","seq":1,"edits":[{"target":"material","material":0,"roughness":1.5}]}',
      'out-of-range', '/edits/0/roughness'],
    ['an unknown field', '{"op":"ping","seq":1,"extra":1}', 'bad-message', '/extra'],
    ['a wrong count', '{"op":"camera","seq":1,"eye":[0,0],"target":[0,0,0],"up":[0,1,0]}', 'bad-message', '/eye'],
  ])('%s', (_name, json, code, place) => {
    const error = failure(() => protocol.decodeClient(json));
    expect([error.code, error.place]).toEqual([code, place]);
  });

  it('fields of a server that this version does not know are passed over', () => {
    const json = '{"op":"pong","seq":1,"serverSeconds":2,"mood":"fine"}';
    expect(protocol.decodeServer(json)).toEqual({ op: 'pong', seq: 1, serverSeconds: 2 });
    expect(failure(() => protocol.decodeServer(json, true)).place).toBe('/mood');
  });

  it('a message is checked before it is written', () => {
    const error = failure(() => protocol.encodeClient({ op: 'set', seq: 1, target: 'resolve', exposure: NaN }));
    expect(error.place).toBe('/exposure');
  });
});
