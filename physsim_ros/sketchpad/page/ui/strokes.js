// SPDX-License-Identifier: Apache-2.0
/** Strokes: the card of what the pen understands, each as a small picture that draws itself; and how strokes are read, with other guesses to choose. */

import {createElement, createGraphic, elementOf, iconButton, textButton} from '../dom.js';
import {t} from '../strings.js';
import {thingWord} from '../words.js';

/** @import {Parts, Point, Reading} from '../types.js' */

/**
 * What it is called, the stroke that is drawn, and what is there before it. In a box of 60 by 40.
 * @type {[string, string, string?][]}
 */
const STROKES = [
  [t('circle'), 'M44 20a14 14 0 1 1-1-5'],
  [t('box, polygon'), 'M15 9h30v22H15V10'],
  [t('line: wall'), 'M8 26 52 22'],
  [t('x: anchor'), 'M24 14 36 26 30 20 36 14 24 26', 'M14 9h32v22H14z'],
  [t('small circle: axle'), 'M34 20a4 4 0 1 1 0-1', 'M8 14h32v12H8zM22 8h30v24H22z'],
  [t('round arrow: motor'), 'M40 20a10 10 0 1 1-4-8M30 8l7 4-6 6', 'M32 20a2 2 0 1 1 0-1M14 4h32v32H14z'],
  [t('small square: pin'), 'M27 16h8v8h-8z', 'M8 14h30v12H8zM22 8h30v24H22z'],
  [t('zigzag: spring'), 'M9 20h5l4-7 5 14 5-14 5 14 5-14 5 14 3-7h5', 'M4 12h10v16H4zM46 12h10v16H46z'],
  [t('straight: rod'), 'M9 20h42', 'M4 12h10v16H4zM46 12h10v16H46z'],
  [t('slack: rope, chain'), 'M9 12Q30 50 51 12', 'M4 6h10v12H4zM46 6h10v12H46z'],
  [t('arrow: gravity'), 'M30 5V34l-7-8 7 8 7-8'],
  [t('arrow from a body: velocity'), 'M16 20h36l-8-7 8 7-8 7', 'M6 10h20v20H6z'],
  [t('hatching: heavier'), 'M22 26 34 14M26 28 38 16', 'M14 9h32v22H14z'],
  [t('scribble: delete'), 'M10 30 20 8 24 32 32 8 37 32 44 8 50 30', 'M16 11h28v18H16z'],
];
const SEEN = 'physsim-strokes';

/** The card beside a canvas on which nothing can move yet, until somebody has drawn or closes it. It is faint in a gesture, which may pass under it. */
export class EmptyCard {
  /** @param {Parts<'connection' | 'gestures' | 'people' | 'selection' | 'view' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.closed = false;
    this.element = elementOf('card');
    parts.connection.on('scene', () => this.#update());
    parts.connection.on('reading', ({built}) => built && this.#close());
    parts.selection.on('change', () => this.#update());
    parts.view.overlays.push(() => this.element.classList.toggle('faint', parts.gestures.isBusy));
  }

  #close() {
    this.closed = true;
    this.#update();
  }

  #update() {
    const {parts, element} = this, {epoch, bodies} = parts.world.scene;
    const empty = epoch >= 0 && bodies.every(({anchored}) => anchored);
    if (!empty) this.closed = false;
    const hidden = !empty || this.closed || parts.people.viewOnly || parts.selection.kind !== '';
    if (hidden === element.hidden) return;
    element.hidden = hidden;
    if (hidden) return;
    element.replaceChildren(createElement('header', {}, createElement('h2', {}, t('Draw with the pen')),
      iconButton(t('Close'), 'close', () => this.#close())), strokeCard());
    noteSeen();
  }
}

/** @returns {HTMLElement} */
export function strokeCard() {
  const fresh = !localStorage.getItem(SEEN);
  return createElement('ul', {className: 'strokes'}, ...STROKES.map(([name, stroke, before]) => {
    const item = createElement('li', {}, picture(stroke, before), name);
    // Animated at its first use, and when it is pointed at.
    item.classList.toggle('fresh', fresh);
    return item;
  }));
}

/** Note that the card was seen: from now on only the picture that is pointed at moves. */
export function noteSeen() {
  localStorage.setItem(SEEN, '1');
}

/**
 * @param {string} stroke
 * @param {string} before
 */
function picture(stroke, before = '') {
  return createGraphic('svg', {viewBox: '0 0 60 40', 'aria-hidden': 'true'},
    ...before ? [createGraphic('path', {d: before, class: 'before'})] : [],
    createGraphic('path', {d: stroke, class: 'stroke', pathLength: '1'}));
}

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
        .map(([guess]) => this.#guessButton(t('or {meaning}', {meaning: thingWord(guess)}), request, guess));
      // Where somebody has chosen another guess, it is sure.
      const label = guesses.some(([, sure]) => sure > confidence) ? thingWord(meaning) : labelOf(meaning, confidence);
      const content = [[label, ...also.map(thingWord)].join('; '), ...other], shown = other.length ? undefined : GLANCED, {notes, world} = this.parts;
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
  return `${thingWord(meaning)} ${Math.round(100 * confidence)} %`;
}
