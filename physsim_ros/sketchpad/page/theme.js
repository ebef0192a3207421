// SPDX-License-Identifier: Apache-2.0
/** Light and dark: as the system has it until the reader chooses; the colours of the canvas. */

/** @import {Palette} from './types.js' */

const KEY = 'physsim-theme';
const NAMES = ['paper', 'minor', 'major', 'faint', 'ink', 'accent', 'force', 'warn', 'weight', 'friction', 'joint', 'air', 'applied', 'momentum'];

/** @returns {Palette} */
export function readPalette() {
  const style = getComputedStyle(document.documentElement);
  const entries = NAMES.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]);
  return Object.fromEntries(entries);
}

/** @param {() => void} listener */
export function watchTheme(listener = () => {}) {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const set = () => {
    const chosen = localStorage.getItem(KEY);
    document.documentElement.dataset.theme = chosen ?? (dark.matches ? 'dark' : 'light');
    listener();
  };
  dark.addEventListener('change', set);
  addEventListener('storage', set);
  addEventListener('theme', set);
  set();
}

export function switchTheme() {
  const now = document.documentElement.dataset.theme;
  localStorage.setItem(KEY, now === 'dark' ? 'light' : 'dark');
  dispatchEvent(new Event('theme'));
}
