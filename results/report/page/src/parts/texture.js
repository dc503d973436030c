// Texture: components, beta-fibre, pole figures, sections; a Taylor model's beside them.
import { h } from '../dom.js';
import { figure } from '../figure.js';
import { count, number } from '../format.js';
import { maps } from '../maps.js';
import { section as part } from '../section.js';
import { colour } from '../theme.js';
import { densities, inversePoleFigure, poleFigure, rodriguesSection, section } from './densities.js';

const labels = { goss: 'Goss', s: 'S', dillamore: '{4 4 11}' };
const label = (name) => labels[name] ?? name[0].toUpperCase() + name.slice(1);

const select = (name, options) => h('select', { 'aria-label': name }, ...options);

/** A choice of the states, the last at first. */
const choiceOfState = (texture) =>
  select(
    'strain',
    texture.states.map((s, i) =>
      h('option', { value: i, selected: i + 1 === texture.states.length }, `strain ${number(s.strain)}`),
    ),
  );

/** [what, texture, state] of the run and, at the strain next to its own, of the Taylor model. */
function beside(report, index) {
  const state = report.texture.states[index];
  const shown = [['run', report.texture, state]];
  if (report.taylor) {
    const distance = (s) => Math.abs(s.strain - state.strain);
    const { states } = report.taylor.texture;
    shown.push([
      'Taylor',
      report.taylor.texture,
      states.reduce((a, b) => (distance(b) < distance(a) ? b : a)),
    ]);
  }
  return shown;
}

/** Maps of one kind at a chosen state: those of the run in so many `lines`, and below the Taylor model's. */
function mapsFigure(report, { name, title, caption, height, panels, equal = true, lines = 1 }) {
  const control = choiceOfState(report.texture);
  const shown = () => beside(report, Number(control.value));
  const rows = (report.taylor ? 2 : 1) * lines;
  const filled = (list) => [...list, ...Array(Math.ceil(list.length / lines) * lines - list.length).fill(null)];
  const suffix = (what, state) => (report.taylor ? `, ${what}, strain ${number(state.strain)}` : '');
  const all = async () => {
    const rowsOfPanels = shown().map(async ([what, texture, state]) =>
      filled(
        panels(texture, await densities(texture, state)).map((p) => ({
          ...p,
          title: p.title + suffix(what, state),
        })),
      ),
    );
    return (await Promise.all(rowsOfPanels)).flat();
  };
  return figure({
    name,
    title,
    caption,
    control,
    wide: true,
    height: height * rows + 20,
    draw: async () => maps(await all(), { rows, equal }),
    columns: async () => {
      const table = { map: [], x: [], y: [], density: [] };
      for (const p of (await all()).filter(Boolean))
        p.z.forEach((row, j) =>
          row.forEach((density, i) => {
            table.map.push(`"${p.title}"`);
            table.x.push(p.x[0] + ((p.x[1] - p.x[0]) * i) / (row.length - 1));
            table.y.push(p.y[0] + ((p.y[1] - p.y[0]) * j) / (p.z.length - 1));
            table.density.push(density);
          }),
        );
      return table;
    },
  });
}

function poleFigures(report) {
  return mapsFigure(report, {
    name: 'pole-figures',
    title: 'Pole figures',
    caption: `Equal-area, ND towards the reader; kernel of ${number(report.texture.half_width)}° half-width.`,
    height: 340,
    panels: (texture, d) => ['{111}', '{200}', '{220}'].map((hkl, i) => poleFigure(texture, d.poles[i], hkl)),
  });
}

function inversePoleFigures(report) {
  return mapsFigure(report, {
    name: 'inverse-pole-figures',
    title: 'Inverse pole figures',
    caption: 'Directions of the crystal along RD, TD and ND; equal-area.',
    height: 300,
    panels: (texture, d) =>
      ['RD', 'TD', 'ND'].map((axis, i) => inversePoleFigure(texture, d.inverse[i], axis)),
  });
}

function sections(report) {
  return mapsFigure(report, {
    name: 'odf-sections',
    title: 'Sections of the orientation distribution',
    caption:
      'Bunge’s angles; the sections hold copper and {4 4 11} (45°), S (65°), and brass and cube (90°).',
    height: 280,
    equal: false,
    panels: (texture, d) =>
      texture.grids.sections.phi2.map((phi2, i) => section(texture, d.sections[i], `φ₂ = ${phi2}°`)),
  });
}

function rodriguesSections(report) {
  return mapsFigure(report, {
    name: 'odf-rodrigues',
    title: 'Sections in Rodrigues space',
    caption:
      'The fundamental region across r₃; r₁ to the right, r₂ up. C: copper, S, B: brass, where a variant ' +
      'lies near the section.',
    height: 260,
    lines: 2,
    panels: (texture, d) => d.rodrigues.map((z, i) => rodriguesSection(texture, z, i)),
  });
}

