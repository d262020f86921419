import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { PictureSize } from '../src/panels/picture_size';
import type { Edit, SceneMessage } from '../src/protocol/messages.gen';
import { Model } from '../src/state/model';
import { stubDocument } from './fake_dom';

// Longer than a resized window takes to settle.
const kRestMs = 1000;

const sceneOf = (cause: SceneMessage['cause'], width: number, height: number) =>
  ({ cause, name: 'a.glb', materials: [], lights: [], nodes: [], width, height }) as unknown as SceneMessage;

/** A page that follows the whole window of 800 x 600. */
function makePage() {
  const window = new EventTarget();
  const stage = { width: 800, height: 600 };
  const asked: Edit[] = [];
  const model = new Model();
  const sizes = new PictureSize(model, {
    edit: () => {},
    follow: (_, edit) => void asked.push(edit),
    stageSize: () => stage,
    onWindowResize: (callback) => window.addEventListener('resize', callback),
  });
  model.on('scene', (scene) => sizes.show(scene));
  const resize = (width: number, height: number) => {
    Object.assign(stage, { width, height });
    window.dispatchEvent(new Event('resize'));
  };
  const join = (width: number, height: number) => {
    model.setConnection({ kind: 'connected' });
    model.setScene(sceneOf('joined', width, height));
  };
  const lose = () => model.setConnection({ kind: 'reconnecting', attempt: 1, retryAtMs: 0, reason: 'lost' });
  join(800, 600);
  const select = sizes.element.querySelector('select')!;
  select.value = 'window';
  select.dispatchEvent(new Event('change'));
  return { stage, asked, resize, join, lose };
}

describe('PictureSize', () => {
  beforeEach(() => {
    vi.useFakeTimers();
    stubDocument();
  });
  afterEach(() => {
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  it('follows a window that came to rest', () => {
    const { asked, resize } = makePage();
    resize(700, 500);
    resize(640, 480);
    expect(asked).toEqual([]);
    vi.advanceTimersByTime(kRestMs);
    expect(asked).toEqual([{ target: 'image', width: 640, height: 480 }]);
  });

  it('makes up for what the window did while there was no connection', () => {
    const { asked, resize, join, lose } = makePage();
    lose();
    resize(640, 480);
    vi.advanceTimersByTime(kRestMs);
    expect(asked).toEqual([]);
    join(800, 600);
    vi.advanceTimersByTime(kRestMs);
    expect(asked).toEqual([{ target: 'image', width: 640, height: 480 }]);
    join(640, 480);
    vi.advanceTimersByTime(kRestMs);
    expect(asked).toHaveLength(1);
  });

  it('asks for nothing when it joins anew and the window stayed as it was', () => {
    const { stage, asked, join, lose } = makePage();
    lose();
    stage.height = 580; // a line that wraps in the ledger
    join(800, 600);
    vi.advanceTimersByTime(kRestMs);
    expect(asked).toEqual([]);
  });

  it('leaves it at the size that somebody else chose meanwhile', () => {
    const { asked, resize, join, lose } = makePage();
    lose();
    resize(640, 480);
    vi.advanceTimersByTime(kRestMs);
    join(256, 256);
    vi.advanceTimersByTime(kRestMs);
    expect(asked).toEqual([]);
  });
});
