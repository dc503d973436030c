// The density maps of textures, read from their blocks.
import { block } from '../data.js';

const kept = new Map();

function rows(values, columns) {
  return Array.from({ length: values.length / columns }, (_, j) => [
    ...values.subarray(j * columns, (j + 1) * columns),
  ]);
}

async function read(name, { disc, triangle, sections, rodrigues }) {
  const all = new Float32Array(await block(name));
  let at = 0;
  const next = (count) => all.subarray(at, (at += count));
  return {
    poles: [0, 1, 2].map(() => rows(next(disc.n * disc.n), disc.n)),
    inverse: [0, 1, 2].map(() => rows(next(triangle.nx * triangle.ny), triangle.nx)),
    sections: sections.phi2.map(() => rows(next(sections.n1 * sections.n), sections.n1)),
    rodrigues: rodrigues.r3.map(() => rows(next(rodrigues.n * rodrigues.n), rodrigues.n)),
  };
}

/** { poles, inverse, sections, rodrigues } of a state of a texture. */
export function densities(texture, state) {
  if (!kept.has(state.block)) kept.set(state.block, read(state.block, texture.grids));
  return kept.get(state.block);
}

const circle = Array.from({ length: 121 }, (_, i) => [
  Math.cos((i * Math.PI) / 60),
  Math.sin((i * Math.PI) / 60),
]);

/** Of a grid over the disc, { n, reach }. */
export function disc({ reach }, z, title) {
  return {
    title,
    z,
    x: [-reach, reach],
    y: [-reach, reach],
    outline: circle,
    view: { x: [-1.22, 1.22], y: [-1.1, 1.22] },
    notes: [
      [1.03, 0, 'RD', 'left'],
      [0, 1.03, 'TD', 'center', 'bottom'],
    ],
  };
}

export const poleFigure = (texture, z, title) => disc(texture.grids.disc, z, title);

/** The densities' { z } of a grain's pole figure, and its deviations [x, y, z] in degrees. */
export async function grainBlock({ block: name, disc: { n }, elements }) {
  const all = new Float32Array(await block(name));
  return { z: rows(all.subarray(0, n * n), n), deviations: rows(all.subarray(n * n, n * n + 3 * elements), 3) };
}

/** The layer `index` of the fundamental region of Rodrigues space. */
export function rodriguesSection(texture, z, index) {
  const { r3, reach, outlines, marks } = texture.grids.rodrigues;
  const view = [-1.12 * reach, 1.12 * reach];
  return {
    title: `r₃ = ${r3[index].toFixed(3).replace('-', '−')}`,
    z,
    x: [-reach, reach],
    y: [-reach, reach],
    outline: outlines[index],
    view: { x: view, y: view },
    notes: marks[index].map(([x, y, text]) => [x, y, `<b>${text}</b>`]),
  };
}

/** Equal-area places of directions (x, y, z), 0 <= y <= x <= z. */
const place = ([x, y, z]) => {
  const up = z / Math.hypot(x, y, z);
  const scale = Math.sqrt(1 / (1 + up)) / Math.hypot(x, y, z);
  return [x * scale, y * scale];
};
const arc = Array.from({ length: 31 }, (_, i) => place([1, i / 30, 1]));
const corners = [place([1, 0, 1]), place([1, 1, 1])];

export function inversePoleFigure(texture, z, title) {
  const { x, y } = texture.grids.triangle;
  return {
    title,
    z,
    x,
    y,
    outline: [[0, 0], ...arc],
    view: { x: [-0.05, 0.6], y: [-0.06, 0.5] },
    notes: [
      [0, -0.006, '001', 'center', 'top'],
      [corners[0][0], -0.006, '101', 'center', 'top'],
      [corners[1][0] + 0.015, corners[1][1], '111', 'left', 'middle'],
    ],
  };
}

export function section(texture, z, title) {
  const { step, n1, n } = texture.grids.sections;
  const x = [0, step * (n1 - 1)];
  const y = [0, step * (n - 1)];
  return {
    title,
    z,
    x,
    y,
    view: { x, y },
    axes: {
      x: { title: { text: 'φ₁ (°)', standoff: 2 }, dtick: n1 > n ? 90 : 30 },
      y: { title: { text: 'Φ (°)' }, dtick: 30, reversed: true },
    },
  };
}
