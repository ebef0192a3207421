// SPDX-License-Identifier: Apache-2.0
/** Answers in a line above the world; notes at places of the world. */

import {createElement, elementOf, textButton} from '../dom.js';
import {t} from '../strings.js';
import {personWord} from '../people.js';

/** @import {Answer, Parts, Point} from '../types.js' */

const SCENE_LATER = 250; // ms: greatest time from the answer to a request to the scene with its body
export const READ = 6000; // ms for which a note is shown
const SHOWN = 2500, REFUSED = 5000, OFFERED = 10000; // ms: an answer, a refusal, a button

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
    const {request, ok, code, text, topic} = answer, {people, words} = this.parts, own = request !== '';
    // The button that opens the recording tells the same.
    if (ok && topic === 'viewer') return;
    // A dialog asks about a name that is taken where a world is saved.
    if (!words.tell(answer) || own && code === 'exists' && topic === '~/save_world' || !own && performance.now() < this.until) return;
    const of = `${answer.page ?? ''} ${request}`, several = Number(answer.values?.requests ?? 0), rest = topic === 'events'; // of a frame, to a page that did not ask
    if (several > 1) this.rest = {of, left: several};
    else if (this.rest.left && (rest || this.rest.of === of)) {
      this.rest.left = rest ? 0 : this.rest.left - 1;
      if (ok) return;
    }
    const who = own ? '' : personWord(people.nameOf(answer.page));
    const tell = () => {
      this.expected = () => {};
      this.showMessage(`${who}${who && ': '}${words.tell(answer)}`, {ok, quiet: !own});
    };
    if (words.knows(text)) tell();
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
