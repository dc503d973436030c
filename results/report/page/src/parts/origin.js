// Deck and provenance.
import { h, table } from '../dom.js';
import { section } from '../section.js';

const listing = (title, text, open) =>
  text === '' ? [] : [h('details', { open }, h('summary', {}, title), h('pre', {}, text))];

export function origin(report) {
  const rows = Object.entries({
    'polyslip of the report': report.version,
    ...(report.summary
      ? { 'polyslip of the run': report.summary.version, seed: String(report.summary.seed) }
      : {}),
    ...report.provenance,
  });
  return section(
    'origin',
    'Deck and provenance',
    'All it takes to compute this run again.',
    table(['', ''], rows),
    ...listing('Deck as given', report.deck, true),
    ...listing('Deck as understood, with every default', report.resolved_deck, false),
  );
}
