import { equal, type Vec3 } from '../math/vec3';
import { blend, dolly, forwardOf, frameBox, lookAtPoint, orbit, pan, type Box, type Pose } from './orbit';

// Sixty edits a second at most; a display that ticks faster must not flood the server.
const kMinSendMs = 1000 / 60 - 1;
const kTravelMs = 280;

/** A point of an object that was picked. */
export interface PickedPoint {
  point: Vec3;
  node: number;
}

export interface RigHooks {
  /** Called at most once per animation frame and 60 times a second, only with a pose that differs from the last one. */
  send(pose: Pose): void;
  requestFrame(callback: (nowMs: number) => void): void;
  reducedMotion(): boolean;
}

export const samePose = (a: Pose, b: Pose): boolean =>
  equal(a.eye, b.eye) &&
  equal(a.target, b.target) &&
  equal(a.up, b.up) &&
  a.lens.perspective === b.lens.perspective &&
  a.lens.yfov === b.lens.yfov &&
  a.lens.ymag === b.lens.ymag &&
  a.lens.znear === b.lens.znear;

/** The viewer's camera: gestures change it at any rate, the server hears of it once per animation frame. */
export class CameraRig {
  private pose: Pose | null = null;
  private home: Pose | null = null;
  private sent: Pose | null = null;
  private box: Box = { low: [-1, -1, -1], high: [1, 1, 1] };
  private picked: PickedPoint | null = null;
  private travel: { from: Pose; to: Pose; startMs: number | null } | null = null;
  private lastSendMs = -Infinity;
  private scheduled = false;
  aspect = 1;

  constructor(private readonly hooks: RigHooks) {}

  /** Takes over the server's truth, at connection or when somebody else moved the camera. */
  adopt(pose: Pose): void {
    this.travel = null;
    this.pose = pose;
    this.sent = pose;
    this.home ??= pose;
  }

  /** Where all of the scene is; edits move it, whoever moves the camera. */
  setBounds(box: Box): void {
    this.box = box;
  }

  /** A new scene: its first view is the one that `reset` goes back to. */
  forgetHome(): void {
    this.home = null;
    this.picked = null;
  }

  current(): Pose | null {
    return this.pose;
  }

  /** True while poses wait to be sent; the server's view is then older than ours. */
  busy(): boolean {
    return this.scheduled;
  }

  pivot(): Vec3 {
    return this.picked?.point ?? this.pose?.target ?? [0, 0, 0];
  }

  /** What the camera turns about from now on; null: what it looks at. */
  setPivot(picked: PickedPoint | null): void {
    this.picked = picked;
  }

  /** The picked point, where it is one of `node`. */
  pickedOf(node: number): Vec3 | null {
    return this.picked?.node === node ? this.picked.point : null;
  }

  /** Angles in radians. */
  orbit(yaw: number, pitch: number): void {
    this.change((pose) => orbit(pose, this.pivot(), yaw, pitch));
  }

  /** Shares of the picture's height, to the right and up. */
  pan(right: number, up: number): void {
    this.change((pose) => pan(pose, this.pivot(), right, up));
  }

  dolly(factor: number): void {
    this.change((pose) => dolly(pose, this.pivot(), factor, this.radius()));
  }

  setFieldOfView(yfov: number): void {
    this.change((pose) => ({ ...pose, lens: { ...pose.lens, yfov } }));
  }

  /** All of the scene in the picture, seen from the present direction. */
  frame(): void {
    if (this.pose) this.lookFrom(frameBox(this.pose, this.box, this.aspect));
  }

  /** The picked point in the middle of the picture. */
  centerPicked(): void {
    if (this.pose && this.picked) this.goTo(lookAtPoint(this.pose, this.picked.point));
  }

  reset(): void {
    if (this.home) this.lookFrom(this.home);
  }

  /** Another view: from now on the camera turns about what that looks at, not about what was picked before. */
  lookFrom(pose: Pose): void {
    this.picked = null;
    this.goTo(pose);
  }

  /** Travels to `to` in a quarter of a second, or at once where the person asked for less motion. */
  private goTo(to: Pose): void {
    if (!this.pose) return;
    if (this.hooks.reducedMotion()) {
      this.change(() => to);
      return;
    }
    this.travel = { from: this.pose, to, startMs: null };
    this.schedule();
  }

  private radius(): number {
    const [low, high] = [this.box.low, this.box.high];
    return Math.max(Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) / 2, 1e-9);
  }

  private change(edit: (pose: Pose) => Pose): void {
    if (!this.pose) return;
    const next = edit(this.pose);
    if (!isUsable(next)) return;
    this.travel = null;
    this.pose = next;
    this.schedule();
  }

  private schedule(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    this.hooks.requestFrame((nowMs) => this.tick(nowMs));
  }

  private tick(nowMs: number): void {
    this.scheduled = false;
    this.advanceTravel(nowMs);
    if (!this.pose) return;
    const changed = !this.sent || !samePose(this.sent, this.pose);
    const due = nowMs - this.lastSendMs >= kMinSendMs;
    if (changed && due) {
      this.lastSendMs = nowMs;
      this.sent = this.pose;
      this.hooks.send(this.pose);
    }
    if (this.travel || (changed && !due)) this.schedule();
  }

  private advanceTravel(nowMs: number): void {
    if (!this.travel) return;
    this.travel.startMs ??= nowMs;
    const t = Math.min(1, (nowMs - this.travel.startMs) / kTravelMs);
    const eased = t * t * (3 - 2 * t);
    this.pose = t >= 1 ? this.travel.to : blend(this.travel.from, this.travel.to, eased);
    if (t >= 1) this.travel = null;
  }
}

function isUsable(pose: Pose): boolean {
  const numbers = [...pose.eye, ...pose.target, ...pose.up, pose.lens.yfov, pose.lens.ymag];
  const forward = forwardOf(pose);
  return numbers.every(Number.isFinite) && (forward[0] !== 0 || forward[1] !== 0 || forward[2] !== 0);
}
