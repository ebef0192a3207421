// SPDX-License-Identifier: Apache-2.0
/** Numbers as people read them: three digits, round steps of scales, and points on the grid. */

/** @import {Point} from './types.js' */

/** @param {number} value */
export function threeDigits(value) {
  return value < 1e4 ? String(Number(value.toPrecision(3))) : value.toExponential(2);
}

/**
 * @param {number} value
 * @returns {number} the least number of 1, 2 or 5 times a power of ten that is not below the value
 */
export function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value)), share = value / power * (1 - 1e-9);
  return Number(((share > 5 ? 10 : share > 2 ? 5 : share > 1 ? 2 : 1) * power).toPrecision(1));
}

/**
 * @param {number} step
 * @param {number} from
 * @param {number} to
 */
export function multiplesOf(step, from, to) {
  const first = Math.ceil(from / step);
  return Array.from({length: Math.floor(to / step) - first + 1}, (_, i) => (first + i) * step);
}

/**
 * @param {Point} point
 * @param {number} grid distance of lines; 0 is no grid
 * @returns {Point} where they cross next to it
 */
export function onGrid([x, y], grid) {
  return grid ? [Math.round(x / grid) * grid, Math.round(y / grid) * grid] : [x, y];
}
