// Which grains count: all, inner ones, those of one mode (fig. 20 of the paper).
import { h } from '../dom.js';

const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;

/** Linear correlation coefficient of two lists. */
function correlation(x, y) {
  const [mx, my] = [mean(x), mean(y)];
  const sum = (f) => x.reduce((total, _, i) => total + f(x[i] - mx, y[i] - my), 0);
  return sum((a, b) => a * b) / Math.sqrt(sum((a) => a * a) * sum((_, b) => b * b));
}

/** The states with the lists of the grains kept, and their means. */
function kept(spreads, keep) {
  const indices = keep.flatMap((yes, g) => (yes ? [g] : []));
  const pick = (list) => indices.map((g) => list[g]);
  const states = spreads.states.map((s) => ({
    strain: s.strain,
    grain: indices.map((g) => g + 1),
    spread: pick(s.spread),
    rotation: pick(s.rotation),
  }));
  if (indices.length === keep.length) return states.map((s, i) => ({ ...spreads.states[i], grain: s.grain }));
  return states.map((s, i) => {
    const average = mean(s.spread);
    return {
      ...s,
      mean: average,
      deviation: Math.sqrt(mean(s.spread.map((v) => (v - average) ** 2))),
      volume_mean: NaN,
      correlation: i > 0 && mean(states[i - 1].spread) > 1e-6 ? correlation(states[i - 1].spread, s.spread) : NaN,
    };
  });
}

/** A select, and chosen(): the states of the grains that it names. */
export function grainChoice(spreads) {
  const { inner, one_mode_bound: bound } = spreads;
  const oneMode = inner.map((_, g) =>
    spreads.states.every((s) => s.spread[g] <= 1e-6 || s.bimodality[g] <= bound),
  );
  const choices = [
    ['all grains', inner.map(() => true)],
    ['inner grains', inner],
    ['of one mode', oneMode],
    ['inner, of one mode', inner.map((yes, g) => yes && oneMode[g])],
  ].filter(([, keep]) => keep.some(Boolean));
  const control = h(
    'select',
    { 'aria-label': 'grains' },
    ...choices.map(([name], i) => h('option', { value: i }, name)),
  );
  return { control, chosen: () => kept(spreads, choices[Number(control.value)][1]) };
}
