// SPDX-License-Identifier: Apache-2.0
/** Curves of plots, as lists of points: their sum and difference, how far a predicted one is off, the axes that they need. */

import {spanOf} from './chart.js';

/** @import {Curve} from './chart.js' */

const LONG = 3, PREDICTED = 10; // s and units that a prediction has room for

/**
 * @param {number[][]} points over time
 * @param {number[][]} others
 * @returns {number[][]} points of their difference, at the times that both have
 */
export function differenceOf(points, others) {
  const before = new Map(others.map(([time, value]) => [time.toFixed(4), value]));
  return points.flatMap(([time, value]) => {
    const other = before.get(time.toFixed(4));
    return other === undefined ? [] : [[time, value - other]];
  });
}

/**
 * @param {(value: number) => number} scale
 * @param {number} pixel
 * @returns {number} value that is there
 */
export function valueAt(scale, pixel) {
  return (pixel - scale(0)) / (scale(1) - scale(0));
}

/**
 * @param {string} key of the quantity upwards
 * @param {number[][]} points that are known
 * @param {number[]} extent of the world
 * @returns {number[][]} corners of the part of the plot in which a curve can be drawn
 */
export function roomFor(key, points, [left, low, right, high]) {
  const [least, most] = key === 'x' ? [left, right] : key === 'y' ? [low, high] : [Math.min(0, ...points.map(([, y]) => y)), Math.max(PREDICTED, ...points.map(([, y]) => y))];
  return [[0, least], [Math.max(LONG, ...points.map(([x]) => x)), most]];
}

/**
 * @param {number[][]} predicted from left to right
 * @param {number[][]} real
 * @returns {number} mean distance of the curves upwards, where both are; NaN where that is nowhere
 */
export function meanDistance(predicted, real) {
  const distances = real.flatMap(([x, y]) => {
    const after = predicted.findIndex((point) => point[0] >= x);
    if (after < 1) return [];
    const [[px, py], [qx, qy]] = predicted.slice(after - 1);
    return [Math.abs(y - py - (qy - py) * (x - px) / (qx - px))];
  });
  return distances.reduce((sum, each) => sum + each, 0) / distances.length;
}

/**
 * @param {Curve[]} curves over time
 * @returns {number[][]} points of their sum, at the times that all of them have
 */
export function sumOf(curves) {
  /** @type {Map<number, number[]>} */
  const byTime = new Map();
  for (const {points} of curves) for (const [time, value] of points) byTime.set(time, [...byTime.get(time) ?? [], value]);
  return [...byTime].filter(([, values]) => values.length === curves.length).sort(([a], [b]) => a - b)
    .map(([time, values]) => [time, values.reduce((sum, value) => sum + value, 0)]);
}

/**
 * @param {{points: number[][]}[]} curves
 * @returns {number[]} least and greatest x
 */
export function rangeOf(curves) {
  const [least, most] = spanOf(curves, 0);
  if (least > most) return [0, 1];
  return most - least > 1e-6 ? [least, most] : [least - 0.5, most + 0.5];
}
