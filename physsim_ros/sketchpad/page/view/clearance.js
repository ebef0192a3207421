// SPDX-License-Identifier: Apache-2.0
/** What a text on the canvas leaves free: other texts, and joints, which are lines or points. */

import {ALONG_LINE, AT_POINT} from '../joint_kinds.js';
import {ropeStops} from '../rope_path.js';

/** @import {Point, SceneView} from '../types.js' */

/** @typedef {[number, number, number, number]} Box left, top, right, bottom [px] */

export const CLEAR = 4; // px beside a line

/** @type {(a: Box, b: Box) => boolean} */
export function overlap(a, b) {
  return a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
}

/** @type {(box: Box, begin: Point, end: Point) => boolean} whether a line crosses a box (Liang and Barsky) */
export function crosses([left, top, right, bottom], [px, py], [qx, qy]) {
  let [first, last] = [0, 1];
  for (const [from, along, low, high] of [[px, qx - px, left - CLEAR, right + CLEAR], [py, qy - py, top, bottom]]) {
    if (!along && (from < low || from > high)) return false;
    const [enters, leaves] = along ? [(low - from) / along, (high - from) / along].sort((one, other) => one - other) : [0, 1];
    [first, last] = [Math.max(first, enters), Math.min(last, leaves)];
  }
  return first < last;
}

/**
 * @param {SceneView} view
 * @returns {{rows: number[], ends: [Point, Point]}[]} springs, rods and spans of ropes, and hinges, which are points, with the
 *   rows of their bodies [px]
 */
export function jointLines({camera, world}) {
  const at = (/** @type {Point} */ point) => camera.toPage(...point);
  return world.scene.joints.filter(({kind, a, b}) => (ALONG_LINE.includes(kind) || AT_POINT.includes(kind)) && a < world.count && b < world.count).flatMap((joint) => {
    const {a, b, kind} = joint, stops = ropeStops(world, joint), ends = AT_POINT.includes(kind) ? [stops[0], stops[0]] : stops;
    return ends.slice(1).map((stop, i) => ({rows: [a, b], ends: /** @type {[Point, Point]} */ ([at(ends[i].at), at(stop.at)])}));
  });
}
