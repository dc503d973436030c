// What the reader chooses: one object of choices, and the form that changes it.
import { h } from '../dom.js';

export const initialChoices = {
  state: 0,
  mode: 'rodrigues',
  edges: 'elements',
  cut: 'none',
  depth: 50,
  inner: false,
  own: false,
};

const select = (name, options) =>
  h('select', { name, 'aria-label': name }, ...options.map(([value, text]) => h('option', { value }, text)));

const field = (text, ...content) => h('label', { class: 'field' }, h('span', {}, text), ...content);

/** Calls `onChange(choices, name)` after each change. */
export function makeControls(report, choices, onChange) {
  const form = h(
    'form',
    { class: 'controls', style: 'display:contents', onsubmit: (e) => e.preventDefault() },
    field(
      'Colour',
      select('mode', [
        ['rodrigues', 'Orientation, as in the paper'],
        ['ipf0', 'Orientation, IPF along RD'],
        ['ipf1', 'Orientation, IPF along TD'],
        ['ipf2', 'Orientation, IPF along ND'],
        ...report.quantities.map((q) => [q.name, q.label[0].toUpperCase() + q.label.slice(1)]),
        ['grain', 'Grain'],
      ]),
    ),
    field(
      'Lines',
      select('edges', [
        ['elements', 'Elements and grain boundaries'],
        ['grains', 'Grain boundaries'],
        ['wires', 'Wireframe'],
      ]),
    ),
    field(
      'Cut away the grains beyond',
      h(
        'div',
        { class: 'row' },
        select('cut', [
          ['none', 'no plane'],
          ['0', 'RD'],
          ['1', '−TD'],
          ['2', 'ND'],
        ]),
        h('input', {
          type: 'range',
          name: 'depth',
          min: 0,
          max: 100,
          value: choices.depth,
          'aria-label': 'depth of the cut',
        }),
      ),
    ),
    h('label', {}, h('input', { type: 'checkbox', name: 'inner' }), 'inner grains only'),
    h('label', {}, h('input', { type: 'checkbox', name: 'own' }), 'colour range of this state alone'),
  );
  form.addEventListener('input', ({ target }) => {
    choices[target.name] =
      target.type === 'checkbox'
        ? target.checked
        : target.type === 'range'
          ? Number(target.value)
          : target.value;
    onChange(target.name);
  });
  return form;
}

/** The slider over the stored states, with a button that plays them. */
export function makeSlider(report, choices, onChange) {
  const output = h('output', { id: 'state-text' });
  const input = h('input', {
    type: 'range',
    id: 'state',
    min: 0,
    max: report.states.length - 1,
    step: 1,
    value: 0,
    'aria-label': 'stored state, by strain',
  });
  let timer = null;
  const button = h(
    'button',
    { type: 'button', title: 'Play the states', onclick: () => (timer ? stop() : play()) },
    '▶ Play',
  );
  const go = (state) => {
    choices.state = state;
    input.value = state;
    onChange('state');
  };
  const stop = () => {
    clearInterval(timer);
    timer = null;
    button.textContent = '▶ Play';
  };
  const play = () => {
    button.textContent = '❚❚ Stop';
    go((choices.state + 1) % report.states.length);
    timer = setInterval(() => go((choices.state + 1) % report.states.length), 900);
  };
  input.addEventListener('input', () => {
    if (timer) stop();
    go(Number(input.value));
  });
  return { element: h('div', { class: 'strain-slider' }, button, input, output), output };
}
