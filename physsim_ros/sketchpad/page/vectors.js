// SPDX-License-Identifier: Apache-2.0
/** Points and vectors, in metres or pixels, and angles. */

/** @import {Point} from './types.js' */

export const DEGREE = Math.PI / 180; // rad

/** @type {(one: Point, other: Point) => number} */
export function distance([x, y], [toX, toY]) {
  return Math.hypot(toX - x, toY - y);
}

/**
 * @param {number} length
 * @param {number} angle counter-clockwise from the right [rad]
 * @returns {Point}
 */
export function polar(length, angle) {
  return [length * Math.cos(angle), length * Math.sin(angle)];
}

/**
 * @param {Point} vector
 * @param {number} angle counter-clockwise [rad]
 * @returns {Point}
 */
export function rotated([x, y], angle) {
  const cos = Math.cos(angle), sin = Math.sin(angle);
  return [cos * x - sin * y, sin * x + cos * y];
}

/**
 * @param {number} angle [rad]
 * @returns {number} of the same direction, at most half a turn from 0
 */
export function wrapped(angle) {
  return Math.atan2(Math.sin(angle), Math.cos(angle));
}

/**
 * @param {Point} point
 * @param {number} grid distance of lines; 0 is no grid
 * @returns {Point} where they cross next to it
 */
export function onGrid([x, y], grid) {
  return grid ? [Math.round(x / grid) * grid, Math.round(y / grid) * grid] : [x, y];
}

const TAP = 5; // px

/**
 * @param {{page: Point}} start of a pointer
 * @param {{page: Point}} end
 * @returns {boolean} whether it has stayed where it was pressed
 */
export function isTap(start, end) {
  return distance(start.page, end.page) <= TAP;
}
