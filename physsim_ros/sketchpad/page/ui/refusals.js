// SPDX-License-Identifier: Apache-2.0
/** Refusals: beside the body that they name, or where they were asked for. */

import {PASSING} from '../connection.js';
import {READ} from './notes.js';
import {t} from '../strings.js';

/** @import {Parts, Point, SceneView} from '../types.js' */

/** @typedef {{point: ?Point, names: string[]}} Place of a request: a point [m], or bodies */

const OUTLINED = 2500; // ms for which a body has an outline
const KEPT = 100; // requests whose places are known: a stroke is answered by its reading, then by its requests

export class Refusals {
  /** @param {Parts<'connection' | 'notes' | 'view' | 'words' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    /** @type {Map<string, Place>} by request, the last ones of this socket */
    this.places = new Map();
    /** @type {Map<string, number>} bodies, and when they were refused [ms] */
    this.bodies = new Map();
    this.dismiss = () => {};
    const {connection} = parts;
    connection.on('sent', (message) => this.#note(message));
    connection.on('unsent', (message) => this.#show(t('Not done: the server is not reachable'), placeOf(message)));
    connection.on('answer', ({request, ok, code, text, subject, values}) => {
      const place = this.places.get(request) ?? {point: null, names: []};
      if (ok || code === 'not_recognised' || code === 'exists' || request === '') return;
      const name = values.body ?? subject;
      this.#show(parts.words.tell({text, code, ok}), name ? {...place, names: [name]} : place);
    });
    connection.on('closed', () => this.places.clear());
    parts.view.overlays.push((view) => this.#draw(view));
  }

  /** @param {any} message */
  #note(message) {
    if (PASSING.includes(message.type)) return;
    this.places.set(message.id, placeOf(message));
    if (this.places.size > KEPT) this.places.delete([...this.places.keys()][0]);
  }

  /**
   * @param {string} reason
   * @param {Place} place
   */
  #show(reason, {point, names}) {
    const {parts} = this, {world} = parts;
    const known = names.filter((name) => world.row(name) >= 0);
    // What a note at the place says is said in the line for screen readers alone.
    parts.notes.showMessage(reason, {ok: false, unseen: known.length > 0 || point !== null});
    this.dismiss();
    for (const name of known) this.bodies.set(name, performance.now());
    if (known.length || point) this.dismiss = parts.notes.pin(() => known.length ? world.topOf(known[0]) : point, [reason], READ, 'refusal');
  }

  /** @param {SceneView} view */
  #draw(view) {
    const now = performance.now();
    for (const [name, since] of this.bodies) {
      if (now - since > OUTLINED) this.bodies.delete(name);
      else view.outline(name, view.palette.warn);
      // Until it has none.
      view.redraw();
    }
  }
}

/**
 * @param {any} message of the page
 * @returns {Place}
 */
function placeOf({point = null, points = [], name, names}) {
  const highest = points.reduce((/** @type {Point} */ top, /** @type {number[]} */ [x, y]) =>
    y > top[1] ? [x, y] : top, [0, -Infinity]);
  return {point: points.length ? highest : point, names: names ?? (name ? [name] : [])};
}
