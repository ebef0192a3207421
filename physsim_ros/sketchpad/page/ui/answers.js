// SPDX-License-Identifier: Apache-2.0
/**
 * Answers to requests, in the line above the world: of this page, of others, and events. A refusal of what this page has
 * asked for is also shown beside the body that it names, or where it was asked for.
 */

import {PASSING} from '../connection.js';
import {READ} from './notes.js';
import {personWord} from '../people.js';
import {t} from '../strings.js';

/** @import {Answer, Parts, Point, SceneView} from '../types.js' */

/** @typedef {{point: ?Point, names: string[]}} Place of a request: a point [m], or bodies */

const SCENE_LATER = 250; // ms: greatest time from the answer to a request to the scene with its body
const OUTLINED = 2500; // ms for which a body has an outline
/** @type {Place} */
const NOWHERE = {point: null, names: []};
const KEPT = 100; // requests whose places are known: a stroke is answered by its reading, then by its requests

export class Answers {
  /** @param {Parts<'connection' | 'notes' | 'people' | 'view' | 'words' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    /** @type {Map<string, Place>} by request, the last ones of this socket */
    this.places = new Map();
    /** @type {Map<string, number>} bodies, and when they were refused [ms] */
    this.bodies = new Map();
    this.rest = {of: '', left: 0}; // answers to come that are parts of what was said as one thing
    this.expected = () => {}; // shows an answer with the next scene
    this.dismiss = () => {}; // the note of the last refusal
    const {connection} = parts;
    connection.on('sent', (message) => this.#keepPlace(message));
    connection.on('unsent', (message) => this.#refuse(t('Not done: the server is not reachable'), placeOf(message)));
    connection.on('answer', (answer) => this.#show(answer));
    connection.on('scene', () => this.expected());
    connection.on('closed', () => this.places.clear());
    parts.view.overlays.push((view) => this.#draw(view));
  }

  /** @param {Answer} answer */
  #show(answer) {
    const {request, ok, code, text, topic, subject, page, values} = answer, {notes, people, words} = this.parts, own = request !== '';
    const sentence = () => words.sayAnswer(answer);
    // The button that opens the recording says the same.
    if (ok && topic === 'viewer' || !sentence() || !own && performance.now() < notes.until) return;
    // A dialog asks about a name that is taken where a world is saved.
    if (own && code === 'exists' && topic === '~/save_world') return;
    const of = `${page ?? ''} ${request}`, several = Number(values?.requests ?? 0), rest = topic === 'events'; // of a frame, to a page that did not ask
    if (several > 1) this.rest = {of, left: several};
    else if (this.rest.left && (rest || this.rest.of === of)) {
      this.rest.left = rest ? 0 : this.rest.left - 1;
      if (ok) return;
    }
    if (own && !ok) {
      const place = this.places.get(request) ?? NOWHERE, name = values.body ?? subject;
      // What was not recognised has its note, with guesses.
      this.#refuse(sentence(), code === 'not_recognised' ? NOWHERE : name ? {...place, names: [name]} : place);
      return;
    }
    const who = own ? '' : personWord(people.nameOf(page));
    const show = () => {
      this.expected = () => {};
      notes.showMessage(`${who}${who && ': '}${sentence()}`, {ok, quiet: !own});
    };
    if (words.knows(text)) show();
    else {
      this.expected = show;
      setTimeout(() => this.expected === show && show(), SCENE_LATER);
    }
  }

  /** @param {any} message */
  #keepPlace(message) {
    if (PASSING.includes(message.type)) return;
    this.places.set(message.id, placeOf(message));
    if (this.places.size > KEPT) this.places.delete([...this.places.keys()][0]);
  }

  /**
   * @param {string} reason
   * @param {Place} place
   */
  #refuse(reason, {point, names}) {
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
