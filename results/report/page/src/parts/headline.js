// Title and the numbers that come first.
import { h } from '../dom.js';
import { count, duration, number } from '../format.js';

const tile = (value, label, bad = false) =>
  h('div', { class: bad ? 'tile bad' : 'tile' }, h('b', {}, value), h('span', {}, label));

/** von Mises stress of the 3 x 3 list. */
function vonMises(s) {
  const normal = (s[0][0] - s[1][1]) ** 2 + (s[1][1] - s[2][2]) ** 2 + (s[2][2] - s[0][0]) ** 2;
  return Math.sqrt(normal / 2 + 3 * (s[0][1] ** 2 + s[1][2] ** 2 + s[2][0] ** 2));
}

export function headline(report, main) {
  document.title = `${report.title} – Polyslip report`;
  document.getElementById('title').textContent = report.title;
  const first = report.states[0],
    last = report.states.at(-1);
  const s = report.summary;
  document.getElementById('subtitle').textContent =
    `${count(last.grain_volume.length)} grains, ${count(last.elements)} ten-node tetrahedra, ` +
    `to a strain of ${number(last.strain)}` +
    (s?.completed ? '' : '; the run has not reached its end');
  document.getElementById('made-by').textContent = `Made by polyslip ${report.version}.`;
  const tiles = [
    tile(count(last.grain_volume.length), 'grains'),
    tile(
      count(last.elements),
      first.elements === last.elements ? 'elements' : `elements, ${count(first.elements)} at first`,
    ),
    tile(number(last.strain), 'final strain'),
  ];
  if (s) {
    tiles.push(
      tile(`${number(vonMises(s.stress_final_mpa))} MPa`, 'von Mises stress at the end'),
      tile(String(s.remeshings.length), 'remeshings'),
      tile(count(s.steps), `steps, ${count(s.step_cuts)} cut`, s.step_cuts > 0.2 * s.steps),
      tile(duration(s.wall_s), 'wall time'),
      tile(`${count(Math.round(s.peak_rss_mb))} MB`, 'peak memory'),
    );
  } else tiles.push(tile('stopped', 'no summary.json', true));
  if (s && !s.completed) tiles.push(tile('stopped', 'before its end', true));
  main.append(h('div', { class: 'tiles' }, ...tiles));
}
