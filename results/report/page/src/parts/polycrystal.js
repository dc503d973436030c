// The polycrystal in three dimensions.
import { h, table } from '../dom.js';
import { count, number, withUnit } from '../format.js';
import { makeAxes } from '../scene/axes.js';
import { library, unpack } from '../scene/blocks.js';
import { fill, makeBody, visibleSides } from '../scene/body.js';
import { ipf, ofGrain, ramp } from '../scene/colours.js';
import { initialChoices, makeControls, makeSlider } from '../scene/controls.js';
import { legend } from '../scene/legend.js';
import { makeView } from '../scene/view.js';
import { colour, onTheme } from '../theme.js';

/** The least and greatest of all states' ranges. */
const wholeRange = (report, name) => {
  const all = report.states.map((s) => s.values[name]).filter((r) => r.low != null);
  return { low: Math.min(...all.map((r) => r.low)), high: Math.max(...all.map((r) => r.high)) };
};

/** "Strain 0.3, after the remeshing: mesh 1 with 4,342 elements" */
function sentence(report, i) {
  const state = report.states[i];
  const after = i > 0 && report.states[i - 1].mesh !== state.mesh;
  const before = i + 1 < report.states.length && report.states[i + 1].mesh !== state.mesh;
  const side = after ? ', after the remeshing' : before ? ', before the remeshing' : '';
  return [
    h('b', {}, `Strain ${number(state.strain, 4)}`),
    `${side}: mesh ${state.mesh + 1} with ${count(state.elements)} elements and ${count(state.nodes)} nodes; ` +
      `state ${i + 1} of ${report.states.length} (${state.file})`,
  ];
}

/** Means of the state, with names that say what they are. */
function numbers(report, state) {
  const rows = report.quantities
    .filter((q) => state.values[q.name].mean != null)
    .map((q) => [q.label, withUnit(number(state.values[q.name].mean, 4), q.unit)]);
  const element = table(['Mean by volume', ''], rows);
  element.id = 'state-numbers';
  return element;
}

/** [grain] whether it is shown; 0 stands for outside. */
function keptGrains(state, choices) {
  const { mesh, positions } = state;
  const grains = mesh.grains.reduce((most, grain) => Math.max(most, grain), 0);
  const kept = new Uint8Array(grains + 1).fill(1);
  kept[0] = 0;
  if (choices.inner)
    for (let t = 0; t < mesh.count; ++t) if (mesh.grains[2 * t + 1] === 0) kept[mesh.grains[2 * t]] = 0;
  if (choices.cut === 'none') return kept;
  const axis = Number(choices.cut),
    sign = axis === 1 ? -1 : 1;
  const sum = new Float64Array(grains + 1),
    corners = new Uint32Array(grains + 1);
  let low = Infinity,
    high = -Infinity;
  for (let k = 0; k < 3 * mesh.count; ++k) {
    const x = sign * positions[3 * mesh.nodes[k] + axis];
    low = Math.min(low, x);
    high = Math.max(high, x);
    for (const grain of mesh.grains.subarray(2 * Math.floor(k / 3), 2 * Math.floor(k / 3) + 2)) {
      sum[grain] += x;
      ++corners[grain];
    }
  }
  const limit = low + ((high - low) * choices.depth) / 100;
  for (let g = 1; g <= grains; ++g) if (sum[g] / corners[g] > limit) kept[g] = 0;
  return kept;
}

function painter(report, record, state, mode, range) {
  const { colours, values, mesh } = state;
  if (mode === 'rodrigues') return (t, side, place) => colours.subarray(3 * place, 3 * place + 3);
  if (mode.startsWith('ipf')) {
    const axis = Number(mode.at(-1));
    return (t, side, place) => ipf(colours[3 * place], colours[3 * place + 1], colours[3 * place + 2], axis);
  }
  if (mode === 'grain') return (t, side) => ofGrain(mesh.grains[2 * t + side]);
  const { low, high } = range;
  return (t, side, place) =>
    ramp((unpack(values[mode][place], record.values[mode]) - low) / (high - low || 1));
}

/** What is under the mouse. */
function tipText(report, record, state, code, mode) {
  const t = code >> 1,
    side = code & 1;
  const grain = state.mesh.grains[2 * t + side];
  const bunge = record.grain_bunge[grain - 1].map((angle) => `${angle.toFixed(1)}°`).join(', ');
  const lines = [`Grain ${grain}, mean orientation (Bunge) ${bunge}`];
  const quantity = report.quantities.find((q) => q.name === mode);
  if (quantity) {
    const value = unpack(state.values[mode][side === 1 ? state.mesh.second[t] : t], record.values[mode]);
    lines.push(`${quantity.label}: ${withUnit(number(value), quantity.unit)}`);
  }
  return lines;
}

