// Contoured maps side by side, with one scale of colours.
import { colour } from './theme.js';

/** Step of the contours: a round one, twelve levels at most. */
export function levelStep(largest) {
  const steps = [0.1, 0.2, 0.25, 0.5, 1, 2, 2.5, 5, 10, 20, 25, 50, 100];
  return steps.find((step) => largest / step <= 12) ?? largest / 12;
}

const path = (points) => `M${points.map((p) => p.join(',')).join('L')}Z`;

/** Covers what lies outside of the outline, and draws that. */
function masks({ outline, view }, axis) {
  const on = { type: 'path', xref: `x${axis}`, yref: `y${axis}`, layer: 'above' };
  const beyond = ([from, to]) => [2 * from - to, 2 * to - from];
  const [left, right] = beyond(view.x);
  const [low, high] = beyond(view.y);
  const frame = [
    [left, low],
    [right, low],
    [right, high],
    [left, high],
  ];
  return [
    {
      ...on,
      path: path(frame) + path(outline),
      fillrule: 'evenodd',
      fillcolor: colour('card'),
      line: { color: colour('card'), width: 1 },
    },
    { ...on, path: path(outline), line: { color: colour('ink'), width: 1.2 } },
  ];
}

const note = (axis, [x, y, text, xanchor = 'center', yanchor = 'middle'], size) => ({
  x,
  y,
  xref: `x${axis}`,
  yref: `y${axis}`,
  text,
  xanchor,
  yanchor,
  showarrow: false,
  font: { size },
});

/** A line along the points, and a dot on the first. */
function pathTraces(points, axis) {
  const on = { xaxis: `x${axis}`, yaxis: `y${axis}`, hoverinfo: 'skip', showlegend: false };
  const [x, y] = [0, 1].map((i) => points.map((p) => p[i]));
  return [
    { ...on, x, y, mode: 'lines', line: { color: colour('c1'), width: 2 } },
    { ...on, x: x.slice(0, 1), y: y.slice(0, 1), mode: 'markers', marker: { color: colour('c1'), size: 8 } },
  ];
}

/**
 * Each panel: `title`; `x` and `y`, [from, to] of the grid; `z`, its rows; `outline`, a polygon, or
 * none; `view`, the { x, y } to show; `notes`, [x, y, text, anchors]; `axes`, layouts of both axes, or
 * none; `paths`, lists of [x, y], drawn with a dot where they begin. A panel may be null: its place
 * stays empty. `rows` of panels.
 */
export function maps(panels, { rows = 1, equal = true }) {
  const columns = Math.ceil(panels.length / rows);
  const largest = Math.max(...panels.flatMap((p) => (p ? p.z.map((row) => Math.max(...row)) : [])), 1);
  const size = levelStep(largest);
  const layout = {
    shapes: [],
    annotations: [],
    coloraxis: {
      colorscale: 'Viridis',
      cmin: 0,
      cmax: largest,
      colorbar: {
        title: { text: '× random', side: 'right', font: { size: 13 } },
        thickness: 12,
        outlinewidth: 0,
        nticks: 8,
      },
    },
    margin: { l: 10, r: 10, t: 26, b: 12 },
  };
  const data = panels.flatMap((panel, k) => {
    if (!panel) return [];
    const axis = k === 0 ? '' : String(k + 1);
    const column = k % columns;
    const row = Math.floor(k / columns);
    const { title, x, y, z, outline, view, notes = [], axes = {}, paths = [] } = panel;
    const hidden = { visible: false };
    layout[`xaxis${axis}`] = {
      ...(axes.x ?? hidden),
      anchor: `y${axis}`,
      range: view.x,
      domain: [(column + (axes.y ? 0.08 : 0.03)) / columns, (column + 0.97) / columns],
    };
    layout[`yaxis${axis}`] = {
      ...(axes.y ?? hidden),
      anchor: `x${axis}`,
      range: axes.y?.reversed ? [...view.y].reverse() : view.y,
      domain: [1 - (row + (axes.x ? 0.8 : 0.95)) / rows, 1 - (row + (axes.x ? 0.12 : 0.09)) / rows],
      ...(equal ? { scaleanchor: `x${axis}`, constrain: 'domain' } : {}),
    };
    delete layout[`yaxis${axis}`].reversed;
    if (column > 0) delete layout[`yaxis${axis}`].title;
    if (outline) layout.shapes.push(...masks(panel, axis));
    layout.annotations.push(
      note(
        axis,
        [(view.x[0] + view.x[1]) / 2, view.y[axes.y?.reversed ? 0 : 1], title, 'center', 'bottom'],
        13,
      ),
      ...notes.map((n) => note(axis, n, 12)),
    );
    const place = ([from, to], count) =>
      Array.from({ length: count }, (_, i) => from + ((to - from) * i) / (count - 1));
    const map = {
      type: 'contour',
      x: place(x, z[0].length),
      y: place(y, z.length),
      z,
      xaxis: `x${axis}`,
      yaxis: `y${axis}`,
      coloraxis: 'coloraxis',
      contours: { start: size, end: size * Math.floor(largest / size), size, coloring: 'fill' },
      line: { width: 0.7, color: 'rgba(0,0,0,0.35)' },
      hovertemplate: '%{z:.2f} × random<extra></extra>',
    };
    return [map, ...paths.flatMap((points) => pathTraces(points, axis))];
  });
  return { data, layout };
}
