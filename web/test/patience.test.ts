import { describe, expect, it } from 'vitest';
import {
  kFrameFinal,
  kFrameFull,
  kFrameLossless,
  type FrameHeader,
  type Phase,
  type ServerMessage,
} from '../src/protocol/messages.gen';
import { Patience } from '../src/worker/patience';

const kUsualMs = 15_000;
const kFinal = kFrameFull | kFrameLossless | kFrameFinal;
const mebibytes = (count: number) => count * 1024 * 1024;

const status = (phase: Phase) => ({ op: 'status', phase }) as ServerMessage;
const scene = { op: 'scene', width: 1024, height: 512, sceneRevision: 3, viewRevision: 5 } as ServerMessage;
const ack = (sceneRevision: number) => ({ op: 'ack', sceneRevision, viewRevision: 5 }) as ServerMessage;
const frame = (fields: Partial<FrameHeader>) =>
  ({
    kind: 'image',
    flags: kFrameFull,
    fullWidth: 1024,
    fullHeight: 512,
    sceneRevision: 3,
    viewRevision: 5,
    ...fields,
  }) as FrameHeader;

/** At rest: the final picture is here. */
function restingPatience() {
  const patience = new Patience();
  patience.onMessage(scene);
  patience.onFrame(frame({ flags: kFinal }));
  return patience;
}

describe('Patience', () => {
  it('waits for the first description, which may be long', () => {
    const patience = new Patience();
    expect(patience.limitMs()).toBe(kUsualMs + 60_000);
    patience.onMessage(status('converging'));
    expect(patience.limitMs()).toBe(kUsualMs + 60_000);
  });

  it('waits for a saved file as long as a slow link needs, whatever pictures come before it', () => {
    const patience = restingPatience();
    expect(patience.limitMs()).toBe(kUsualMs);
    patience.onMessage({ op: 'saved', seq: 4, bytes: mebibytes(4), encoding: 'exr' });
    patience.onFrame(frame({ flags: kFinal }));
    expect(patience.limitMs()).toBe(kUsualMs + 64_000);
    patience.onFrame(frame({ kind: 'file' }));
    expect(patience.limitMs()).toBe(kUsualMs);
  });

  it('waits for pictures of full quality as long as the final one is not here', () => {
    const patience = new Patience();
    patience.onMessage(scene);
    patience.onMessage(status('converging'));
    expect(patience.limitMs()).toBe(kUsualMs + 12_000);
    patience.onFrame(frame({ fullWidth: 2048 }));
    expect(patience.limitMs()).toBe(kUsualMs + 24_000);
    patience.onFrame(frame({ flags: kFinal }));
    expect(patience.limitMs()).toBe(kUsualMs);
    patience.onMessage(ack(4));
    expect(patience.limitMs()).toBe(kUsualMs + 12_000);
  });

  it('waits for the lossless picture of a converged film, and no longer', () => {
    const patience = new Patience();
    patience.onMessage(scene);
    patience.onMessage(status('converged'));
    expect(patience.limitMs()).toBe(kUsualMs + 24_000);
    patience.onFrame(frame({ flags: kFinal }));
    patience.onMessage(status('converged'));
    expect(patience.limitMs()).toBe(kUsualMs);
  });

  it('waits again after an edit that leaves the film converged', () => {
    const patience = restingPatience();
    patience.onMessage(status('converged'));
    patience.onMessage(ack(4));
    expect(patience.limitMs()).toBe(kUsualMs + 24_000);
    patience.onFrame(frame({ flags: kFinal, sceneRevision: 4 }));
    expect(patience.limitMs()).toBe(kUsualMs);
  });
});
