// SPDX-License-Identifier: Apache-2.0
/** The scale of the arrows of one unit: how many units are a bar of the legend, which fits what is shown into the view. */

import {roundUp} from '../rounding.js';

export const BAR = 60; // px: of the bar that a scale is told by
const SHORT = 0.12; // share of the room of the longest arrow below which the scale becomes finer
const SETTLED = 400; // ms for which an arrow is too long or too short before the scale follows

export class ArrowScale {
  unit = 0; // a bar's length: 1, 2 or 5 times a power of ten
  since = 0; // [ms] since when it does not fit

  /**
   * @param {number} most that is shown [unit]
   * @param {number} room for it [px]
   * @param {boolean} atOnce whether nothing moves
   */
  fit(most, room, atOnce) {
    const length = this.length(most), now = performance.now();
    if (length <= room && length >= SHORT * room || !(most > 0) && this.unit) {
      this.since = 0;
      return;
    }
    this.since ||= now;
    if (this.unit && !atOnce && now - this.since < SETTLED) return;
    this.since = 0;
    this.unit = roundUp((most || 1) * BAR / room);
  }

  /** @param {number} value */
  length(value) {
    return value * BAR / this.unit;
  }
}
