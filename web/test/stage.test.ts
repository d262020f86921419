import { describe, expect, it } from 'vitest';
import { Stage } from '../src/panels/stage';
import { Model } from '../src/state/model';
import { FakeElement } from './fake_dom';

function makeStage() {
  const [element, note] = [new FakeElement('div'), new FakeElement('div')];
  const model = new Model();
  const asElement = (fake: FakeElement) => fake as unknown as HTMLElement;
  const stage = new Stage(asElement(element), asElement(note), asElement(new FakeElement('div')), model);
  const go = (kind: 'connected' | 'connecting' | 'paused') => model.setConnection({ kind });
  /** Whether the picture is greyed, and what is written over it; null where nothing is. */
  const shown = () => [element.classes.has('stale'), note.hidden ? null : note.textContent];
  return { stage, go, shown };
}

describe('Stage', () => {
  it('takes the last picture for stale until the new connection has brought one', () => {
    const { stage, go, shown } = makeStage();
    go('connected');
    stage.onPicture(4, 3);
    expect(shown()).toEqual([false, null]);
    go('paused');
    expect(shown()).toEqual([true, 'Stale picture — paused while the page was hidden']);
    go('connecting');
    go('connected');
    expect(shown()).toEqual([true, 'Stale picture — waiting for the first picture']);
    stage.onPicture(4, 3);
    expect(shown()).toEqual([false, null]);
  });

  it('tells that the first picture of all is awaited', () => {
    const { go, shown } = makeStage();
    go('connected');
    expect(shown()).toEqual([false, 'waiting for the first picture']);
  });

  it('does not take a picture for live that was decoded when the connection was gone', () => {
    const { stage, go, shown } = makeStage();
    go('connected');
    go('paused');
    stage.onPicture(4, 3);
    expect(shown()).toEqual([true, 'paused while the page was hidden']);
  });
});
