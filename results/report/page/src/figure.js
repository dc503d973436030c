// A figure: a plot with its title and caption, in the page's colours, to be saved as SVG or CSV.
import Plotly from 'plotly.js-cartesian-dist-min';
import { h } from './dom.js';
import { colour, inLight, onTheme } from './theme.js';

function save(name, type, text) {
  const link = h('a', { href: URL.createObjectURL(new Blob([text], { type })), download: name });
  link.click();
  URL.revokeObjectURL(link.href);
}

/** The columns of a table as CSV; { strain: [...], stress: [...] }. */
export function csv(columns) {
  const names = Object.keys(columns);
  const rows = columns[names[0]].map((_, i) => names.map((name) => columns[name][i]).join(','));
  return `${[names.join(','), ...rows].join('\n')}\n`;
}

const axisColours = () => ({
  gridcolor: colour('grid'),
  linecolor: colour('line'),
  zerolinecolor: colour('line'),
  tickcolor: colour('line'),
});

const small = (title) => title && { ...title, font: { size: 13 } };

/** The layout with the theme's colours on every axis. */
function themed(layout) {
  const result = {
    ...layout,
    paper_bgcolor: 'rgba(0,0,0,0)',
    plot_bgcolor: 'rgba(0,0,0,0)',
    font: { family: getComputedStyle(document.body).fontFamily, size: 12.5, color: colour('ink') },
    colorway: ['c0', 'c1', 'c2', 'c3', 'c4', 'c5', 'c6'].map(colour),
    hoverlabel: { bgcolor: colour('card'), bordercolor: colour('line'), font: { color: colour('ink') } },
    legend: { orientation: 'h', x: 0, y: 1.02, yanchor: 'bottom', ...layout.legend },
    margin: { l: 58, r: 16, t: 30, b: 46, ...layout.margin },
  };
  for (const key of Object.keys(layout))
    if (/^[xy]axis\d*$/.test(key))
      result[key] = { ...axisColours(), automargin: true, ...layout[key], title: small(layout[key].title) };
  return result;
}

/**
 * `name` is that of the files it is saved as; `draw()` gives { data, layout } in the colours of the
 * moment, or a promise of them; `columns()` its numbers; a `control` is shown beside the title, and
 * its input draws anew.
 */
export function figure({ name, title, caption = '', draw, columns, control, wide = false, height = 320 }) {
  const plot = h('div', { class: 'plot', style: `height:${height}px` });
  const saveCsv = async () => save(`${name}.csv`, 'text/csv', csv(await columns()));
  const saveSvg = async () => {
    const { data, layout } = await inLight(async () => {
      const drawn = await draw();
      return { data: drawn.data, layout: themed(drawn.layout) };
    });
    const size = { width: plot.clientWidth, height: plot.clientHeight };
    const url = await Plotly.toImage({ data, layout: { ...layout, ...size } }, { format: 'svg', ...size });
    save(`${name}.svg`, 'image/svg+xml', decodeURIComponent(url.slice(url.indexOf(',') + 1)));
  };
  const element = h(
    'figure',
    { id: name, class: wide ? 'wide' : '' },
    h(
      'h3',
      {},
      h('span', {}, title),
      ...(control ? [control] : []),
      h('button', { type: 'button', onclick: saveSvg }, 'SVG'),
      h('button', { type: 'button', onclick: saveCsv }, 'CSV'),
    ),
    plot,
    h('figcaption', {}, caption),
  );
  let latest = 0;
  const show = async () => {
    const turn = ++latest;
    const { data, layout } = await draw();
    if (turn !== latest) return; // something newer is on its way
    await Plotly.react(plot, data, themed(layout), { responsive: true, displayModeBar: false });
  };
  control?.addEventListener('input', show);
  return { element, start: () => onTheme(show) };
}

/** A vertical line with a note at each of the strains: remeshings. */
export const verticals = (strains, text) => ({
  shapes: strains.map((x) => ({
    type: 'line',
    x0: x,
    x1: x,
    yref: 'paper',
    y0: 0,
    y1: 1,
    line: { color: colour('muted'), width: 1, dash: 'dot' },
  })),
  annotations: strains.map((x) => ({
    x,
    yref: 'paper',
    y: 1,
    text,
    showarrow: false,
    xanchor: 'left',
    yanchor: 'top',
    xshift: 3,
    font: { size: 11, color: colour('muted') },
  })),
});
