// SPDX-License-Identifier: Apache-2.0
/** A gesture of one pointer from press to lift, which tools are made of: they say what it becomes, and draw it meanwhile. */

import {isTap} from '../vectors.js';

/** @import {ToolParts, Touch} from '../types.js' */

/** @template [Needed=ToolParts] */
export class Gesture {
  /** @param {Needed} parts */
  constructor(parts) {
    this.parts = parts;
    /** @type {Touch[]} where the pointer has been, as input/gestures.js keeps it; empty while it is lifted */
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
}
