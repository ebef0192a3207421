// SPDX-License-Identifier: Apache-2.0
/** Answers: the last one in a quiet line, and notes at a place of the world. */

import {createElement, elementOf} from './dom.js';

const SHOWN = 4000, READ = 6000; // ms: an answer, a note

export class Notes {
  /** @param {import('./app.js').App} app */
  constructor(app) {
    this.app = app;
    this.status = elementOf('status', HTMLElement);
    this.places = elementOf('places', HTMLElement);
    /** @type {Map<HTMLElement, () => ?import('./wire.js').Point>} */
    this.pinned = new Map();
    this.timer = 0;
    this.until = 0; // [ms] until then an answer to this page stays
    app.view.overlays.push(() => this.#place());
    app.connection.on('answer', (answer) => this.#tell(answer));
  }

  /** @param {import('./wire.js').Answer} answer */
  #tell({request, ok, message}) {
    const own = request !== '';
    if (!own && performance.now() < this.until) return;
    this.showMessage(message, {ok, quiet: !own});
  }

  /**
   * @param {string} message
   * @param {{ok?: boolean, quiet?: boolean}} how
   */
  showMessage(message, {ok = true, quiet = false} = {}) {
    this.status.textContent = message;
    this.status.className = `shown${ok ? '' : ' refused'}${quiet ? ' quiet' : ''}`;
    if (!quiet) this.until = performance.now() + SHOWN;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.status.classList.remove('shown'), SHOWN);
  }

  /**
   * @param {() => ?import('./wire.js').Point} at [m], or null where that is gone
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
    this.places.append(note);
    this.pinned.set(note, at);
    this.#place();
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
