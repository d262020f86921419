import { afterEach, describe, expect, it, vi } from 'vitest';
import type { ToWorker } from '../src/channel';
import { StreamLink, type LinkHooks } from '../src/stream_link';

/** A link in a page that is just enough for it, and all that its worker is told after the start. */
function makeLink(hidden: boolean) {
  const told: ToWorker[] = [];
  const page = Object.assign(new EventTarget(), { hidden });
  const browser = new EventTarget();
  vi.stubGlobal('document', page);
  vi.stubGlobal('window', browser);
  vi.stubGlobal(
    'Worker',
    class {
      postMessage(message: ToWorker): void {
        if (message.type !== 'start') told.push(message);
      }
    },
  );
  new StreamLink({ transferControlToOffscreen: () => ({}) } as HTMLCanvasElement, 'ws://x/ws', null, {} as LinkHooks);
  const show = (shown: boolean) => {
    page.hidden = !shown;
    page.dispatchEvent(new Event('visibilitychange'));
  };
  return { told, show, goOnline: () => browser.dispatchEvent(new Event('online')) };
}

describe('StreamLink', () => {
  afterEach(() => vi.unstubAllGlobals());

  it('tells that the page was opened in the background', () => {
    const { told, show } = makeLink(true);
    expect(told).toEqual([{ type: 'hidden', hidden: true }]);
    show(true);
    expect(told.at(-1)).toEqual({ type: 'hidden', hidden: false });
  });

  it('tries again when the network is back, but not for a hidden page', () => {
    const { told, show, goOnline } = makeLink(false);
    goOnline();
    expect(told.at(-1)).toEqual({ type: 'retry' });
    show(false);
    goOnline();
    expect(told.at(-1)).toEqual({ type: 'hidden', hidden: true });
  });
});
