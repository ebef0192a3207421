// SPDX-License-Identifier: Apache-2.0
/** Water: dragged from corner to corner, a region in which bodies float. */

import {Tool} from './tool.js';
import {WATER} from '../panels/field_fields.js';
import {threeDigits} from '../rounding.js';
import {isTap, onGrid} from '../vectors.js';

/** @import {Bounds, Parts, SceneView, Touch} from '../types.js' */

const USUAL = [4, 2]; // m: width and depth of a tap, whose middle it is

/** @extends {Tool<Parts<'connection' | 'people'>>} */
export class WaterTool extends Tool {
  /** @param {Touch} touch */
  end(touch) {
    const {connection, people} = this.parts, [left, low, right, high] = this.#region(this.path[0], touch);
    connection.send('spawn', {body: {name: people.freeName('water'), box: {width: right - left, height: high - low}, at: [(left + right) / 2, (low + high) / 2],
      anchored: true, sensor: true, medium: WATER, color: '#4d9de0'}});
  }

  /**
   * @param {Touch} start
   * @param {Touch} end
   * @returns {Bounds} between them [m]
   */
  #region(start, end) {
    const [x, y] = onGrid(start.at, start.grid), [toX, toY] = onGrid(end.at, end.grid), [width, depth] = USUAL;
    if (isTap(start, end)) return [x - width / 2, y - depth / 2, x + width / 2, y + depth / 2];
    return [Math.min(x, toX), Math.min(y, toY), Math.max(x, toX), Math.max(y, toY)];
  }

  /** @param {SceneView} view */
  draw(view) {
    if (!this.start || !this.last || this.isTap) return;
    const [left, low, right, high] = this.#region(this.start, this.last);
    view.line([[left, low], [right, low], [right, high], [left, high], [left, low]], view.palette.accent);
    view.writeBeside(`${threeDigits(right - left)} × ${threeDigits(high - low)} m`, this.last);
  }
}
