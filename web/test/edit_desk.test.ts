import { describe, expect, it } from 'vitest';
import type { FrameReport, Outgoing } from '../src/channel';
import { describeOutcome } from '../src/panels/ledger';
import type { Edit, FrameHeader, SceneMessage, View } from '../src/protocol/messages.gen';
import { EditDesk, type Outcome } from '../src/state/edit_desk';

function makeDesk() {
  const posted: { ticket: number; message: Outgoing }[] = [];
  const shown: Edit[] = [];
  const outcomes: Outcome[] = [];
  let frames: ((now: number) => void)[] = [];
  let clock = 1000;
  const desk = new EditDesk({
    show: (edit) => void shown.push(edit),
    post: (ticket, message) => void posted.push({ ticket, message }),
    requestFrame: (callback) => void frames.push(callback),
    now: () => clock,
    onOutcome: (outcome) => void outcomes.push(outcome),
  });
  const displayFrame = (now: number) => {
    clock = 1000 + now;
    const due = frames;
    frames = [];
    due.forEach((callback) => callback(now));
  };
  return { desk, posted, shown, outcomes, displayFrame };
}

const picture = (ackSeq: number, presentedMs: number, dropped = false, sceneRevision = 2) =>
  ({ header: { ackSeq, sceneRevision } as FrameHeader, presentedMs, dropped }) as FrameReport;
const roughness = (value: number) => ({ target: 'material', material: 2, roughness: value }) as const;
const ack = (seq: number, cost: 'relight' | 'none' | 're-gather' = 'relight', superseded = false) =>
  ({ op: 'ack', seq, cost, sceneRevision: 2, viewRevision: 1, superseded }) as const;

