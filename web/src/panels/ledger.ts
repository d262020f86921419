import type { Outcome } from '../state/edit_desk';
import { h, setText } from '../ui/dom';
import { formatSeconds } from '../ui/format';

/** "Roughness: relight, 0.18 s to first pixels", or why it did not happen. */
export function describeOutcome(outcome: Outcome): string {
  if (outcome.kind !== 'applied') return `${outcome.label}: ${outcome.message ?? outcome.kind}`;
  if (outcome.cost === 'none') return `${outcome.label}: nothing changed`;
  const cost = outcome.cost ?? 'applied';
  if (outcome.latencyMs === undefined) return `${outcome.label}: ${cost} …`;
  return `${outcome.label}: ${cost}, ${formatSeconds(outcome.latencyMs / 1000)} to first pixels`;
}

/** The line under the picture: what the last edit cost, or what went wrong, beside a few figures of the picture. */
export class Ledger {
  private readonly edit = h('span', { class: 'edit' });
  private readonly figures = h('span', { class: 'figures quiet' });

  constructor(root: HTMLElement) {
    root.append(this.edit, this.figures);
    const hands = 'Drag to orbit, right-drag to pan, wheel to come nearer, click to pick, Ctrl-drag to move the picked';
    setText(this.edit, hands);
  }

  showOutcome(outcome: Outcome): void {
    if (outcome.camera && outcome.kind === 'applied') return;
    this.say(describeOutcome(outcome), outcome.kind !== 'applied');
  }

  say(text: string, bad = false): void {
    setText(this.edit, (bad ? '⚠ ' : '') + text);
    this.edit.classList.toggle('bad', bad);
  }

  showFigures(text: string): void {
    setText(this.figures, text);
  }
}
