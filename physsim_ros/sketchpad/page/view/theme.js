// SPDX-License-Identifier: Apache-2.0
/** Light or dark: as the system has it, until somebody chooses the other; and the colours of the canvas. */

const KEY = 'physsim-theme';
/** Colours of the canvas, as the style sheet names them. */
const NAMES = /** @type {const} */ (['paper', 'minor', 'major', 'faint', 'ink', 'accent', 'force', 'warn', 'weight', 'friction',
  'joint', 'air', 'applied', 'momentum']);
/** @typedef {Record<typeof NAMES[number], string>} Palette */

/** @returns {Palette} */
export function readPalette() {
  const style = getComputedStyle(document.documentElement);
  return /** @type {Palette} */ (Object.fromEntries(NAMES.map((name) => [name, style.getPropertyValue(`--${name}`).trim()])));
}

/** @param {() => void} listener */
export function watchTheme(listener = () => {}) {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const set = (/** @type {Event} */ {type} = new Event('theme')) => {
    // Paper is light.
    const chosen = type === 'beforeprint' ? 'light' : localStorage.getItem(KEY);
    document.documentElement.dataset.theme = chosen ?? (dark.matches ? 'dark' : 'light');
    listener();
  };
  dark.addEventListener('change', set);
  addEventListener('storage', set);
  for (const type of ['theme', 'beforeprint', 'afterprint']) addEventListener(type, set);
  set();
}

export function switchTheme() {
  const now = document.documentElement.dataset.theme;
  localStorage.setItem(KEY, now === 'dark' ? 'light' : 'dark');
  dispatchEvent(new Event('theme'));
}