describe('EditDesk', () => {
  it('sends the newest of a field once a display frame, and other fields beside it', () => {
    const { desk, posted, displayFrame } = makeDesk();
    desk.set('Roughness', roughness(0.1));
    desk.set('Roughness', roughness(0.2));
    desk.set('Metallic', { target: 'material', material: 2, metallic: 1 });
    desk.set('Roughness', { target: 'material', material: 3, roughness: 0.9 });
    displayFrame(100);
    expect(posted.map((p) => p.message)).toEqual([
      { op: 'set', ...roughness(0.2) },
      { op: 'set', target: 'material', material: 2, metallic: 1 },
      { op: 'set', target: 'material', material: 3, roughness: 0.9 },
    ]);
  });

  it('waits for its turn on displays faster than 60 Hz', () => {
    const { desk, posted, displayFrame } = makeDesk();
    for (let now = 0; now < 1000; now += 1000 / 240) {
      desk.set('Roughness', roughness(now / 1000));
      displayFrame(now);
    }
    expect(posted.length).toBeLessThanOrEqual(61);
    expect(posted.length).toBeGreaterThan(40);
  });

  it('follows an edit from the input to the first picture that shows it', () => {
    const { desk, posted, outcomes, displayFrame } = makeDesk();
    desk.set('Roughness', roughness(0.1));
    displayFrame(16);
    desk.onSent(posted[0]!.ticket, 7);
    desk.onAck(ack(7));
    expect(desk.onFrame(picture(6, 1100))).toEqual([]);
    expect(desk.onFrame(picture(7, 1150, true))).toEqual([]);
    expect(desk.onFrame(picture(8, 1180))).toEqual([180]);
    expect(desk.onFrame(picture(9, 1300))).toEqual([]);
    expect(outcomes.map(describeOutcome)).toEqual([
      'Roughness: relight …',
      'Roughness: relight, 0.18 s to first pixels',
    ]);
  });

  it('waits for an image that is read while later edits are shown', () => {
    const { desk, posted, outcomes, displayFrame } = makeDesk();
    desk.set('Image', { target: 'environment', image: 'sky.hdr' });
    displayFrame(16);
    desk.onSent(posted[0]!.ticket, 7);
    expect(desk.onFrame(picture(8, 1100, false, 1))).toEqual([]); // of an edit that was sent after it
    expect(outcomes).toEqual([]);
    desk.onAck(ack(7));
    expect(desk.onFrame(picture(8, 1200, false, 1))).toEqual([]); // was on its way when the image was taken up
    expect(desk.onFrame(picture(8, 1300, false, 2))).toEqual([300]);
  });

  it('does not wait for an image that is taken away', () => {
    const { desk, posted, displayFrame } = makeDesk();
    desk.set('Image', { target: 'environment', image: '' });
    displayFrame(16);
    desk.onSent(posted[0]!.ticket, 7);
    expect(desk.onFrame(picture(7, 1100, false, 1))).toEqual([100]);
  });

  it('asks for no picture where nothing changed', () => {
    const { desk, posted, outcomes, displayFrame } = makeDesk();
    desk.set('Roughness', roughness(0.1));
    displayFrame(16);
    desk.onSent(posted[0]!.ticket, 3);
    desk.onAck(ack(3, 'none'));
    expect(outcomes.map(describeOutcome)).toEqual(['Roughness: nothing changed']);
  });

  it('tells of refused, unsent and lost edits', () => {
    const { desk, posted, outcomes, displayFrame } = makeDesk();
    ['A', 'B', 'C'].forEach((label, i) => desk.set(label, { target: 'light', light: i, intensity: 1 }));
    displayFrame(16);
    desk.onSent(posted[0]!.ticket, 4);
    desk.onSent(posted[1]!.ticket, null, 'there is no connection');
    desk.onSent(posted[2]!.ticket, 5);
    expect(
      desk.onError({ op: 'error', seq: 4, code: 'out-of-range', message: 'too much', place: 'seq 4 /intensity' }),
    ).toBe(true);
    expect(desk.onError({ op: 'error', seq: 99, code: 'busy', message: 'somebody else' })).toBe(false);
    desk.onDisconnected();
    expect(outcomes.map(describeOutcome)).toEqual([
      'B: not sent: there is no connection',
      'A: too much (seq 4 /intensity)',
      'C: the connection broke before the server answered',
    ]);
  });

  it('knows while the camera is on its way', () => {
    const { desk, posted } = makeDesk();
    desk.camera({ eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0] });
    desk.onSent(posted[0]!.ticket, 2);
    expect(desk.cameraPending()).toBe(true);
    desk.onAck(ack(2, 're-gather', true));
    expect(desk.cameraPending()).toBe(false);
  });

  it('shows every edit at once, those of the camera too', () => {
    const { desk, posted, shown } = makeDesk();
    const view: View = { eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0], yfov: 0.5 };
    desk.set('Roughness', roughness(0.1));
    desk.camera(view);
    expect(shown).toEqual([roughness(0.1), { target: 'camera', view }]);
    expect(posted.map((p) => p.message)).toEqual([{ op: 'camera', ...view }]); // the other waits for the display frame
  });

  it('is settled when every edit is on the screen, refused, or changed nothing', () => {
    const { desk, posted, displayFrame } = makeDesk();
    expect(desk.settled()).toBe(true);
    for (const value of [0.1, 0.2, 0.3]) {
      desk.set('Roughness', roughness(value));
      expect(desk.settled()).toBe(false); // waits for the display frame
      displayFrame(1000 * value);
    }
    posted.forEach(({ ticket }, i) => desk.onSent(ticket, 7 + i));
    desk.onAck(ack(7));
    desk.onAck(ack(8, 'none'));
    desk.onError({ op: 'error', seq: 9, code: 'out-of-range', message: 'too much' });
    expect(desk.settled()).toBe(false); // the first has no picture yet
    desk.onFrame(picture(7, 1400));
    expect(desk.settled()).toBe(true);
  });

  it('keeps what was edited over descriptions that were made before it', () => {
    const { desk, posted, displayFrame } = makeDesk();
    const parameters = { gain: 1 };
    const told = (roughness: number) =>
      ({ materials: [{}, {}, { roughness }], technique: 'flat', parameters }) as unknown as SceneMessage;
    const shown = (scene: SceneMessage) => desk.ahead(scene).materials[2]?.roughness;
    expect(shown(told(0.5))).toBe(0.5);
    desk.set('Roughness', roughness(0.1));
    expect(shown(told(0.5))).toBe(0.1); // waits for the display frame
    displayFrame(100);
    expect(shown(told(0.5))).toBe(0.1); // is on its way
    desk.set('Roughness', roughness(0.2));
    desk.set('Gain', { target: 'technique', parameters: { gain: 3 } });
    expect(shown(told(0.5))).toBe(0.2);
    expect(desk.ahead(told(0.5)).parameters).toEqual({ gain: 3 });
    displayFrame(200);
    posted.forEach(({ ticket }, i) => desk.onSent(ticket, 7 + i));
    desk.onAck(ack(7));
    expect(shown(told(0.1))).toBe(0.2);
    desk.onAck(ack(8));
    expect(shown(told(0.9))).toBe(0.9); // somebody else edited it after us
    desk.onError({ op: 'error', seq: 9, code: 'out-of-range', message: 'too much' });
    expect(desk.ahead(told(0.9)).parameters).toEqual({ gain: 1 }); // it was refused
  });

  it('keeps the view over descriptions that were made before it', () => {
    const { desk, posted } = makeDesk();
    const told = { view: { eye: [0, 0, 9], yfov: 1 } } as unknown as SceneMessage;
    desk.camera({ eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0] });
    desk.onSent(posted[0]!.ticket, 2);
    expect(desk.ahead(told).view).toEqual({ eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0], yfov: 1 });
    desk.onAck(ack(2, 're-gather'));
    expect(desk.ahead(told).view).toEqual(told.view);
  });
});
