/** What a gesture on the picture asks for; pixels are CSS pixels relative to the picture's top left. */
export interface GestureTarget {
  /** Height of the shown picture [CSS pixel]. */
  pictureHeight(): number;
  orbit(yaw: number, pitch: number): void;
  pan(right: number, up: number): void;
  dolly(factor: number): void;
  /** Moves the selected object, in shares of the picture's height. */
  moveObject(right: number, up: number): void;
  click(clientX: number, clientY: number): void;
  frame(): void;
  centerPicked(): void;
  reset(): void;
}

const kClickSlack = 4; // [CSS pixel]
const kRadiansPerHeight = Math.PI; // a drag over the picture's height turns by half a circle
const kWheelRate = 0.0015;
const kKeyAngle = (5 * Math.PI) / 180;
const kKeyPan = 0.05;
const kKeyDolly = 0.9;
const kKeyMove = 0.02;

type Point = { x: number; y: number };
/** What a drag with one pointer does. */
type Grip = 'orbit' | 'pan' | 'object';

const kArrows: Record<string, readonly [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

/** Control, or the command key of a Mac: hands and keys are then for the selected object. */
const isForObject = (event: PointerEvent | KeyboardEvent): boolean => event.ctrlKey || event.metaKey;

/** Binds mouse, touch and keys of `element` to `target`. Keys act only while the element has the focus. */
export function bindControls(element: HTMLElement, target: GestureTarget): void {
  bindPointers(element, target);
  element.addEventListener(
    'wheel',
    (event) => {
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
      const delta = Math.max(-400, Math.min(400, event.deltaY * lines));
      target.dolly(Math.exp(delta * kWheelRate * (event.ctrlKey ? 4 : 1)));
    },
    { passive: false },
  );
  element.addEventListener('contextmenu', (event) => event.preventDefault());
  element.addEventListener('blur', () => element.classList.remove('by-pointer'));
  element.addEventListener('keydown', (event) => {
    element.classList.remove('by-pointer');
    if (event.altKey) return;
    const meant = isForObject(event)
      ? handleObjectKey(event.key, target)
      : handleKey(event.key, event.shiftKey, target);
    if (meant) event.preventDefault();
  });
}

/** Carries out a key that is held with Control; false when it means nothing to the selected object. */
export function handleObjectKey(key: string, target: GestureTarget): boolean {
  const arrow = kArrows[key];
  if (!arrow) return false;
  target.moveObject(arrow[0] * kKeyMove, arrow[1] * kKeyMove);
  return true;
}

/** Carries out one key; false when it means nothing to the camera. */
export function handleKey(key: string, shift: boolean, target: GestureTarget): boolean {
  const arrow = kArrows[key];
  if (arrow) {
    // An arrow moves the camera that way round the point; with Shift it moves the picture's window.
    if (shift) target.pan(-arrow[0] * kKeyPan, -arrow[1] * kKeyPan);
    else target.orbit(arrow[0] * kKeyAngle, -arrow[1] * kKeyAngle);
    return true;
  }
  switch (key) {
    case '+':
    case '=':
      target.dolly(kKeyDolly);
      return true;
    case '-':
    case '_':
      target.dolly(1 / kKeyDolly);
      return true;
    case 'f':
    case 'F':
      target.frame();
      return true;
    case 'c':
    case 'C':
      target.centerPicked();
      return true;
    case 'r':
    case 'R':
    case 'Home':
      target.reset();
      return true;
    default:
      return false;
  }
}

function bindPointers(element: HTMLElement, target: GestureTarget): void {
  const pointers = new Map<number, Point>();
  let travelled = 0;
  let grip: Grip = 'orbit';

  element.addEventListener('pointerdown', (event) => {
    if (pointers.size === 0) {
      travelled = 0;
      grip = gripOf(event);
    } else {
      travelled = Infinity; // a second finger: never a click
    }
    if (event.button === 1) event.preventDefault(); // no autoscroll
    element.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    // A focus ring tells where keys go; somebody with a mouse need not be told.
    element.classList.add('by-pointer');
    element.focus({ preventScroll: true });
  });

  element.addEventListener('pointermove', (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const now = { x: event.clientX, y: event.clientY };
    const step = { x: now.x - before.x, y: now.y - before.y };
    if (pointers.size === 2) {
      const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1] ?? before;
      pinch(before, now, other, target);
    } else if (pointers.size === 1) {
      travelled = Math.max(travelled, Math.hypot(step.x, step.y));
      // Until it is clear that this is a drag, the picture stays, so that a click does not restart the sampling.
      if (travelled < kClickSlack) return;
      drag(step, grip, target);
    }
    pointers.set(event.pointerId, now);
  });

  const release = (event: PointerEvent) => {
    if (!pointers.delete(event.pointerId)) return;
    const isClick = event.type === 'pointerup' && event.button === 0 && travelled < kClickSlack && pointers.size === 0;
    if (isClick) target.click(event.clientX, event.clientY);
    grip = 'orbit';
  };
  element.addEventListener('pointerup', release);
  element.addEventListener('pointercancel', release);
}

function gripOf(event: PointerEvent): Grip {
  if (event.button === 0 && isForObject(event)) return 'object';
  return event.button === 2 || event.button === 1 || event.shiftKey ? 'pan' : 'orbit';
}

function drag(step: Point, grip: Grip, target: GestureTarget): void {
  const height = Math.max(1, target.pictureHeight());
  if (grip === 'object') target.moveObject(step.x / height, -step.y / height);
  else if (grip === 'pan') target.pan(step.x / height, -step.y / height);
  else target.orbit((-step.x / height) * kRadiansPerHeight, (-step.y / height) * kRadiansPerHeight);
}

/** Two fingers: the middle pans, the distance between them dollies. */
function pinch(before: Point, now: Point, other: Point, target: GestureTarget): void {
  const height = Math.max(1, target.pictureHeight());
  target.pan((now.x - before.x) / 2 / height, -(now.y - before.y) / 2 / height);
  const was = Math.hypot(before.x - other.x, before.y - other.y);
  const is = Math.hypot(now.x - other.x, now.y - other.y);
  if (was > 1 && is > 1) target.dolly(was / is);
}
