// Stress against strain, and the means of the other quantities.
import { figure, verticals } from '../figure.js';
import { axisTitle } from '../format.js';
import { section } from '../section.js';
import { colour } from '../theme.js';

/** Each is the strain of the step before the first one on the new mesh. */
export const remeshingStrains = ({ macro }) =>
  macro.remeshed.flatMap((flag, i) => (flag === 1 ? [macro.strain[i - 1] ?? 0] : []));

const vonMises = (m) =>
  m.strain.map((_, i) =>
    Math.sqrt(
      ((m.sxx[i] - m.syy[i]) ** 2 + (m.syy[i] - m.szz[i]) ** 2 + (m.szz[i] - m.sxx[i]) ** 2) / 2 +
        3 * (m.syz[i] ** 2 + m.szx[i] ** 2 + m.sxy[i] ** 2),
    ),
  );

/** The curve in pieces, from zero stress at the start and after each remeshing. */
function pieces(macro, stress) {
  const x = [0],
    y = [0];
  macro.strain.forEach((strain, i) => {
    if (macro.remeshed[i] === 1) {
      x.push(null, macro.strain[i - 1] ?? 0);
      y.push(null, 0);
    }
    x.push(strain);
    y.push(stress[i]);
  });
  return { x, y };
}

function stressStrain(report) {
  const { macro } = report;
  const curve = {
    'stress along the load': macro.load_stress,
    'von Mises': vonMises(macro),
    xx: macro.sxx,
    yy: macro.syy,
    zz: macro.szz,
  };
  const taylor = report.taylor
    ? [
        ['stress along the load', report.taylor.macro.load_stress],
        ['von Mises', vonMises(report.taylor.macro)],
      ]
    : [];
  const line = { mode: 'lines', hovertemplate: '%{y:.3f} MPa at %{x:.4f}<extra>%{fullData.name}</extra>' };
  return figure({
    name: 'stress-strain',
    title: 'Stress against strain',
    caption:
      'Mean over the volume. After a remeshing stresses start from zero and are back on the ' +
      'curve within some thousandths of strain.',
    wide: true,
    height: 360,
    draw: () => ({
      data: [
        ...Object.entries(curve).map(([name, stress], i) => ({
          ...pieces(macro, stress),
          ...line,
          name,
          line: { width: i < 2 ? 2.2 : 1.3 },
          visible: i < 2 ? true : 'legendonly',
        })),
        ...taylor.map(([name, stress], i) => ({
          ...line,
          x: report.taylor.macro.strain,
          y: stress,
          name: `${name}, Taylor`,
          line: { width: 1.6, dash: 'dash', color: colour(`c${i}`) },
        })),
      ],
      layout: {
        xaxis: { title: { text: 'strain' }, rangemode: 'tozero' },
        yaxis: { title: { text: 'stress (MPa)' } },
        hovermode: 'closest',
        ...verticals(remeshingStrains(report), 'remeshed'),
      },
    }),
    columns: () => ({
      strain: macro.strain,
      load_stress: macro.load_stress,
      von_mises: curve['von Mises'],
      sxx: macro.sxx,
      syy: macro.syy,
      szz: macro.szz,
    }),
  });
}

/** A quantity's mean over the states with the band that holds 98 % of the elements. */
function meanFigure(report, name) {
  const quantity = report.quantities.find((q) => q.name === name);
  const values = report.states.map((s) => s.values[name]);
  const strain = report.states.map((s) => s.strain);
  const column = (key) => values.map((v) => v[key]);
  if (column('mean').every((v) => v == null)) return null;
  const edge = { x: strain, mode: 'lines', line: { width: 0 }, hoverinfo: 'skip' };
  return figure({
    name: `mean-${name.replace('_', '-')}`,
    title: `${quantity.label[0].toUpperCase()}${quantity.label.slice(1)}`,
    caption:
      'Mean by volume at the stored states; the band leaves out the lowest and the highest ' +
      'per cent of the elements.',
    height: 270,
    draw: () => ({
      data: [
        { ...edge, y: column('low'), showlegend: false },
        {
          ...edge,
          y: column('high'),
          fill: 'tonexty',
          fillcolor: colour('accent-soft'),
          name: '98 % of the elements',
        },
        { x: strain, y: column('mean'), mode: 'lines+markers', name: 'mean', line: { color: colour('c0') } },
      ],
      layout: {
        xaxis: { title: { text: 'strain' } },
        yaxis: {
          title: { text: axisTitle(quantity.label, quantity.unit) },
          rangemode: name === 'g' ? 'normal' : 'tozero',
        },
      },
    }),
    columns: () => ({
      strain,
      mean: column('mean'),
      first_per_cent: column('low'),
      last_per_cent: column('high'),
    }),
  });
}

export function curves(report) {
  const means = ['g', 'slip', 'spread', 'equivalent_strain'].map((name) => meanFigure(report, name));
  return section(
    'curves',
    'Stress and strain',
    'Stresses are averages over the volume, in sample axes x = RD, y = TD, z = ND.',
    stressStrain(report),
    ...means.filter(Boolean),
  );
}
