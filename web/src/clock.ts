/** Milliseconds on a clock that the page and its workers share and that never jumps. */
export const nowMs = (): number => performance.timeOrigin + performance.now();