export function polycrystal(report) {
  const choices = { ...initialChoices, state: 0 };
  const holder = h('div', { class: 'view' });
  const numbersHolder = h('div', {}),
    legendHolder = h('div', { id: 'legend' });
  const read = library(report);
  const body = makeBody();
  let view = null,
    shown = null,
    sides = [],
    turned = false;

  const range = (record) => (choices.own ? record.values[choices.mode] : wholeRange(report, choices.mode));

  const showNumbers = () => {
    const record = report.states[choices.state];
    slider.output.replaceChildren(...sentence(report, choices.state));
    numbersHolder.replaceChildren(numbers(report, record));
    const quantity = report.quantities.find((q) => q.name === choices.mode);
    legendHolder.replaceChildren(legend(choices.mode, quantity, quantity && range(record)));
  };

  const showBody = async () => {
    const number = choices.state,
      record = report.states[number];
    const state = await read(record);
    if (number !== choices.state) return; // the slider has moved on
    if (shown !== state) {
      const [low, high] = record.box;
      view.aim(
        low.map((x, i) => (x + high[i]) / 2),
        Math.hypot(...high.map((x, i) => x - low[i])) / 2,
      );
      if (!turned) view.turn();
      turned = true;
    }
    shown = state;
    sides = visibleSides(state.mesh, keptGrains(state, choices));
    const quantity = report.quantities.some((q) => q.name === choices.mode);
    fill(body, state, sides, painter(report, record, state, choices.mode, quantity && range(record)));
    body.material.uniforms.elements.value = choices.edges === 'elements';
    body.material.uniforms.wires.value = choices.edges === 'wires';
    view.draw();
    holder.dataset.state = number;
  };

  const change = () => {
    showNumbers();
    if (view) showBody();
  };
  const slider = makeSlider(report, choices, change);
  const controls = makeControls(report, choices, change);
  const reset = h('button', { type: 'button', onclick: () => view?.turn() }, 'Reset the view');
  const picture = h(
    'button',
    {
      type: 'button',
      onclick: () => {
        if (!view) return;
        view.draw();
        h('a', {
          href: holder.querySelector('canvas').toDataURL('image/png'),
          download: 'polycrystal.png',
        }).click();
      },
    },
    'PNG',
  );
  const panel = h(
    'div',
    { class: 'panel' },
    controls,
    legendHolder,
    numbersHolder,
    h('div', { class: 'row controls' }, reset, picture),
  );

  const tip = h('div', { class: 'tip', hidden: true });
  const point = (event) => {
    const n = shown && event.buttons === 0 ? view.pick(body, event) : -1;
    tip.hidden = n < 0;
    if (n < 0) return;
    const lines = tipText(report, report.states[choices.state], shown, sides[n], choices.mode);
    tip.replaceChildren(...lines.map((line) => h('div', {}, line)));
    const box = holder.getBoundingClientRect();
    const x = event.clientX - box.left,
      y = event.clientY - box.top;
    tip.style.left = `${Math.min(x + 14, box.width - tip.offsetWidth - 6)}px`;
    tip.style.top = `${y + 16}px`;
  };

  const start = () => {
    showNumbers();
    try {
      const turnAxes = makeAxes(holder);
      view = makeView(holder, turnAxes);
    } catch {
      holder.replaceChildren(
        h(
          'p',
          { class: 'message', id: 'no-webgl' },
          'This browser offers no WebGL 2, which the view in three dimensions takes. All other parts of the ' +
            'report work without it; polycrystal.png beside the report shows the first and the last state.',
        ),
      );
      return;
    }
    view.scene.add(body);
    holder.append(tip);
    holder.addEventListener('pointermove', point);
    holder.addEventListener('pointerleave', () => {
      tip.hidden = true;
    });
    onTheme(() => {
      view.background(colour('card'));
      showNumbers();
    });
    showBody();
  };
  const scene = h('div', { class: 'scene' }, holder, panel, slider.element);
  return {
    id: 'polycrystal',
    title: 'Polycrystal',
    element: h(
      'section',
      { id: 'polycrystal' },
      h('h2', {}, 'Polycrystal'),
      h(
        'p',
        {},
        'Turn it with the mouse, zoom with the wheel, shift with the right button. A cut takes whole grains ' +
          'away, so that what shows are grain boundaries as they are.',
      ),
      scene,
    ),
    start,
  };
}
