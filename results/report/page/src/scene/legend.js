// What the colours mean.
import { h } from '../dom.js';
import { number, withUnit } from '../format.js';
import { ipfOfDirection, rampGradient } from './colours.js';

const axisNames = ['RD', 'TD', 'ND'];

/** The standard triangle, equal-area, painted point by point. */
function triangle(size) {
  const canvas = h('canvas', { width: 2 * size, height: 1.9 * size, style: `width:${size}px` });
  const context = canvas.getContext('2d');
  const { width, height } = canvas;
  const scale = 0.8 * width,
    left = 0.06 * width,
    base = 0.8 * height;
  const extent = 2 * Math.sin(Math.PI / 8); // of [101], 45 degrees from [001], over sqrt 2 sqrt 2
  const image = context.createImageData(width, height);
  for (let j = 0; j < height; ++j)
    for (let i = 0; i < width; ++i) {
      const X = ((i - left) / scale) * extent,
        Y = ((base - j) / scale) * extent;
      const square = X * X + Y * Y,
        up = 1 - square / 2,
        flat = Math.sqrt(1 - square / 4);
      const [x, y] = [X * flat, Y * flat];
      if (y < 0 || y > x || x > up) continue;
      image.data.set([...ipfOfDirection([x, y, up]), 255], 4 * (j * width + i));
    }
  context.putImageData(image, 0, 0);
  context.fillStyle = getComputedStyle(document.body).color;
  context.font = '22px system-ui, sans-serif';
  context.fillText('001', 0, base + 26);
  context.fillText('101', left + 0.86 * scale, base + 26);
  context.fillText('111', left + 0.7 * scale, 0.12 * height);
  return canvas;
}

export function legend(mode, quantity, range) {
  if (mode === 'rodrigues')
    return h(
      'div',
      {},
      'Red, green and blue are the components of the Rodrigues vector in the ' +
        'fundamental region, as in the paper’s fig. 17.',
    );
  if (mode === 'grain') return h('div', {}, 'A colour a grain, without a meaning of its own.');
  if (mode.startsWith('ipf'))
    return h(
      'div',
      {},
      triangle(120),
      h('div', {}, `Crystal direction along ${axisNames[Number(mode.at(-1))]}.`),
    );
  return h(
    'div',
    {},
    h('div', { class: 'bar', style: `background:${rampGradient}` }),
    h(
      'div',
      { class: 'bar-ends' },
      h('span', {}, `≤ ${number(range.low)}`),
      h('span', {}, `≥ ${withUnit(number(range.high), quantity.unit)}`),
    ),
  );
}
