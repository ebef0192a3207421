// SPDX-License-Identifier: Apache-2.0
/** The line above the world, in which the page answers; notes at places of the world, and in the dock beside it. */

import {createElement, elementOf, textButton} from '../dom.js';
import {t} from '../strings.js';

/** @import {Parts, Point} from '../types.js' */

export const READ = 6000; // ms for which a note is shown
const SHOWN = 2500, REFUSED = 5000, OFFERED = 10000; // ms: an answer, a refusal, a button

export class Notes {
  /** @param {Parts<'camera' | 'view'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.status = elementOf('status');
    this.places = elementOf('places');
    this.dismissOffer = () => {};
    /** @type {Map<HTMLElement, () => ?Point>} */
    this.pinned = new Map();
    this.timer = 0;
    this.until = 0; // [ms] until then a message that is not quiet stays
    parts.view.overlays.push(() => this.#place());
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
