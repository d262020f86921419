import { h } from '../ui/dom';

const kTabs = [
  ['inspector', 'Selection'],
  ['scene', 'Scene'],
  ['render', 'Rendering'],
  ['stats', 'Statistics'],
] as const;

/** On narrow windows one panel is shown at a time; wide ones show all, and the style sheet hides these buttons. */
export function bindTabs(nav: HTMLElement, body: HTMLElement): void {
  const buttons = kTabs.map(([name, title]) => h('button', { 'data-tab': name, onClick: () => show(name) }, title));
  const show = (name: string) => {
    body.dataset['tab'] = name;
    for (const button of buttons) button.setAttribute('aria-pressed', String(button.dataset['tab'] === name));
  };
  nav.append(...buttons);
  show('inspector');
}
