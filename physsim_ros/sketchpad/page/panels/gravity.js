// SPDX-License-Identifier: Apache-2.0
/** The fields of gravity: its strength, and its direction, which a world keeps while there is none. */

import {createElement, presetButtons, range} from '../dom.js';
import {t} from '../strings.js';
import {DEGREE} from '../vectors.js';

/** @import {Parts} from '../types.js' */

/** Gravity at the surface [m/s²]. */
const PLACES = {[t('Earth')]: 9.81, [t('Moon')]: 1.62, [t('Mars')]: 3.71, [t('None')]: 0};
const STEP = 15; // degrees of the slider

export class Gravity {
  /** @param {Parts<'connection' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.strength = 0; // as it was set last [m/s²]: the panel is not renewed while somebody works in it
    this.turn = 0; // from down, counter-clockwise [°]
    parts.connection.on('world', () => { this.turn = 0; });
  }

  /** @returns {HTMLElement[]} */
  fields() {
    const {gravity: [x, y]} = this.parts.world.scene;
    this.strength = Math.hypot(x, y);
    if (this.strength) this.turn = Math.round(Math.atan2(x, -y) / DEGREE * 1e4) / 1e4;
    const setStrength = (/** @type {number} */ strength) => this.#set(strength, this.turn);
    return [createElement('h3', {}, t('Gravity')),
      range(t('Gravity [m/s²]'), 0, 25, 0.01, this.strength, setStrength),
      presetButtons(PLACES, setStrength),
      range(t('Direction of gravity [° from down]'), -180, 180, STEP, this.turn, (turn) => this.#set(this.strength, turn))];
  }

  /**
   * @param {number} strength [m/s²]
   * @param {number} turn [°]
   */
  #set(strength, turn) {
    Object.assign(this, {strength, turn});
    // The sine of a half turn is not exactly 0: nine digits are.
    const gravity = [Math.sin(turn * DEGREE) * strength, -Math.cos(turn * DEGREE) * strength].map((each) => Number(each.toFixed(9)));
    this.parts.connection.send('gravity', {gravity});
  }
}
