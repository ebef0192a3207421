// SPDX-License-Identifier: Apache-2.0
/** The geometry of bodies in their own frames: paths to draw, points to hit, extents. */

/** @typedef {import('./wire.js').Shape} Shape */
/** @typedef {import('./wire.js').Point} Point */

/**
 * @param {Shape} shape
 * @returns {Path2D} closed but for chains
 */
export function pathOf(shape) {
  const path = new Path2D();
  if (shape.kind === 'disc') {
    const [x, y] = shape.center ?? [0, 0];
    path.arc(x, y, shape.radius, 0, 2 * Math.PI);
  }
  else if (shape.kind === 'pieces') {
    for (const piece of shape.pieces) path.addPath(pathOf(piece));
  } else {
    const chain = shape.kind === 'chain';
    for (const [x, y] of chain ? shape.points : shape.outline) path.lineTo(x, y);
    if (!chain) path.closePath();
  }
  return path;
}

/**
 * @param {Shape} shape
 * @returns {Point[]} points that span it [m]
 */
export function spanOf(shape) {
  if (shape.kind === 'pieces') return shape.pieces.flatMap(spanOf);
  if (shape.kind !== 'disc') return shape.outline ?? shape.points;
  const [x, y] = shape.center ?? [0, 0], r = shape.radius;
  return [[x - r, y - r], [x + r, y + r]];
}

/**
 * @param {Shape} shape
 * @param {Point} point in the body's frame [m]
 * @param {number} slop how far beside it counts [m]
 * @returns {boolean}
 */
export function hits(shape, [x, y], slop) {
  if (shape.kind === 'pieces') return shape.pieces.some((piece) => hits(piece, [x, y], slop));
  if (shape.kind === 'disc') {
    const [cx, cy] = shape.center ?? [0, 0];
    return Math.hypot(x - cx, y - cy) <= shape.radius + slop;
  }
  if (shape.kind === 'chain') return distanceTo(shape.points, x, y) <= shape.thickness / 2 + slop;
  return inside(shape.outline, x, y) ||
    (slop > 0 && distanceTo([...shape.outline, shape.outline[0]], x, y) <= slop);
}

/**
 * Even-odd rule.
 * @param {Point[]} outline
 * @param {number} x
 * @param {number} y
 */
export function inside(outline, x, y) {
  let odd = false;
  for (let i = 0, j = outline.length - 1; i < outline.length; j = i++) {
    const [ax, ay] = outline[i], [bx, by] = outline[j];
    if ((ay > y) !== (by > y) && x < ax + (bx - ax) * (y - ay) / (by - ay)) odd = !odd;
  }
  return odd;
}

/**
 * @param {Point[]} points of a polyline
 * @param {number} x
 * @param {number} y
 */
function distanceTo(points, x, y) {
  let least = Infinity;
  for (let i = 1; i < points.length; i++) {
    const [ax, ay] = points[i - 1], dx = points[i][0] - ax, dy = points[i][1] - ay;
    const share = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1);
    const at = Math.min(Math.max(share, 0), 1);
    least = Math.min(least, Math.hypot(x - ax - at * dx, y - ay - at * dy));
  }
  return least;
}
