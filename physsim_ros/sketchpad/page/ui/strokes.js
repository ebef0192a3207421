// SPDX-License-Identifier: Apache-2.0
/** The card of what the pen understands: each stroke as a small picture that draws itself. */

import {createElement, createGraphic, elementOf, iconButton} from '../dom.js';
import {t} from '../strings.js';

/** @import {Parts} from '../types.js' */

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

/** The card beside a canvas on which nothing can move yet, until somebody has drawn or closes it. It is faint in a gesture, which may pass under it. */
export class EmptyCard {
  /** @param {Parts<'connection' | 'people' | 'pointers' | 'selection' | 'view' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.closed = false;
    this.element = elementOf('card');
    parts.connection.on('scene', () => this.#update());
    parts.connection.on('reading', ({built}) => built && this.#close());
    parts.selection.on('change', () => this.#update());
    parts.view.overlays.push(() => this.element.classList.toggle('faint', parts.pointers.isBusy));
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
  }
}

/** @returns {HTMLElement} */
export function strokeCard() {
  return createElement('ul', {className: 'strokes'}, ...STROKES.map(([name, stroke, before]) => createElement('li', {}, picture(stroke, before), name)));
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
