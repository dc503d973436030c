// The sample axes in a corner of the view.
import { Vector3 } from 'three';

const names = ['RD', 'TD', 'ND'];

function svg(name, attributes) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
}

export function makeAxes(holder) {
  const root = svg('svg', { viewBox: '-55 -55 110 110', class: 'axes' });
  const axes = names.map((name) => {
    const line = svg('line', { x1: 0, y1: 0 }),
      text = svg('text', {});
    text.textContent = name;
    root.append(line, text);
    return { line, text };
  });
  holder.append(root);
  return (camera) =>
    axes.forEach(({ line, text }, i) => {
      const d = new Vector3().setComponent(i, 1).transformDirection(camera.matrixWorldInverse);
      line.setAttribute('x2', 32 * d.x);
      line.setAttribute('y2', -32 * d.y);
      text.setAttribute('x', 45 * d.x);
      text.setAttribute('y', -45 * d.y);
    });
}
