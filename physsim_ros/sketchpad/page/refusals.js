// SPDX-License-Identifier: Apache-2.0
/** Refusals beside the body that the answer names, or where the request was made. */

/** @import {App, Point, SceneView} from './types.js' */

/** @typedef {{point: ?Point, names: string[]}} Place of a request: a point [m], or bodies */

const OUTLINED = 2500; // ms for which a body has an outline
const KEPT = 100; // requests whose places are known: a stroke is answered by its reading, then by its requests
/** Messages whose refusals are not shown: no reader has asked for them. */
const QUIET = ['show', 'watch', 'move', 'let_go', 'drop', 'answered', 'list'];

export class Refusals {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {Map<string, Place>} by request, the last ones of this socket */
    this.places = new Map();
    /** @type {Map<string, number>} bodies, and when they were refused [ms] */
    this.bodies = new Map();
    this.dismiss = () => {};
    const {connection} = app;
    connection.on('sent', (message) => this.#note(message));
    connection.on('unsent', (message) => {
      if (!QUIET.includes(message.type)) this.#show('Not done: the server is not reachable', placeOf(message));
    });
    connection.on('answer', ({request, ok, code, message, subject, values}) => {
      const place = this.places.get(request) ?? {point: null, names: []};
      if (ok || code === 'not_recognised' || code === 'exists' || request === '') return;
      const name = values.body ?? subject;
      this.#show(app.words.tell({message}), name ? {...place, names: [name]} : place);
    });
    connection.on('closed', () => this.places.clear());
    app.view.overlays.push((view) => this.#draw(view));
  }

  /** @param {any} message */
  #note(message) {
    if (QUIET.includes(message.type)) return;
    this.places.set(message.id, placeOf(message));
    if (this.places.size > KEPT) this.places.delete([...this.places.keys()][0]);
  }

  /**
   * @param {string} reason
   * @param {Place} place
   */
  #show(reason, {point, names}) {
    const {app} = this, {world} = app;
    app.notes.showMessage(reason, {ok: false});
    this.dismiss();
    const known = names.filter((name) => world.row(name) >= 0);
    for (const name of known) this.bodies.set(name, performance.now());
    app.view.dirty = true;
    if (known.length) this.dismiss = app.notes.pin(() => world.topOf(known[0]), [reason], {kind: 'refusal'});
    else if (point) this.dismiss = app.notes.pin(() => point, [reason], {kind: 'refusal'});
  }

  /** @param {SceneView} view */
  #draw(view) {
    const now = performance.now();
    for (const [name, since] of this.bodies) {
      const row = this.app.world.row(name);
      if (now - since > OUTLINED || row < 0) this.bodies.delete(name);
      else view.outline(row, view.palette.warn);
      view.dirty = true;
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
