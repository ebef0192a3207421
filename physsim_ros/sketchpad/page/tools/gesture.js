// SPDX-License-Identifier: Apache-2.0
/** A gesture of one pointer from press to lift, which most tools are made of: they say what it becomes, and draw it meanwhile. */

import {distance, isTap} from '../vectors.js';

/** @import {App, Touch} from '../types.js' */

export class Gesture {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {Touch[]} where the pointer has been; empty while it is lifted */
    this.path = [];
  }

  /** @returns {Touch | undefined} where it was pressed */
  get start() {
    return this.path[0];
  }

  /** @returns {Touch | undefined} where it is now */
  get last() {
    return this.path.at(-1);
  }

  /** @returns {boolean} whether it has stayed where it was pressed */
  get isTap() {
    return this.path.every((touch) => isTap(this.path[0], touch));
  }

  /** @param {Touch} touch */
  down(touch) {
    this.path = [touch];
  }

  /** @param {Touch} touch */
  move(touch) {
    if (this.path.length) this.path.push(touch);
  }

  /** @param {Touch} touch */
  up(touch) {
    // A browser that is late lifts the pointer beyond the place of the last move.
    if (this.last && distance(this.last.page, touch.page)) this.move(touch);
    if (this.start) this.end(touch);
    this.path = [];
  }

  cancel() {
    this.path = [];
  }

  /**
   * Do what the gesture means.
   * @param {Touch} _touch its end
   */
  end(_touch) {}
}
