const kFirstMs = 250;
const kLongestMs = 8000;

/** Wait before the `attempt`-th new try, from 0: doubles up to 8 s; jitter spreads clients that lost the same server. */
export function backoffMs(attempt: number, random: () => number = Math.random): number {
  const full = Math.min(kLongestMs, kFirstMs * 2 ** Math.min(attempt, 16));
  return full * (0.5 + 0.5 * random());
}
