import { report } from './data.js';
import { h } from './dom.js';
import { curves } from './parts/curves.js';
import { headline } from './parts/headline.js';
import { origin } from './parts/origin.js';
import { polycrystal } from './parts/polycrystal.js';
import { spreads } from './parts/spreads.js';
import { texture } from './parts/texture.js';
import { quality } from './parts/quality.js';
import { work } from './parts/work.js';
import { startTheme } from './theme.js';

startTheme();
const main = document.getElementById('report');
headline(report, main);
const started = [];
for (const part of [polycrystal, curves, texture, spreads, quality, work, origin]) {
  const made = part(report);
  if (!made) continue;
  main.append(made.element);
  document.getElementById('contents').append(h('a', { href: `#${made.id}` }, made.title));
  started.push(made.start());
}
Promise.all(started).then(() => {
  document.documentElement.dataset.ready = 'yes';
});
