// SPDX-License-Identifier: Apache-2.0
/** Answers in a line above the world, and notes at places of the world. */

import {createElement, elementOf, textButton} from './dom.js';

/** @import {App, Answer, Point} from './types.js' */

const SCENE_LATER = 250; // ms: greatest time from the answer to a request to the scene with its body
/** Answers that are not shown: the clock and the hand show the same. */
const SILENT = /^at [\d.]+ s$|^grabbed |^let go of | holds no body$|^the (world as text|list of worlds|answer is noted|message is shown)$/;
const REST = /^and \d+ more answers$/; // of a frame, to a page that did not ask
const SHOWN = 2500, REFUSED = 5000, READ = 6000, OFFERED = 10000; // ms: an answer, a refusal, a note, a button

export class Notes {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.status = elementOf('status', HTMLElement);
    this.places = elementOf('places', HTMLElement);
    this.dock = elementOf('dock', HTMLElement); // of notes without a place
    this.dismissOffer = () => {};
    /** @type {Map<HTMLElement, () => ?Point>} */
    this.pinned = new Map();
    this.timer = 0;
    this.until = 0; // [ms] until then an answer to this page stays
    this.parts = {of: '', left: 0}; // answers to come that are parts of what was told as one thing
    this.expected = () => {}; // shows an answer with the next scene
    app.view.overlays.push(() => this.#place());
    app.connection.on('answer', (answer) => this.#tell(answer));
    app.connection.on('scene', () => {
      this.expected();
      this.expected = () => {};
    });
  }

  /** @param {Answer} answer */
  #tell(answer) {
    const {request, ok, code, message, topic} = answer, own = request !== '';
    // A dialog asks about a name that is taken where a world is saved.
    if (SILENT.test(message) || own && code === 'exists' && topic === '~/save_world' || !own && performance.now() < this.until) return;
    const of = `${answer.page ?? ''} ${request}`, several = Number(answer.values?.requests ?? 0), rest = REST.test(message);
    if (several > 1) this.parts = {of, left: several};
    else if (this.parts.left && (rest || this.parts.of === of)) {
      this.parts.left = rest ? 0 : this.parts.left - 1;
      if (ok) return;
    }
    const who = own ? '' : this.app.classroom.nameOf(answer.page);
    const tell = () => this.showMessage(`${who}${who && ': '}${this.app.words.tell(answer)}`, {ok, quiet: !own});
    this.expected = () => {};
    if (this.app.words.knows(answer.subject)) tell();
    else {
      this.expected = tell;
      setTimeout(() => this.expected === tell && tell(), SCENE_LATER);
    }
  }

  /**
   * @param {string} message
   * @param {{ok?: boolean, quiet?: boolean}} how
   */
  showMessage(message, {ok = true, quiet = false} = {}) {
    this.status.textContent = message;
    this.status.className = `shown${ok ? '' : ' refused'}${quiet ? ' quiet' : ''}`;
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
    this.dismissOffer = this.pin(() => null, [message, textButton(label, () => {
      this.dismissOffer();
      done();
    })], {kind: 'docked', shown: OFFERED});
  }

  /** Hide the last answer. */
  hide() {
    this.status.classList.remove('shown');
  }

  /**
   * @param {() => ?Point} at [m], or null where that is gone
   * @param {(Node | string)[]} content
   * @param {{kind?: string, shown?: number}} how  shown: for how long [ms]; 0 is until it is taken away
   * @returns {() => void} takes it away
   */
  pin(at, content, {kind = '', shown = READ} = {}) {
    const note = createElement('div', {className: `note ${kind}`}, ...content);
    const remove = () => {
      note.remove();
      this.pinned.delete(note);
    };
    if (kind === 'docked') this.dock.append(note);
    else {
      this.places.append(note);
      this.pinned.set(note, at);
      this.#place();
    }
    if (shown) setTimeout(remove, shown);
    return remove;
  }

  #place() {
    const {camera} = this.app;
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
