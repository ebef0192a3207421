// SPDX-License-Identifier: Apache-2.0
/**
 * A tool, which says what becomes of a gesture: one pointer from press to lift, or several clicks. Handles and the ends of a
 * stylus are tools, too. input/pointers.js calls these methods; a tool overrides those that it needs.
 */

import {isTap} from '../vectors.js';

/** @import {SceneView, Touch} from '../types.js' */

/** @template [Needed=any] the parts of the page that it works with */
export class Tool {
  clicks = 0; // of its gesture; 0 where that is drawn
  atServer = false; // whether the server knows of its unfinished gesture
  /** Colour of the body that it is pointed at. @type {'accent' | 'warn' | undefined} */
  aims;
  /** Where the pointer has been, as input/pointers.js keeps it; empty while it is lifted. @type {Touch[]} */
  path = [];

  /** @param {Needed} parts */
  constructor(parts) {
    this.parts = parts;
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

  /** @type {(touch: Touch) => Touch} the place on the grid, or the one that is meant */
  snap(touch) {
    return touch;
  }

  /** @param {Touch} _touch */
  begin(_touch) {}

  /** @param {Touch} _touch */
  move(_touch) {}

  /** @param {Touch} _touch */
  end(_touch) {}

  /** Forget the gesture, and the clicks before it. */
  cancel() {}

  /** @param {Touch} _touch of a pointer that is not pressed */
  point(_touch) {}

  /** @param {SceneView} _view */
  draw(_view) {}

  /** @returns {boolean} whether a gesture is begun, of which clicks are to come */
  get open() {
    return false;
  }

  /** @returns {boolean} whether there was an open gesture, which is finished */
  finish() {
    return false;
  }

  /** @returns {boolean} whether wheel, R and a second finger turn the body in the tool */
  get turns() {
    return false;
  }

  /** @param {number} _angle [rad] */
  turn(_angle) {}
}
