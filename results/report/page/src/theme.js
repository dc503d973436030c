// Light and dark: the system's until the reader chooses; paper is light.

const listeners = [];
const system = matchMedia('(prefers-color-scheme: dark)');
let chosen = null;

export const colour = (name) =>
  getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/** Calls `listener` now and whenever the theme changes; what it returns now. */
export function onTheme(listener) {
  listeners.push(listener);
  return listener();
}

function set(theme) {
  document.documentElement.dataset.theme = theme;
  document.getElementById('theme').textContent = theme === 'dark' ? 'Light' : 'Dark';
  for (const listener of listeners) listener();
}

const current = () => chosen ?? (system.matches ? 'dark' : 'light');

/** What `make` promises, made in the light colours. */
export async function inLight(make) {
  const { dataset } = document.documentElement;
  dataset.theme = 'light';
  try {
    return await make();
  } finally {
    dataset.theme = current();
  }
}

export function startTheme() {
  document.getElementById('theme').addEventListener('click', () => {
    chosen = document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark';
    set(chosen);
  });
  system.addEventListener('change', () => set(current()));
  addEventListener('beforeprint', () => set('light'));
  addEventListener('afterprint', () => set(current()));
  set(current());
}
