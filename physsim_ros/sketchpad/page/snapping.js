// SPDX-License-Identifier: Apache-2.0
/** The grid that points snap to while Shift is held: the fine lines of the page. */

/** @import {Point} from './types.js' */

/**
 * @param {Point} point
 * @param {number} grid distance of lines; 0 is no grid
 * @returns {Point} where they cross next to it
 */
export function onGrid([x, y], grid) {
  return grid ? [Math.round(x / grid) * grid, Math.round(y / grid) * grid] : [x, y];
}
