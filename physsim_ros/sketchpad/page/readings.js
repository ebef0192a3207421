// SPDX-License-Identifier: Apache-2.0
/** Strokes until they are read, and their readings beside them, with other guesses to choose. */

import {textButton} from './dom.js';
import {t} from './strings.js';
import {thingWord} from './words.js';

/** @import {App, Point, Reading} from './types.js' */

const LIKELY = 0.05; // the least confidence of a runner-up that is offered
const GLANCED = 2500; // ms for which a reading without a runner-up is shown

export class Readings {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {Map<string, Point[]>} strokes by their request */
    this.strokes = new Map();
    this.dismiss = () => {};
    this.shown = ''; // request whose reading is shown
    app.view.overlays.push((view) => {
      for (const stroke of this.strokes.values()) view.line(stroke, view.palette.accent, [8, 6]);
    });
    app.connection.on('reading', (reading) => this.#show(reading));
    app.connection.on('answer', ({request, ok, code}) => {
      if (ok || code === 'not_recognised') return;
      this.#forget(request);
      // Read, but not built.
      if (request === this.shown) this.dismiss();
    });
    app.connection.on('closed', () => this.strokes.clear());
  }

  /**
   * @param {string} request
   * @param {Point[]} stroke
   */
  addStroke(request, stroke) {
    this.dismiss();
    if (request) this.strokes.set(request, stroke);
  }

  /** @param {Reading} reading */
  #show({request, meaning, confidence, guesses, outline, built}) {
    const stroke = this.strokes.get(request) ?? outline;
    if (!stroke.length) return;
    this.dismiss();
    this.shown = request;
    const at = /** @type {Point} */ ([
      stroke.reduce((sum, [x]) => sum + x, 0) / stroke.length, Math.max(...stroke.map(([, y]) => y))]);
    if (built) {
      this.#forget(request);
      // A rope may be meant as a chain: no stroke tells them apart.
      const other = guesses.slice(1).filter(([guess, sure], i) => i ? guess === 'chain' : sure > LIKELY)
        .map(([guess]) => this.#guessButton(t('or {meaning}', {meaning: thingWord(guess)}), request, guess));
      // A note at the place would cover a running machine.
      const kind = this.app.world.paused ? '' : 'docked';
      // Where somebody has chosen another guess, it is sure.
      const label = guesses.some(([, sure]) => sure > confidence) ? thingWord(meaning) : labelOf(meaning, confidence);
      this.dismiss = this.app.notes.pin(() => at, [label, ...other],
        other.length ? {kind} : {kind, shown: GLANCED});
      return;
    }
    const choices = guesses.map(([guess, sure]) => this.#guessButton(labelOf(guess, sure), request, guess));
    const close = textButton('×', () => this.dismiss());
    close.ariaLabel = t('Forget the stroke');
    const words = choices.length ? t('Not sure. Is it') : t('Not recognised');
    const remove = this.app.notes.pin(() => at, [words, ...choices, close], {shown: 0});
    this.dismiss = () => {
      remove();
      this.#forget(request);
    };
  }

  /**
   * @param {string} label
   * @param {string} request of the stroke
   * @param {string} meaning
   */
  #guessButton(label, request, meaning) {
    return textButton(label, () => {
      this.app.connection.send('instead', {meaning});
      this.dismiss();
      this.#forget(request);
    });
  }

  /** @param {string} request */
  #forget(request) {
    this.strokes.delete(request);
    this.app.view.dirty = true;
  }
}

/**
 * @param {string} meaning
 * @param {number} confidence 0 .. 1
 */
function labelOf(meaning, confidence) {
  return `${thingWord(meaning)} ${Math.round(100 * confidence)} %`;
}
