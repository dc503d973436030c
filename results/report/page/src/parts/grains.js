// Single grains: how they turned (fig. 13 of the paper), and how their orientations spread (fig. 19).
import { h } from '../dom.js';
import { figure } from '../figure.js';
import { number } from '../format.js';
import { maps } from '../maps.js';
import { colour } from '../theme.js';
import { disc, grainBlock } from './densities.js';

export function paths({ drawn }) {
  if (drawn.length === 0) return null;
  return figure({
    name: 'rotation-paths',
    title: 'Rotation paths',
    caption:
      'The two largest grains, {111} pole figures: the density of their orientations in the last state ' +
      '(half-width 4°), and the path of the mean orientation, which begins at the dot.',
    wide: true,
    height: 360,
    draw: async () =>
      maps(
        await Promise.all(
          drawn.map(async (grain) => ({
            ...disc(
              grain.disc,
              (await grainBlock(grain)).z,
              `grain ${grain.grain}: turned ${number(grain.rotation)}°, spread ${number(grain.spread)}°`,
            ),
            paths: grain.paths,
          })),
        ),
        {},
      ),
    columns: () => {
      const rows = drawn.flatMap(({ grain, paths: lines }) =>
        lines.flatMap((points, line) => points.map(([x, y]) => ({ grain, line: line + 1, x, y }))),
      );
      return Object.fromEntries(['grain', 'line', 'x', 'y'].map((key) => [key, rows.map((row) => row[key])]));
    },
  });
}

const axes = ['RD', 'TD', 'ND'];

export function orientations({ drawn }) {
  if (drawn.length === 0) return null;
  const control = h(
    'select',
    { 'aria-label': 'grain' },
    ...drawn.map(({ grain }, i) => h('option', { value: i }, `grain ${grain}`)),
  );
  const shown = () => drawn[Number(control.value)];
  return figure({
    name: 'grain-orientations',
    title: 'Orientations of a grain',
    caption:
      'A point an element in the last state: the rotation vector, about the sample axes, that takes the grain’s ' +
      'mean orientation to the element’s.',
    control,
    wide: true,
    height: 340,
    draw: async () => {
      const { deviations } = await grainBlock(shown());
      const reach = 1.05 * Math.max(...deviations.flat().map(Math.abs));
      const panel = (i) => [i, (i + 1) % 3];
      const suffix = (i) => (i === 0 ? '' : String(i + 1));
      const axis = (k) => ({ title: { text: `about ${axes[k]} (°)` }, range: [-reach, reach] });
      return {
        data: [0, 1, 2].map((i) => {
          const [x, y] = panel(i).map((k) => deviations.map((v) => v[k]));
          return {
            ...{ x, y, xaxis: `x${suffix(i)}`, yaxis: `y${suffix(i)}`, mode: 'markers', showlegend: false },
            marker: { size: 4, opacity: 0.6, color: colour('c0') },
            hovertemplate: '%{x:.1f}°, %{y:.1f}°<extra></extra>',
          };
        }),
        layout: Object.fromEntries(
          [0, 1, 2].flatMap((i) => [
            [
              `xaxis${suffix(i)}`,
              { ...axis(panel(i)[0]), anchor: `y${suffix(i)}`, domain: [(i + 0.12) / 3, (i + 0.95) / 3] },
            ],
            [
              `yaxis${suffix(i)}`,
              { ...axis(panel(i)[1]), anchor: `x${suffix(i)}`, scaleanchor: `x${suffix(i)}`, constrain: 'domain' },
            ],
          ]),
        ),
      };
    },
    columns: async () => {
      const { deviations } = await grainBlock(shown());
      return Object.fromEntries(axes.map((axis, k) => [`about_${axis}`, deviations.map((v) => v[k])]));
    },
  });
}
