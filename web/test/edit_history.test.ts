import { describe, expect, it } from 'vitest';
import { directionOf } from '../src/panels/history_controls';
import type { Edit, SceneMessage } from '../src/protocol/messages.gen';
import { EditHistory } from '../src/state/edit_history';
import { inverseOf } from '../src/state/inverse';
import { withEdit } from '../src/state/model';

const makeScene = () =>
  ({
    materials: [{ name: 'red', roughness: 0.5, metallic: 0 }],
    lights: [{ name: 'lamp', intensity: 1 }],
    nodes: [
      { name: 'plain', translation: [0, 0, 0] },
      { name: 'matrix', translation: [0, 0, 0], matrix: [1] },
    ],
    environment: { radiance: [1, 1, 1], rotation: 0, image: 'sky.hdr' },
    resolve: { exposure: 0, toneMap: 'aces', view: 'beauty' },
    technique: 'path-tracing',
    parameters: { maxBounces: 8, maxSamples: 64 },
    width: 320,
    height: 240,
  }) as unknown as SceneMessage;

function makeHistory() {
  const page = { scene: makeScene(), applied: [] as Edit[], changes: 0 };
  const history = new EditHistory({
    scene: () => page.scene,
    apply: (_, edit) => {
      page.scene = withEdit(page.scene, edit);
      page.applied.push(edit);
    },
    onChange: () => void page.changes++,
  });
  return { page, history };
}

const roughness = (value: number): Edit => ({ target: 'material', material: 0, roughness: value });
const intensity = (value: number): Edit => ({ target: 'light', light: 0, intensity: value });

describe('inverseOf', () => {
  it.each<Edit>([
    { target: 'material', material: 0, roughness: 0.1, metallic: 1 },
    { target: 'light', light: 0, intensity: 9 },
    { target: 'node', node: 0, translation: [1, 2, 3] },
    { target: 'environment', image: '' },
    { target: 'resolve', exposure: 2, toneMap: 'agx' },
    { target: 'technique', parameters: { maxBounces: 2 } },
    { target: 'technique', technique: 'flat' },
    { target: 'image', width: 64, height: 64 },
  ])('takes %j back', (edit) => {
    const scene = makeScene();
    const inverse = inverseOf(scene, edit);
    expect(withEdit(scene, edit)).not.toEqual(scene);
    expect(inverse && withEdit(withEdit(scene, edit), inverse)).toEqual(scene);
  });

  it.each<Edit>([
    { target: 'node', node: 1, translation: [1, 2, 3] },
    { target: 'material', material: 7, roughness: 0.1 },
    { target: 'technique', parameters: { unheardOf: 2 } },
    { target: 'camera', view: { eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0] } },
  ])('knows no way back from %j', (edit) => expect(inverseOf(makeScene(), edit)).toBeNull());
});

describe('EditHistory', () => {
  it('undoes and redoes a whole gesture at a time', () => {
    const { page, history } = makeHistory();
    for (const value of [0.6, 0.7, 0.8]) history.edit('Roughness', roughness(value));
    history.endGesture();
    history.edit('Roughness', roughness(0.9));
    expect(history.undo()).toBe('Roughness');
    expect(page.applied.at(-1)).toEqual(roughness(0.8));
    expect(history.undo()).toBe('Roughness');
    expect(page.applied.at(-1)).toEqual(roughness(0.5));
    expect(history.undo()).toBeNull();
    history.redo();
    expect(page.applied.at(-1)).toEqual(roughness(0.8));
    history.redo();
    expect(page.applied.at(-1)).toEqual(roughness(0.9));
    expect(history.redo()).toBeNull();
  });

  it('keeps things apart, also within a gesture, and forgets what was undone when something else is edited', () => {
    const { page, history } = makeHistory();
    history.edit('Roughness', roughness(0.1));
    history.edit('Intensity', intensity(5));
    expect(history.undo()).toBe('Intensity');
    expect([history.nextUndo(), history.nextRedo()]).toEqual(['Roughness', 'Intensity']);
    history.edit('Roughness', roughness(0.2));
    expect(history.nextRedo()).toBeNull();
    history.undo();
    expect(page.applied.at(-1)).toEqual(roughness(0.1));
  });

  it('passes over what changed nothing, or is so already', () => {
    const { page, history } = makeHistory();
    history.edit('Roughness', roughness(0.5));
    expect(history.nextUndo()).toBeNull();
    history.edit('Intensity', intensity(5));
    history.edit('Roughness', roughness(0.1));
    page.scene = withEdit(page.scene, roughness(0.5)); // the server refused it
    expect(history.undo()).toBe('Intensity');
    expect(history.nextRedo()).toBe('Intensity');
  });

  it('tells when there is more or less to undo', () => {
    const { page, history } = makeHistory();
    history.edit('Intensity', intensity(5));
    expect([page.changes, history.nextUndo()]).toEqual([1, 'Intensity']);
    history.clear();
    expect([page.changes, history.nextUndo()]).toEqual([2, null]);
  });
});

describe('the keys', () => {
  const press = (key: string, held: Partial<KeyboardEvent>) =>
    directionOf({ key, ctrlKey: false, metaKey: false, shiftKey: false, altKey: false, ...held });
  it('are those of every other program', () => {
    expect([press('z', { ctrlKey: true }), press('z', { metaKey: true })]).toEqual(['undo', 'undo']);
    expect([press('Z', { ctrlKey: true, shiftKey: true }), press('y', { ctrlKey: true })]).toEqual(['redo', 'redo']);
    expect([press('z', {}), press('z', { ctrlKey: true, altKey: true }), press('x', { ctrlKey: true })]).toEqual([
      null,
      null,
      null,
    ]);
  });
});
