// Orientations within grains: their spreads, and how these hang together from strain to strain.
import { h } from '../dom.js';
import { figure } from '../figure.js';
import { number } from '../format.js';
import { section } from '../section.js';
import { grainChoice } from './grain_choice.js';
import { orientations, paths } from './grains.js';
import { colour } from '../theme.js';

const deformed = (states) => states.filter((s) => s.mean > 1e-6);

function means(spreads) {
  const { control, chosen } = grainChoice(spreads);
  const column = (key) => chosen().map((s) => s[key]);
  return figure({
    name: 'grain-spreads',
    control,
    title: 'In-grain spread against strain',
    caption:
      'Of a grain: the mean disorientation of its elements from its mean orientation, by volume. Boxes: ' +
      'quartiles of the grains; line: mean of the grains.',
    draw: () => ({
      data: [
        ...deformed(chosen()).map((s) => ({
          type: 'box',
          y: s.spread,
          x: s.spread.map(() => s.strain),
          name: `strain ${number(s.strain)}`,
          width: 0.03 * spreads.states.at(-1).strain,
          marker: { size: 3, color: colour('c5') },
          line: { width: 1.3 },
          boxpoints: 'outliers',
          showlegend: false,
        })),
        {
          x: column('strain'),
          y: column('mean'),
          name: 'mean',
          mode: 'lines+markers',
          line: { color: colour('c1') },
        },
      ],
      layout: {
        xaxis: { title: { text: 'strain' }, rangemode: 'tozero' },
        yaxis: { title: { text: 'spread (°)' }, rangemode: 'tozero' },
        boxmode: 'overlay',
      },
    }),
    columns: () =>
      Object.fromEntries(
        ['strain', 'mean', 'deviation', 'volume_mean', 'correlation'].map((key) => [key, column(key)]),
      ),
  });
}

/** Per cent of the values in bins of 0.2. */
function density(values) {
  const size = 0.2;
  const bins = Math.ceil(Math.max(...values) / size + 1e-9);
  const y = new Array(bins).fill(0);
  for (const value of values) y[Math.min(Math.floor(value / size), bins - 1)] += 100 / values.length;
  return { x: y.map((_, i) => size * (i + 0.5)), y };
}

/** Densities of the grains' spreads, each over the mean of its state (fig. 20). */
function distribution(spreads) {
  const { control, chosen } = grainChoice(spreads);
  const states = () => deformed(chosen());
  return figure({
    name: 'spread-distribution',
    control,
    title: 'Distribution of the spreads',
    caption: 'Share of the grains by their spread, divided by their mean at that strain.',
    draw: () => ({
      data: states().map((s) => ({
        ...density(s.spread.map((angle) => angle / s.mean)),
        name: `strain ${number(s.strain)}, mean ${number(s.mean)}°`,
        mode: 'lines',
        line: { shape: 'hvh' },
      })),
      layout: {
        xaxis: { title: { text: 'spread over mean spread' }, rangemode: 'tozero' },
        yaxis: { title: { text: 'grains (%)' }, rangemode: 'tozero' },
        margin: { t: 74 },
      },
    }),
    columns: () => ({
      grain: states()[0].grain,
      ...Object.fromEntries(states().map((s) => [`spread at strain ${number(s.strain)}`, s.spread])),
    }),
  });
}

/** A point a grain: its spread at one strain against that at the strain before. */
function correlations(spreads) {
  const states = deformed(spreads.states);
  if (states.length < 2) return null;
  const { control: grains, chosen } = grainChoice(spreads);
  const strains = h(
    'select',
    { 'aria-label': 'pair of strains' },
    ...states
      .slice(1)
      .map((s, i) =>
        h(
          'option',
          { value: i + 1, selected: i + 2 === states.length },
          `${number(states[i].strain)} → ${number(s.strain)}`,
        ),
      ),
  );
  const pair = () => deformed(chosen()).slice(Number(strains.value) - 1, Number(strains.value) + 1);
  const control = h('span', {}, grains, strains);
  return figure({
    name: 'spread-correlation',
    title: 'Spreads from strain to strain',
    caption: 'A point a grain. The number is the linear correlation coefficient.',
    control,
    draw: () => {
      const [before, after] = pair();
      return {
        data: [
          {
            x: before.spread,
            y: after.spread,
            text: before.grain.map((g) => `grain ${g}`),
            mode: 'markers',
            marker: { size: 7, opacity: 0.75 },
            hovertemplate: '%{text}: %{x:.2f}° → %{y:.2f}°<extra></extra>',
          },
        ],
        layout: {
          xaxis: { title: { text: `spread at strain ${number(before.strain)} (°)` }, rangemode: 'tozero' },
          yaxis: { title: { text: `spread at strain ${number(after.strain)} (°)` }, rangemode: 'tozero' },
          annotations: [
            {
              text: `r = ${number(after.correlation)}`,
              xref: 'paper',
              yref: 'paper',
              x: 0.02,
              y: 0.98,
              showarrow: false,
              font: { size: 14, color: colour('ink') },
            },
          ],
        },
      };
    },
    columns: () => {
      const [before, after] = pair();
      return { grain: before.grain, before: before.spread, after: after.spread };
    },
  });
}

function rotations(spreads) {
  const states = deformed(spreads.states);
  return figure({
    name: 'grain-rotations',
    title: 'Rotation of the grains',
    caption:
      'Share of the grains whose mean orientation has turned by no more than this angle since the first state.',
    draw: () => ({
      data: states.map((s) => ({
        x: [...s.rotation].sort((p, q) => p - q),
        y: s.rotation.map((_, i) => (100 * (i + 0.5)) / s.rotation.length),
        name: `strain ${number(s.strain)}`,
        mode: 'lines',
        line: { shape: 'hv' },
      })),
      layout: {
        xaxis: { title: { text: 'rotation (°)' }, rangemode: 'tozero' },
        yaxis: { title: { text: 'grains (%)' }, range: [0, 100] },
      },
    }),
    columns: () => ({
      grain: states[0].rotation.map((_, g) => g + 1),
      ...Object.fromEntries(states.map((s) => [`strain ${number(s.strain)}`, s.rotation])),
    }),
  });
}

export function spreads(report) {
  if (!report.spreads || deformed(report.spreads.states).length === 0) return null;
  const { states } = report.spreads;
  return section(
    'microtexture',
    'Microtexture',
    `Orientations within the grains, ${states[0].spread.length} of them, at the stored states; of two at one ` +
      'strain that before the remeshing.',
    ...[
      means(report.spreads),
      distribution(report.spreads),
      correlations(report.spreads),
      rotations(report.spreads),
      paths(report.spreads),
      orientations(report.spreads),
    ].filter(Boolean),
  );
}