/** A line a component against strain, solid for the run, dashed for the Taylor model. */
function components(report, key, title, unit) {
  const names = report.texture.states[0].components.map((c) => c.name);
  const values = (texture, name) =>
    texture.states.map(
      (s) => (key === 'volume_fraction' ? 100 : 1) * s.components.find((c) => c.name === name)[key],
    );
  const lines = (texture, dash, note) =>
    names.map((name, i) => ({
      x: texture.states.map((s) => s.strain),
      y: values(texture, name),
      name: label(name) + note,
      legendgroup: name,
      showlegend: dash === 'solid',
      mode: dash === 'solid' ? 'lines+markers' : 'lines',
      line: { dash, color: colour(`c${i}`) },
      hovertemplate: `%{y:.3g} at %{x:.3g}<extra>${label(name)}${note}</extra>`,
    }));
  return figure({
    name: `components-${key.replace('_', '-')}`,
    title,
    caption:
      (key === 'intensity'
        ? 'Mean of the variants; 1 is a random texture.'
        : `Within ${number(report.texture.fraction_angle)}° of a variant.`) +
      (report.taylor ? ' Dashed: the Taylor model.' : ''),
    draw: () => ({
      data: [
        ...lines(report.texture, 'solid', ''),
        ...(report.taylor ? lines(report.taylor.texture, 'dash', ', Taylor') : []),
      ],
      layout: {
        xaxis: { title: { text: 'strain' } },
        yaxis: { title: { text: unit }, rangemode: 'tozero' },
        margin: { t: 56 },
      },
    }),
    columns: () => ({
      model: [report.texture, report.taylor?.texture]
        .filter(Boolean)
        .flatMap((t, i) => t.states.map(() => ['run', 'taylor'][i])),
      strain: [...report.texture.states, ...(report.taylor?.texture.states ?? [])].map((s) => s.strain),
      ...Object.fromEntries(
        names.map((name) => [
          name,
          [report.texture, report.taylor?.texture].filter(Boolean).flatMap((t) => values(t, name)),
        ]),
      ),
    }),
  });
}

function betaFibre(report) {
  const control = choiceOfState(report.texture);
  const shown = () => beside(report, Number(control.value));
  return figure({
    name: 'beta-fibre',
    title: 'β-fibre, from copper to brass',
    caption:
      'The highest density in each section, within 15° of the ideal fibre; dotted: on the ideal fibre.',
    control,
    draw: () => ({
      data: shown().flatMap(([what, , state], i) =>
        ['ridge', 'ideal'].map((key) => ({
          x: state.beta.map((p) => p.phi2),
          y: state.beta.map((p) => p[key]),
          name: `${what}, ${key === 'ridge' ? 'highest' : 'ideal'}`,
          mode: key === 'ridge' ? 'lines+markers' : 'lines',
          line: { color: colour(`c${i}`), dash: key === 'ridge' ? 'solid' : 'dot' },
        })),
      ),
      layout: {
        xaxis: {
          title: { text: 'φ₂ (°)' },
          tickvals: [45, 55, 65, 75, 90],
          ticktext: ['45, Cu', '55', '65, S', '75', '90, Bs'],
        },
        yaxis: { title: { text: '× random' }, rangemode: 'tozero' },
      },
    }),
    columns: () => {
      const rows = shown().flatMap(([what, , state]) =>
        state.beta.map((p) => ({ what, strain: state.strain, ...p })),
      );
      return Object.fromEntries(
        ['what', 'strain', 'phi2', 'ideal', 'ridge'].map((key) => [key, rows.map((row) => row[key])]),
      );
    },
  });
}

function index(report) {
  const models = [['run', report.texture], ...(report.taylor ? [['Taylor', report.taylor.texture]] : [])];
  const strain = (t) => t.states.map((s) => s.strain);
  const values = (t) => t.states.map((s) => s.texture_index);
  return figure({
    name: 'texture-index',
    title: 'Texture index',
    caption: 'Mean square of the density: 1 for a random texture, larger for stronger ones.',
    draw: () => ({
      data: models.map(([name, t]) => ({
        x: strain(t),
        y: values(t),
        name,
        mode: 'lines+markers',
        showlegend: true,
      })),
      layout: { xaxis: { title: { text: 'strain' } }, yaxis: { title: { text: 'texture index' } } },
    }),
    columns: () => ({
      model: models.flatMap(([name, t]) => t.states.map(() => name)),
      strain: models.flatMap(([, t]) => strain(t)),
      texture_index: models.flatMap(([, t]) => values(t)),
    }),
  });
}

export function texture(report) {
  if (!report.texture) return null;
  const last = report.texture.states.at(-1);
  const symmetry = `${report.texture.sample_symmetry.replace('none', 'no')} sample symmetry`;
  return part(
    'texture',
    'Texture',
    `${count(last.orientations)} orientations, weighted by volume, ${symmetry}; texture index ` +
      `${number(last.texture_index)} at strain ${number(last.strain)}. Densities in times random.`,
    poleFigures(report),
    inversePoleFigures(report),
    components(report, 'intensity', 'Components', 'intensity (× random)'),
    components(report, 'volume_fraction', 'Volume fractions of the components', 'volume (%)'),
    betaFibre(report),
    index(report),
    sections(report),
    rodriguesSections(report),
  );
}
