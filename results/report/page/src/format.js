// Numbers as people read them.

const grouped = new Intl.NumberFormat('en-GB');

/** 12,345 */
export const count = (n) => (n == null ? '–' : grouped.format(n));

const raised = (sign, digits) => (sign === '-' ? '⁻' : '') + [...digits].map((d) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[d]).join('');

/** Three significant digits or those asked, without an exponent where that is short. */
export function number(x, digits = 3) {
  if (x == null || !Number.isFinite(x)) return '–';
  const size = Math.abs(x);
  if (size < 1e-10) return '0'; // rounding
  if (size < 1e-3 || size >= 1e6)
    return x
      .toExponential(digits - 1)
      .replace(/e([+-]?)(\d+)/, (_, sign, power) => ` × 10${raised(sign, power)}`);
  return x
    .toPrecision(Math.max(digits, Math.ceil(Math.log10(size))))
    .replace(/(\.\d*?)0+$/, '$1')
    .replace(/\.$/, '');
}

export const percent = (x) => (x == null ? '–' : `${number(100 * x)} %`);

/** 54 s, 12 min, 3 h 20 min */
export function duration(seconds) {
  if (seconds == null) return '–';
  if (seconds < 90) return `${number(seconds, 2)} s`;
  const minutes = Math.round(seconds / 60);
  if (minutes < 90) return `${minutes} min`;
  return `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

export const withUnit = (text, unit) => (unit === '' ? text : unit === '°' ? `${text}°` : `${text} ${unit}`);
export const axisTitle = (label, unit) => (unit === '' ? label : `${label} (${unit})`);
