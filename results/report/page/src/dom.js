// Elements in short.

/** h('p', { class: 'x', onclick: f }, 'text', child) */
export function h(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith('on')) element.addEventListener(key.slice(2), value);
    else if (value === true) element.setAttribute(key, '');
    else if (value !== false && value != null) element.setAttribute(key, value);
  }
  element.append(...children);
  return element;
}

/** A table: heads of the columns, rows of texts. */
export function table(heads, rows) {
  const cells = (tag, texts) => h('tr', {}, ...texts.map((text) => h(tag, {}, text)));
  return h(
    'div',
    { class: 'scroll' },
    h(
      'table',
      {},
      h('thead', {}, cells('th', heads)),
      h('tbody', {}, ...rows.map((row) => cells('td', row))),
    ),
  );
}
