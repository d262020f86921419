import { describe, expect, it } from 'vitest';
import type { Edit, SceneMessage } from '../src/protocol/messages.gen';
import { EditHistory } from '../src/state/edit_history';
import { inverseOf } from '../src/state/inverse';
import { withEdit } from '../src/state/model';

const kSheared = [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

const makeScene = () =>
  ({
    materials: [{ name: 'red', roughness: 0.5, metallic: 0 }],
    lights: [{ name: 'lamp', intensity: 1 }],
    nodes: [
      { name: 'plain', translation: [0, 0, 0] },
      { name: 'sheared', translation: [0, 0, 0], rotation: [0, 0, 0, 1], scale: [1, 1, 1], matrix: kSheared },
    ],
    environment: { radiance: [1, 1, 1], rotation: 0, hasImage: true, image: 'sky.hdr' },
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
const bounces = (value: number): Edit => ({ target: 'technique', parameters: { maxBounces: value } });
const technique = (name: string): Edit => ({ target: 'technique', technique: name });
const intensity = (value: number): Edit => ({ target: 'light', light: 0, intensity: value });

describe('inverseOf', () => {
  it.each<Edit>([
    { target: 'material', material: 0, roughness: 0.1, metallic: 1 },
    { target: 'light', light: 0, intensity: 9 },
    { target: 'node', node: 0, translation: [1, 2, 3] },
    { target: 'node', node: 1, translation: [1, 2, 3] },
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
    { target: 'node', node: 1, rotation: [0, 0, 1, 0] },
    { target: 'node', node: 1, translation: [1, 2, 3], scale: [2, 2, 2] },
    { target: 'material', material: 7, roughness: 0.1 },
    { target: 'technique', parameters: { unheardOf: 2 } },
    { target: 'camera', view: { eye: [0, 0, 1], target: [0, 0, 0], up: [0, 1, 0] } },
  ])('knows no way back from %j', (edit) => expect(inverseOf(makeScene(), edit)).toBeNull());

  it('knows no way back to an image that has no path', () => {
    const scene = makeScene();
    scene.environment.image = '';
    expect(inverseOf(scene, { target: 'environment', image: 'other.hdr' })).toBeNull();
    expect(inverseOf(scene, { target: 'environment', image: '' })).toBeNull();
    expect(inverseOf(scene, { target: 'environment', rotation: 1 })).toEqual({ target: 'environment', rotation: 0 });
  });
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

  it('redoes parameters while those of a technique that was just redone are not known', () => {
    const { page, history } = makeHistory();
    history.edit('Technique', technique('flat'));
    page.scene = { ...page.scene, parameters: { maxBounces: 8 } }; // the server describes it
    history.edit('Max bounces', bounces(3));
    history.undo();
    history.undo();
    expect(page.scene.technique).toBe('path-tracing');
    expect(history.redo()).toBe('Technique');
    expect(page.scene.parameters).toEqual({});
    expect(history.redo()).toBe('Max bounces');
    expect(page.applied.at(-1)).toEqual(bounces(3));
    expect(history.nextUndo()).toBe('Max bounces');
  });

  it('passes over a technique that is chosen already', () => {
    const { page, history } = makeHistory();
    history.edit('Technique', technique('flat'));
    history.undo();
    page.scene = withEdit(page.scene, technique('flat')); // somebody else was there first
    expect(history.redo()).toBeNull();
  });

  it('passes over parameters of another technique than the present one', () => {
    const { page, history } = makeHistory();
    history.edit('Intensity', intensity(5));
    history.edit('Max bounces', bounces(3));
    // Somebody else chose another, which has a parameter of this name.
    page.scene = { ...page.scene, technique: 'flat', parameters: { maxBounces: 4 } };
    expect(history.undo()).toBe('Intensity');
    expect(page.scene.parameters).toEqual({ maxBounces: 4 });
    expect([history.nextUndo(), history.nextRedo()]).toEqual([null, 'Intensity']);
  });

  it('does not take parameters of two techniques for one gesture', () => {
    const { page, history } = makeHistory();
    history.edit('Max bounces', bounces(3));
    page.scene = { ...page.scene, technique: 'flat', parameters: { maxBounces: 4 } };
    history.edit('Max bounces', bounces(5));
    expect(history.undo()).toBe('Max bounces');
    expect(page.scene.parameters).toEqual({ maxBounces: 4 });
  });

  it('forgets what was undone, and ends the gesture, with an edit that cannot be taken back', () => {
    const { page, history } = makeHistory();
    const turn: Edit = { target: 'node', node: 1, rotation: [0, 0, 1, 0] };
    history.edit('Intensity', intensity(5));
    history.undo();
    history.edit('Roughness', roughness(0.1));
    history.undo();
    expect(history.nextRedo()).toBe('Roughness');
    const { changes } = page;
    history.edit('Rotation', turn);
    expect([page.applied.at(-1), history.nextRedo(), page.changes]).toEqual([turn, null, changes + 1]);
    history.edit('Roughness', roughness(0.2));
    history.edit('Unheard of', { target: 'material', material: 0, unheardOf: 1 } as Edit);
    history.edit('Roughness', roughness(0.3));
    history.undo();
    expect(page.applied.at(-1)).toEqual(roughness(0.2));
  });

  it('tells when there is more or less to undo', () => {
    const { page, history } = makeHistory();
    history.edit('Intensity', intensity(5));
    expect([page.changes, history.nextUndo()]).toEqual([1, 'Intensity']);
    history.undo();
    expect([page.changes, history.nextUndo()]).toEqual([2, null]);
  });

  it('outlasts a connection', () => {
    const { page, history } = makeHistory();
    const roughnessNow = () => page.scene.materials[0]?.roughness;
    history.onScene({ ...page.scene, cause: 'joined' });
    history.edit('Roughness', roughness(0.1));
    history.edit('Intensity', intensity(5));
    history.undo();
    history.onScene({ ...page.scene, cause: 'joined' });
    history.onScene({ ...page.scene, cause: 'edited' });
    expect([history.nextUndo(), history.nextRedo()]).toEqual(['Roughness', 'Intensity']);
    history.undo();
    expect(roughnessNow()).toBe(0.5);
  });

  it.each<Partial<SceneMessage>>([
    { cause: 'loaded' },
    { name: 'other.glb' },
    { materials: [] },
    { lights: [] },
    { nodes: [] },
  ])('begins anew with a scene of which %j', (fields) => {
    const { page, history } = makeHistory();
    const told: SceneMessage = { ...page.scene, cause: 'joined' };
    history.onScene(told);
    history.edit('Roughness', roughness(0.1));
    history.edit('Intensity', intensity(5));
    history.undo();
    history.onScene({ ...told, ...fields });
    expect([history.nextUndo(), history.nextRedo()]).toEqual([null, null]);
  });
});
