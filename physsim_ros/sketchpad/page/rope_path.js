// SPDX-License-Identifier: Apache-2.0
/** The path of a rope past rings and around wheels, as `model/rope_path.py` has it. */

/** @import {Joint, Point, WorldState} from './types.js' */

/** @typedef {{at: Point, radius: number}} Stop radius: > 0 where the rope runs counter-clockwise around a wheel [m] */

/**
 * @param {WorldState} world
 * @param {Joint} joint
 * @returns {Stop[]} its ends, and what it passes between them
 */
export function ropeStops(world, {a, b, points: [p, q], guides = []}) {
  return [{at: world.place(a, p), radius: 0},
    ...guides.map(([row, x, y, radius]) => ({at: world.place(row, [x, y]), radius})),
    {at: world.place(b, q), radius: 0}];
}

/**
 * @param {Stop[]} stops
 * @returns {number[]} the directions of its spans [rad]
 */
export function ropeHeadings(stops) {
  return stops.slice(1).map(({at: [x, y], radius}, number) => {
    const {at: [fromX, fromY], radius: other} = stops[number], dx = x - fromX, dy = y - fromY;
    return Math.atan2(dy, dx) + Math.asin(Math.min(Math.max((other - radius) / (Math.hypot(dx, dy) || 1), -1), 1));
  });
}
