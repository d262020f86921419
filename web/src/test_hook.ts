import type { FrameReport, PixelHash } from './channel';
import type { CameraRig } from './camera/rig';
import type { Ack, Picked } from './protocol/messages.gen';
import type { Model } from './state/model';
import type { Outcome } from './state/edit_desk';
import type { Statistics } from './state/statistics';
import type { StreamLink } from './stream_link';

/** What tests and curious people find as `window.limn`. Not an interface for programs: they speak the protocol. */
export interface TestHook {
  model: Model;
  statistics: Statistics;
  rig: CameraRig;
  /** The newest presented frame. */
  frame: FrameReport | null;
  /** The last hundred of each, oldest first. */
  acks: Ack[];
  outcomes: Outcome[];
  picks: Picked[];
  faults: string[];
  /** SHA-256 over the RGBA bytes of the canvas, row 0 on top. */
  hash(): Promise<PixelHash>;
  pixel(x: number, y: number): Promise<[number, number, number, number]>;
}

declare global {
  interface Window { limn: TestHook }
}

const kKept = 100;

export function makeTestHook(model: Model, statistics: Statistics, rig: CameraRig, link: StreamLink): TestHook {
  return {
    model, statistics, rig, frame: null, acks: [], outcomes: [], picks: [], faults: [],
    hash: () => link.hash(),
    pixel: (x, y) => link.pixel(x, y),
  };
}

export function remember<T>(list: T[], item: T): void {
  list.push(item);
  if (list.length > kKept) list.shift();
}
