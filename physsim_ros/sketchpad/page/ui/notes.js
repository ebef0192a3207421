// SPDX-License-Identifier: Apache-2.0
/** Answers in a line above the world; notes at places of the world; refusals beside the body that they name, or where they were asked for. */

import {PASSING} from '../connection.js';
import {createElement, elementOf, textButton} from '../dom.js';
import {t} from '../strings.js';
import {personWord} from '../people.js';

/** @import {Answer, Parts, Point, SceneView} from '../types.js' */

const SCENE_LATER = 250; // ms: greatest time from the answer to a request to the scene with its body
/** Answers that are not shown: the clock, the hand and the tool show the same. */
export const SILENT = /^at [\d.]+ s$|^(following|grabbed|dropped) |^let go of | holds no body$|^the (world as text|list of worlds|answer is noted|message is shown)$/;
const REST = /^and \d+ more answers$/; // of a frame, to a page that did not ask
const SHOWN = 2500, REFUSED = 5000, READ = 6000, OFFERED = 10000; // ms: an answer, a refusal, a note, a button

export class Notes {
  /** @param {Parts<'camera' | 'connection' | 'people' | 'view' | 'words'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.status = elementOf('status');
    this.places = elementOf('places');
    this.dismissOffer = () => {};
    /** @type {Map<HTMLElement, () => ?Point>} */
    this.pinned = new Map();
    this.timer = 0;
    this.until = 0; // [ms] until then an answer to this page stays
    this.rest = {of: '', left: 0}; // answers to come that are parts of what was told as one thing
    this.expected = () => {}; // shows an answer with the next scene
    parts.view.overlays.push(() => this.#place());
    parts.connection.on('answer', (answer) => this.#tell(answer));
    parts.connection.on('scene', () => this.expected());
  }

  /** @param {Answer} answer */
  #tell(answer) {
    const {request, ok, code, message, topic} = answer, own = request !== '';
    // The button that opens the recording tells the same.
    if (ok && topic === 'viewer') return;
    // A dialog asks about a name that is taken where a world is saved.
    if (SILENT.test(message) || own && code === 'exists' && topic === '~/save_world' || !own && performance.now() < this.until) return;
    const of = `${answer.page ?? ''} ${request}`, several = Number(answer.values?.requests ?? 0), rest = REST.test(message);
    if (several > 1) this.rest = {of, left: several};
    else if (this.rest.left && (rest || this.rest.of === of)) {
      this.rest.left = rest ? 0 : this.rest.left - 1;
      if (ok) return;
    }
    const who = own ? '' : personWord(this.parts.people.nameOf(answer.page));
    const tell = () => {
      this.expected = () => {};
      this.showMessage(`${who}${who && ': '}${this.parts.words.tell(answer)}`, {ok, quiet: !own});
    };
    if (this.parts.words.knows(answer.subject)) tell();
    else {
      this.expected = tell;
      setTimeout(() => this.expected === tell && tell(), SCENE_LATER);
    }
  }

  /**
   * @param {string} message
   * @param {{ok?: boolean, quiet?: boolean, unseen?: boolean}} how
   */
  showMessage(message, {ok = true, quiet = false, unseen = false} = {}) {
    this.status.textContent = message;
    this.status.className = `shown${ok ? '' : ' refused'}${quiet ? ' quiet' : ''}${unseen ? ' unseen' : ''}`;
    const shown = ok ? SHOWN : REFUSED;
    if (!quiet) this.until = performance.now() + shown;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.hide(), shown);
  }

  /**
   * Say what was done, and offer a button for a while.
   * @param {string} message
   * @param {string} label
   * @param {() => void} done
   */
  offer(message, label, done) {
    this.hide();
    this.dismissOffer();
    this.dismissOffer = this.dock([message, textButton(label, () => {
      this.dismissOffer();
      done();
    })], OFFERED);
  }

  /**
   * Work with a script that is loaded when somebody asks for it.
   * @template T
   * @param {Promise<T>} loading
   * @param {(script: T) => void} work
   */
  async load(loading, work) {
    const script = await loading.catch(() => null);
    if (script) work(script);
    else this.showMessage(t('Not done: the server is not reachable'), {ok: false});
  }

  /** Hide the last answer. */
  hide() {
    this.status.classList.remove('shown');
  }

  /**
   * @param {(Node | string)[]} content of a note that has no place in the world
   * @param {number} shown for how long [ms]; 0 is until it is taken away
   * @returns {() => void} takes it away
   */
  dock(content, shown = READ) {
    return this.#add(elementOf('dock'), createElement('div', {className: 'note'}, ...content), shown);
  }

  /**
   * @param {() => ?Point} at place of a note [m]; null where that is gone
   * @param {(Node | string)[]} content
   * @param {number} shown for how long [ms]; 0 is until it is taken away
   * @param {string} kind
   * @returns {() => void} takes it away
   */
  pin(at, content, shown = READ, kind = '') {
    const note = createElement('div', {className: `note ${kind}`}, ...content);
    this.pinned.set(note, at);
    const remove = this.#add(this.places, note, shown);
    this.#place();
    return remove;
  }

  /**
   * @param {HTMLElement} parent
   * @param {HTMLElement} note
   * @param {number} shown [ms]
   */
  #add(parent, note, shown) {
    const remove = () => {
      note.remove();
      this.pinned.delete(note);
    };
    // Who is at its button keeps it.
    const end = () => note.matches(':hover, :focus-within') ? setTimeout(end, shown) : remove();
    parent.append(note);
    if (shown) setTimeout(end, shown);
    return remove;
  }

  #place() {
    const {camera} = this.parts;
    for (const [note, at] of this.pinned) {
      const place = at();
      if (!place) continue;
      const [x, y] = camera.toPage(...place), half = note.offsetWidth / 2 + 8;
      const left = Math.min(Math.max(x, half), Math.max(camera.width - half, half));
      const top = Math.min(Math.max(y, note.offsetHeight + 70), camera.height - 120);
      note.style.transform = `translate(${left}px, ${top}px) translate(-50%, calc(-100% - 14px))`;
    }
  }
}

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
    connection.on('answer', ({request, ok, code, message, subject, values}) => {
      const place = this.places.get(request) ?? {point: null, names: []};
      if (ok || code === 'not_recognised' || code === 'exists' || request === '') return;
      const name = values.body ?? subject;
      this.#show(parts.words.tell({message, code, ok}), name ? {...place, names: [name]} : place);
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
      const row = this.parts.world.row(name);
      if (now - since > OUTLINED || row < 0) this.bodies.delete(name);
      else view.outline(row, view.palette.warn);
      // Until it has none.
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
