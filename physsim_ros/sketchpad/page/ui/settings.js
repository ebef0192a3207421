// SPDX-License-Identifier: Apache-2.0
/** What a reader chooses for this browser: light or dark, the language, words at icons, sentences about what moves. */

import {checkField, languageField} from '../dom.js';
import {t} from '../strings.js';

/** @import {App} from '../types.js' */

const WORDS = 'physsim-words', SPEAKS = 'physsim-speaks'; // keys

export class Settings {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    app.connection.on('scene', () => this.#showWords());
    addEventListener('resize', () => this.#showWords());
  }

  /** @returns {boolean} whether icons have words: until somebody chooses, in lessons, where there is room */
  get words() {
    const chosen = localStorage.getItem(WORDS), {world, room} = this.app;
    return chosen === null ? Boolean(world.scene.lesson) && room.isRoomy : chosen === '1';
  }

  /** @returns {boolean} whether the motion of all bodies is told, not of the selected ones alone */
  get speaks() {
    return localStorage.getItem(SPEAKS) === '1';
  }

  #showWords() {
    document.body.classList.toggle('words', this.words);
  }

  /** @returns {HTMLElement[]} */
  fields() {
    return [languageField(), checkField(t('Words at icons'), this.words, (checked) => {
      localStorage.setItem(WORDS, checked ? '1' : '0');
      this.#showWords();
    }), checkField(t('Tell what moves, for screen readers'), this.speaks, (checked) => {
      localStorage.setItem(SPEAKS, checked ? '1' : '0');
      this.app.askForParts();
    })];
  }
}

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
