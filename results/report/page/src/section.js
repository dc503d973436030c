// A part of the report: a heading, a sentence, figures.
import { h } from './dom.js';

export function section(id, title, text, ...content) {
  const figures = content.filter((item) => item.start);
  const rest = content.filter((item) => !item.start);
  const element = h('section', { id }, h('h2', {}, title), h('p', {}, text));
  if (figures.length > 0) element.append(h('div', { class: 'figures' }, ...figures.map((f) => f.element)));
  element.append(...rest);
  return { id, title, element, start: () => Promise.all(figures.map((f) => f.start())) };
}
