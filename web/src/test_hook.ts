import type { Area, FrameReport, PixelHash } from './channel';
import type { CameraRig } from './camera/rig';
import type { Ack, FrameHeader, Picked } from './protocol/messages.gen';
import type { Model } from './state/model';
import type { EditDesk, Outcome } from './state/edit_desk';
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
  presented: FrameHeader[];
  acks: Ack[];
  outcomes: Outcome[];
  picks: Picked[];
  faults: string[];
  /** True when the picture on the screen holds all that was edited here. */
  settled(): boolean;
  /** SHA-256 over the RGBA bytes of the canvas, row 0 on top. */
  hash(): Promise<PixelHash>;
  /** Mean sRGB value of an area of the canvas, 0..255. */
  mean(area: Area): Promise<[number, number, number]>;
}

declare global {
  interface Window {
    limn: TestHook;
  }
}

const kKept = 100;

export function makeTestHook(
  model: Model,
  statistics: Statistics,
  rig: CameraRig,
  desk: EditDesk,
  link: StreamLink,
): TestHook {
  return {
    model,
    statistics,
    rig,
    frame: null,
    presented: [],
    acks: [],
    outcomes: [],
    picks: [],
    faults: [],
    settled: () => !rig.busy() && desk.settled(),
    hash: () => link.hash(),
    mean: (area) => link.mean(area),
  };
}

export function remember<T>(list: T[], item: T): void {
  list.push(item);
  if (list.length > kKept) list.shift();
}
