// What the run took: iterations of each step, time by stage.
import { figure, verticals } from '../figure.js';
import { duration, number } from '../format.js';
import { section } from '../section.js';
import { remeshingStrains } from './curves.js';

function iterations(report) {
  const { macro } = report;
  return figure({
    name: 'iterations',
    title: 'Iterations of each step',
    caption: 'Cut attempts included.',
    draw: () => ({
      data: [
        {
          x: macro.strain,
          y: macro.linear_iterations,
          name: 'linear',
          mode: 'lines+markers',
          marker: { size: 4 },
        },
        {
          x: macro.strain,
          y: macro.newton_iterations,
          name: 'Newton',
          mode: 'lines+markers',
          marker: { size: 4 },
          yaxis: 'y2',
        },
      ],
      layout: {
        xaxis: { title: { text: 'strain' }, rangemode: 'tozero' },
        yaxis: { title: { text: 'linear iterations' }, rangemode: 'tozero' },
        yaxis2: {
          title: { text: 'Newton iterations' },
          overlaying: 'y',
          side: 'right',
          rangemode: 'tozero',
          showgrid: false,
        },
        margin: { r: 58 },
        ...verticals(remeshingStrains(report), ''),
      },
    }),
    columns: () => ({
      strain: macro.strain,
      newton: macro.newton_iterations,
      linear: macro.linear_iterations,
    }),
  });
}

function stepSizes(report) {
  const { macro } = report;
  return figure({
    name: 'step-size',
    title: 'Step size',
    caption: 'The step grows by itself after the start, after each remeshing and after a cut.',
    draw: () => ({
      data: [
        { x: macro.strain, y: macro.step_size, mode: 'lines+markers', marker: { size: 4 }, name: 'step' },
      ],
      layout: {
        xaxis: { title: { text: 'strain' }, rangemode: 'tozero' },
        yaxis: { title: { text: 'increment of strain' }, type: 'log', exponentformat: 'power' },
        ...verticals(remeshingStrains(report), ''),
      },
    }),
    columns: () => ({ strain: macro.strain, step_size: macro.step_size }),
  });
}

function stages(report) {
  const entries = Object.entries(report.summary?.cpu_s ?? {}).sort((a, b) => a[1] - b[1]);
  if (entries.length === 0) return null;
  const names = entries.map(([name]) => name),
    seconds = entries.map(([, s]) => s);
  return figure({
    name: 'time',
    wide: true,
    title: 'CPU time by stage',
    caption: `All ranks and workers; ${duration(report.summary.wall_s)} of wall time.`,
    height: 60 + 36 * names.length,
    draw: () => ({
      data: [
        {
          type: 'bar',
          orientation: 'h',
          x: seconds,
          y: names,
          text: seconds.map((s) => `${number(s)} s`),
          textposition: 'auto',
          hoverinfo: 'skip',
        },
      ],
      layout: { xaxis: { title: { text: 'CPU seconds' } }, yaxis: {}, margin: { t: 8 } },
    }),
    columns: () => ({ stage: names, cpu_s: seconds }),
  });
}

export function work(report) {
  const figures = [iterations(report), stepSizes(report), stages(report)].filter(Boolean);
  return section('work', 'Solver and time', 'What the steps took, and where the time went.', ...figures);
}
