// SPDX-License-Identifier: Apache-2.0
/** How strokes are read, with other guesses to choose. */

import {textButton} from '../dom.js';
import {server, t} from '../strings.js';

/** @import {Parts, Point, Reading} from '../types.js' */

const LIKELY = 0.05; // the least confidence of a runner-up that is offered
const GLANCED = 2500; // ms for which a reading without a runner-up is shown

export class Readings {
  /** @param {Parts<'connection' | 'notes' | 'view' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    /** @type {Map<string, Point[]>} strokes by their request */
    this.strokes = new Map();
    this.dismiss = () => {};
    this.shown = ''; // request whose reading is shown
    this.since = -Infinity; // [s] when what is shown was built
    parts.view.overlays.push((view) => {
      for (const stroke of this.strokes.values()) view.line(stroke, view.palette.accent, [8, 6]);
    });
    parts.connection.on('reading', (reading) => this.#show(reading));
    // What was built is not there any more.
    parts.connection.on('frame', ({time}) => time < this.since && this.dismiss());
    parts.connection.on('answer', ({request, ok, code, topic}) => {
      if (ok && topic === '~/undo') this.dismiss();
      if (ok || code === 'not_recognised') return;
      this.strokes.delete(request);
      // Read, but not built.
      if (request === this.shown) this.dismiss();
    });
    // Until then they are shown as what is to be sent again.
    parts.connection.on('welcome', () => this.strokes.clear());
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
  #show({request, meaning, confidence, guesses, also, outline, built}) {
    const stroke = this.strokes.get(request) ?? outline;
    if (!stroke.length) return;
    this.dismiss();
    this.shown = request;
    this.since = built ? this.parts.world.frame.time : -Infinity;
    const at = /** @type {Point} */ ([
      stroke.reduce((sum, [x]) => sum + x, 0) / stroke.length, Math.max(...stroke.map(([, y]) => y))]);
    if (built) {
      this.strokes.delete(request);
      // A rope may be meant as a chain: no stroke tells them apart.
      const other = guesses.slice(1).filter(([guess, sure], i) => i ? guess === 'chain' : sure > LIKELY)
        .map(([guess]) => this.#guessButton(t('or {meaning}', {meaning: server(guess)}), request, guess));
      // Where somebody has chosen another guess, it is sure.
      const label = guesses.some(([, sure]) => sure > confidence) ? server(meaning) : labelOf(meaning, confidence);
      const content = [[label, ...also.map(server)].join('; '), ...other], shown = other.length ? undefined : GLANCED, {notes, world} = this.parts;
      // A note at the place would cover a running machine.
      this.dismiss = world.paused ? notes.pin(() => at, content, shown) : notes.dock(content, shown);
      return;
    }
    const choices = guesses.map(([guess, sure]) => this.#guessButton(labelOf(guess, sure), request, guess));
    const close = textButton('×', () => this.dismiss());
    close.ariaLabel = t('Forget the stroke');
    const words = choices.length ? t('Not sure. Is it') : t('Not recognised');
    const remove = this.parts.notes.pin(() => at, [words, ...choices, close], 0);
    this.dismiss = () => {
      remove();
      this.strokes.delete(request);
    };
  }

  /**
   * @param {string} label
   * @param {string} request of the stroke
   * @param {string} meaning
   */
  #guessButton(label, request, meaning) {
    return textButton(label, () => {
      this.parts.connection.send('instead', {meaning});
      this.dismiss();
      this.strokes.delete(request);
    });
  }
}

/**
 * @param {string} meaning
 * @param {number} confidence 0 .. 1
 */
function labelOf(meaning, confidence) {
  return `${server(meaning)} ${Math.round(100 * confidence)} %`;
}
