// SPDX-License-Identifier: Apache-2.0
/** The geometry of bodies in their own frames: paths to draw, points to hit, extents. */

/** @import {Bounds, Point, Shape} from '../types.js' */

const INNER = 0.98; // share of a radius: a point that counts as one within

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
 * @param {(point: Point) => Point} place from its frame to the world
 * @returns {Bounds} in the world
 */
export function boundsOf(shape, place) {
  if (shape.kind === 'pieces') return unionOf(shape.pieces.map((piece) => boundsOf(piece, place)));
  const {points, radius} = skeletonOf(shape);
  return unionOf(points.map(place).map(([x, y]) => [x - radius, y - radius, x + radius, y + radius]));
}

/**
 * @param {Shape} shape
 * @param {Point} point in the body's frame [m]
 * @returns {number} how far the farthest point of the shape is from it [m]
 */
export function reachOf(shape, [x, y]) {
  if (shape.kind === 'pieces') return Math.max(...shape.pieces.map((piece) => reachOf(piece, [x, y])));
  const {points, radius} = skeletonOf(shape);
  return Math.max(...points.map(([px, py]) => Math.hypot(px - x, py - y))) + radius;
}

/**
 * @param {Shape} shape of one piece
 * @returns {{points: Point[], radius: number}} points within the shape, and how far it reaches beyond them [m]
 */
function skeletonOf({kind, center = [0, 0], radius, outline, points, thickness}) {
  if (kind === 'disc') return {points: [center], radius};
  return kind === 'chain' ? {points, radius: thickness / 2} : {points: outline, radius: 0};
}

/**
 * @param {Shape} shape of one piece
 * @param {number} scale
 * @returns {Record<string, any>} the shape of another size, as in a world file
 */
export function scaledShape({kind, radius, width, height, outline, points, thickness}, scale) {
  const scaled = (/** @type {Point[]} */ each) => each.map(([x, y]) => [scale * x, scale * y]);
  if (kind === 'disc') return {circle: {radius: scale * radius}};
  if (kind === 'chain') return {chain: {points: scaled(points), thickness: scale * thickness}};
  return width && height ? {box: {width: scale * width, height: scale * height}} : {polygon: scaled(outline)};
}

/** @param {Point[]} outline that does not cross itself (shoelace formula) */
export function isClockwise(outline) {
  return outline.reduce((sum, [x, y], i) => {
    const [nextX, nextY] = outline[(i + 1) % outline.length];
    return sum + x * nextY - nextX * y;
  }, 0) < 0;
}

/**
 * @param {Bounds[]} boxes
 * @returns {Bounds} the least box around them; infinite where there are none
 */
export function unionOf(boxes) {
  let [left, low, right, high] = [Infinity, Infinity, -Infinity, -Infinity];
  for (const box of boxes) {
    [left, low, right, high] = [Math.min(left, box[0]), Math.min(low, box[1]), Math.max(right, box[2]), Math.max(high, box[3])];
  }
  return [left, low, right, high];
}

/**
 * @param {Shape} shape
 * @param {Point} point in the body's frame [m]
 * @param {number} slop how far beside it counts [m]
 * @returns {boolean}
 */
export function containsPoint(shape, [x, y], slop) {
  if (shape.kind === 'pieces') return shape.pieces.some((piece) => containsPoint(piece, [x, y], slop));
  if (shape.kind === 'disc') {
    const [cx, cy] = shape.center ?? [0, 0];
    return Math.hypot(x - cx, y - cy) <= shape.radius + slop;
  }
  if (shape.kind === 'chain') return distanceTo(shape.points, x, y) <= shape.thickness / 2 + slop;
  return inside(shape.outline, x, y) ||
    (slop > 0 && distanceTo(closed(shape.outline), x, y) <= slop);
}

/**
 * @param {Shape} shape
 * @param {Point} point in the body's frame, outside of it [m]
 * @returns {Point} in it, by little, as near as possible
 */
export function nearestWithin(shape, [x, y]) {
  if (shape.kind === 'pieces') {
    const points = shape.pieces.map((piece) => nearestWithin(piece, [x, y]));
    return points.reduce((best, each) => Math.hypot(each[0] - x, each[1] - y) < Math.hypot(best[0] - x, best[1] - y) ? each : best);
  }
  if (shape.kind === 'disc') {
    const [cx, cy] = shape.center ?? [0, 0], share = INNER * shape.radius / Math.hypot(x - cx, y - cy);
    return [cx + (x - cx) * share, cy + (y - cy) * share];
  }
  if (shape.kind === 'chain') return nearestOn(shape.points, x, y);
  const [px, py] = nearestOn(closed(shape.outline), x, y);
  // Straight on from the point outside; at a sharp corner, towards a corner of the outline instead.
  const towards = [[2 * px - x, 2 * py - y], ...shape.outline];
  const inner = towards.map(([tx, ty]) => /** @type {Point} */ ([px + (1 - INNER) * (tx - px), py + (1 - INNER) * (ty - py)]));
  return inner.find((point) => inside(shape.outline, ...point)) ?? [px, py];
}

/** @param {Point[]} outline */
export function closed(outline) {
  return [...outline, outline[0]];
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
export function distanceTo(points, x, y) {
  const [px, py] = nearestOn(points, x, y);
  return Math.hypot(x - px, y - py);
}

/**
 * @param {Point[]} points of a polyline
 * @param {number} x
 * @param {number} y
 * @returns {Point} the nearest point of the polyline
 */
function nearestOn(points, x, y) {
  let least = Infinity, nearest = points[0];
  for (let i = 1; i < points.length; i++) {
    const [ax, ay] = points[i - 1], dx = points[i][0] - ax, dy = points[i][1] - ay;
    const share = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1);
    const at = Math.min(Math.max(share, 0), 1);
    const distance = Math.hypot(x - ax - at * dx, y - ay - at * dy);
    if (distance < least) [least, nearest] = [distance, [ax + at * dx, ay + at * dy]];
  }
  return nearest;
}
