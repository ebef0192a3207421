// SPDX-License-Identifier: Apache-2.0
/** What a reader chooses in the help for this browser: the language, words at icons, keys, sentences about what moves. */

import {checkField, languageField} from '../dom.js';
import {isRoomy} from '../view/room.js';
import {t} from '../strings.js';

/** @import {Parts} from '../types.js' */

const WORDS = 'physsim-words', SPEAKS = 'physsim-speaks', LETTERS = 'physsim-letters'; // keys

export class Settings {
  /** @param {Parts<'connection' | 'dialog' | 'frames' | 'notes' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    parts.connection.on('scene', () => this.#showWords());
    addEventListener('resize', () => this.#showWords());
    this.#want();
  }

  /** @returns {boolean} whether icons have words: until somebody chooses, in lessons, where there is room */
  get words() {
    const chosen = localStorage.getItem(WORDS), {world} = this.parts;
    return chosen === null ? Boolean(world.scene.lesson) && isRoomy() : chosen === '1';
  }

  /** @returns {boolean} whether the motion of all bodies is told, not of the selected ones alone */
  get speaks() {
    return localStorage.getItem(SPEAKS) === '1';
  }

  /** @returns {boolean} whether keys of one character choose tools and work time (WCAG 2.2, 2.1.4) */
  get letters() {
    return localStorage.getItem(LETTERS) !== '0';
  }

  showHelp() {
    const {dialog, notes} = this.parts;
    notes.load(import('./help.js'), ({showHelp}) => showHelp(dialog, this.#fields()));
  }

  #want() {
    this.parts.frames.want(this, {velocities: this.speaks, contacts: this.speaks});
  }

  #showWords() {
    document.body.classList.toggle('words', this.words);
  }

  /** @returns {HTMLElement[]} */
  #fields() {
    return [languageField(), checkField(t('Words at icons'), this.words, (checked) => {
      localStorage.setItem(WORDS, checked ? '1' : '0');
      this.#showWords();
    }), checkField(t('Letters and digits as keys'), this.letters, (checked) => localStorage.setItem(LETTERS, checked ? '1' : '0')),
    checkField(t('Tell what moves, for screen readers'), this.speaks, (checked) => {
      localStorage.setItem(SPEAKS, checked ? '1' : '0');
      this.#want();
    })];
  }
}
