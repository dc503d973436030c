// The meshes: quality of the elements, and what each remeshing changed.
import { h, table } from '../dom.js';
import { figure } from '../figure.js';
import { count, number, percent } from '../format.js';
import { section } from '../section.js';

/** Rows of the audit that have a name and a form of their own; others are shown as they are called. */
const known = {
  elements_before: ['elements before', count],
  elements_after: ['elements after', count],
  min_radius_ratio_before: ['worst radius ratio before', number],
  min_radius_ratio_after: ['worst radius ratio after', number],
  max_grain_volume_change: ['largest change of a grain’s volume', percent],
  strain_to_reload: ['strain until the stress is back at the curve before', number],
};

const plain = (value) => (typeof value === 'number' || value === null ? number(value) : String(value));

/** { a: 1, b: { c: 2 } } becomes { a: 1, 'b c': 2 }. */
const flat = (object, before = '') =>
  Object.assign(
    {},
    ...Object.entries(object).map(([key, value]) =>
      value !== null && typeof value === 'object' && !Array.isArray(value)
        ? flat(value, `${before}${key} `)
        : { [before + key]: value },
    ),
  );

/** A column a remeshing, a row a number. */
function auditTable(remeshings) {
  const all = remeshings.map((r) => flat(r));
  const keys = Object.keys(Object.assign({}, ...all)).filter((key) => key !== 'strain');
  const rows = keys.map((key) => {
    const [name, format] = known[key] ?? [key.replaceAll('_', ' '), plain];
    return [name, ...all.map((r) => format(r[key] ?? null))];
  });
  return h(
    'figure',
    { id: 'audit' },
    h('h3', {}, h('span', {}, 'What each remeshing changed')),
    table(['', ...all.map((r) => `strain ${number(r.strain)}`)], rows),
  );
}

function failures(failed) {
  return h(
    'figure',
    { id: 'failed-remeshings' },
    h('h3', {}, h('span', {}, 'Remeshings that failed')),
    table(
      ['strain', 'why'],
      failed.map((f) => [number(f.strain), f.reason]),
    ),
  );
}

/** The states worth a curve: first, last, both sides of each remeshing. */
function chosen(states) {
  return states
    .map((state, i) => {
      const after = i > 0 && states[i - 1].mesh !== state.mesh;
      const before = i + 1 < states.length && states[i + 1].mesh !== state.mesh;
      const side = before ? ', before remeshing' : after ? ', after' : '';
      return {
        state,
        keep: i === 0 || i + 1 === states.length || before || after,
        name: `strain ${number(state.strain)}${side}`,
      };
    })
    .filter((item) => item.keep);
}

function histograms(report) {
  const bins = report.states[0].quality.length;
  const edges = Array.from({ length: bins + 1 }, (_, i) => i / bins);
  const shares = (s) => s.quality.map((n) => n / s.elements);
  const items = chosen(report.states);
  return figure({
    name: 'mesh-quality',
    title: 'Radius ratios of the elements',
    caption: '3 r_in / R_circ of the tetrahedron through the corners: 1 for a regular one, 0 for a flat one.',
    draw: () => ({
      data: items.map(({ state, name }) => ({
        x: edges.slice(0, -1).map((e) => e + 0.5 / bins),
        y: shares(state).map((v) => 100 * v),
        name,
        mode: 'lines',
        line: { shape: 'hvh', width: 1.8 },
        hovertemplate: '%{y:.2f} % at %{x:.3f}<extra>%{fullData.name}</extra>',
      })),
      layout: {
        xaxis: { title: { text: 'radius ratio' }, range: [0, 1] },
        yaxis: { title: { text: 'share of the elements (%)' }, rangemode: 'tozero' },
        margin: { t: 74 },
      },
    }),
    columns: () =>
      Object.fromEntries([
        ['from', edges.slice(0, -1)],
        ...items.map(({ state, name }) => [name.replaceAll(',', ''), shares(state)]),
      ]),
  });
}

function worst(report) {
  const strain = report.states.map((s) => s.strain);
  const values = (key) => report.states.map((s) => s.values.radius_ratio[key]);
  return figure({
    name: 'worst-elements',
    title: 'Radius ratio against strain',
    caption: 'Of the stored states; at a remeshing both sides are stored.',
    draw: () => ({
      data: [
        ['mean', 'mean'],
        ['low', '1 % of the elements are below'],
        ['min', 'worst element'],
      ].map(([key, name]) => ({
        x: strain,
        y: values(key),
        name,
        mode: 'lines+markers',
      })),
      layout: {
        xaxis: { title: { text: 'strain' } },
        yaxis: { title: { text: 'radius ratio' }, range: [0, 1] },
      },
    }),
    columns: () => ({ strain, mean: values('mean'), first_per_cent: values('low'), min: values('min') }),
  });
}

export function quality(report) {
  const remeshings = report.summary?.remeshings ?? [];
  const failed = report.summary?.failed_remeshings ?? [];
  const more = [
    ...(remeshings.length > 0 ? [auditTable(remeshings)] : []),
    ...(failed.length > 0 ? [failures(failed)] : []),
  ];
  return section(
    'meshes',
    'Meshes and remeshing',
    'Deformation wears the elements out; a remeshing gives the deformed grains new ones and carries the state over.',
    worst(report),
    histograms(report),
    ...more,
  );
}
