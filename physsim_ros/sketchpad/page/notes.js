// SPDX-License-Identifier: Apache-2.0
/** What is said: the last answer in a quiet line, and notes at a place of the world. */

import {find, make} from './dom.js';

const SHOWN = 4000, READ = 6000; // ms: an answer, a note
const QUIET = ['show', 'watch', 'move', 'let_go', 'drop']; // messages that are no deed of the reader

export class Notes {
  /** @param {import('./app.js').App} app */
  constructor(app) {
    this.app = app;
    this.status = find('status', HTMLElement);
    this.places = find('places', HTMLElement);
    /** @type {Map<HTMLElement, import('./wire.js').Point>} */
    this.pinned = new Map();
    this.timer = 0;
    this.dismiss = () => {}; // the last refusal
    this.until = 0; // [ms] until then an answer to this page stays
    app.view.overlays.push(() => this.#place());
    app.connection.on('answer', (answer) => this.#tell(answer));
    app.connection.on('unsent', (type) => QUIET.includes(type) || this.#refuse('Not done: the server is gone'));
  }

  /** @param {import('./wire.js').Answer} answer */
  #tell({request, ok, code, message, at}) {
    const own = request !== '';
    if (!own && performance.now() < this.until) return;
    if (own && !ok && code !== 'not_recognised') this.#refuse(message, at);
    else this.say(message, {ok, quiet: !own});
  }

  /**
   * @param {string} reason
   * @param {import('./wire.js').Point} at [m]
   */
  #refuse(reason, at = this.app.lastAt) {
    this.say(reason, {ok: false});
    this.dismiss();
    this.dismiss = this.pin(at, [reason], {kind: 'refusal'});
  }

  /**
   * @param {string} message
   * @param {{ok?: boolean, quiet?: boolean}} how
   */
  say(message, {ok = true, quiet = false} = {}) {
    this.status.textContent = message;
    this.status.className = `shown${ok ? '' : ' refused'}${quiet ? ' quiet' : ''}`;
    if (!quiet) this.until = performance.now() + SHOWN;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.status.classList.remove('shown'), SHOWN);
  }

  /**
   * @param {import('./wire.js').Point} at [m]
   * @param {(Node | string)[]} content
   * @param {{kind?: string, shown?: number}} how  shown: for how long [ms]; 0 is until it is taken away
   * @returns {() => void} takes it away
   */
  pin(at, content, {kind = '', shown = READ} = {}) {
    const note = make('div', {className: `note ${kind}`}, ...content);
    const remove = () => {
      note.remove();
      this.pinned.delete(note);
    };
    this.places.append(note);
    this.pinned.set(note, at);
    this.#place();
    if (shown) setTimeout(remove, shown);
    return remove;
  }

  #place() {
    const {camera} = this.app;
    for (const [note, at] of this.pinned) {
      const [x, y] = camera.toPage(...at), half = note.offsetWidth / 2 + 8;
      const left = Math.min(Math.max(x, half), Math.max(camera.width - half, half));
      const top = Math.min(Math.max(y, note.offsetHeight + 70), camera.height - 120);
      note.style.transform = `translate(${left}px, ${top}px) translate(-50%, calc(-100% - 14px))`;
    }
  }
}
