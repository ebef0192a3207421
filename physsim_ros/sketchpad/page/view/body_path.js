// SPDX-License-Identifier: Apache-2.0
/** The geometry of bodies in their own frames: paths to draw, points to hit, extents. */

import {distance} from '../vectors.js';

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
  } else if (shape.kind === 'pieces') {
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
export function reachOf(shape, point) {
  if (shape.kind === 'pieces') return Math.max(...shape.pieces.map((piece) => reachOf(piece, point)));
  const {points, radius} = skeletonOf(shape);
  return Math.max(...points.map((each) => distance(each, point))) + radius;
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
export function containsPoint(shape, point, slop) {
  if (shape.kind === 'pieces') return shape.pieces.some((piece) => containsPoint(piece, point, slop));
  if (shape.kind === 'disc') return distance(shape.center ?? [0, 0], point) <= shape.radius + slop;
  if (shape.kind === 'chain') return distanceTo(shape.points, point) <= shape.thickness / 2 + slop;
  return inside(shape.outline, point) || slop > 0 && distanceTo(closed(shape.outline), point) <= slop;
}

/**
 * @param {Shape} shape
 * @param {Point} point in the body's frame, outside of it [m]
 * @returns {Point} in it, by little, as near as possible
 */
export function nearestWithin(shape, point) {
  const [x, y] = point;
  if (shape.kind === 'pieces') return nearestOf(shape.pieces.map((piece) => nearestWithin(piece, point)), point);
  if (shape.kind === 'disc') {
    const [cx, cy] = shape.center ?? [0, 0], share = INNER * shape.radius / distance([cx, cy], point);
    return [cx + (x - cx) * share, cy + (y - cy) * share];
  }
  if (shape.kind === 'chain') return nearestOn(shape.points, point);
  const [px, py] = nearestOn(closed(shape.outline), point);
  // Straight on from the point outside; at a sharp corner, towards a corner of the outline instead.
  const towards = [[2 * px - x, 2 * py - y], ...shape.outline];
  const inner = towards.map(([tx, ty]) => /** @type {Point} */ ([px + (1 - INNER) * (tx - px), py + (1 - INNER) * (ty - py)]));
  return inner.find((each) => inside(shape.outline, each)) ?? [px, py];
}

/** @param {Point[]} outline */
export function closed(outline) {
  return [...outline, outline[0]];
}

/** @type {(outline: Point[], point: Point) => boolean} by the even-odd rule */
export function inside(outline, [x, y]) {
  let odd = false;
  for (let i = 0, j = outline.length - 1; i < outline.length; j = i++) {
    const [ax, ay] = outline[i], [bx, by] = outline[j];
    if ((ay > y) !== (by > y) && x < ax + (bx - ax) * (y - ay) / (by - ay)) odd = !odd;
  }
  return odd;
}

/** @type {(polyline: Point[], point: Point) => number} */
export function distanceTo(polyline, point) {
  return distance(nearestOn(polyline, point), point);
}

/** @type {(polyline: Point[], point: Point) => Point} */
function nearestOn(polyline, [x, y]) {
  const places = polyline.slice(1).map(([bx, by], i) => {
    const [ax, ay] = polyline[i], dx = bx - ax, dy = by - ay;
    const share = Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1), 0), 1);
    return /** @type {Point} */ ([ax + share * dx, ay + share * dy]);
  });
  return nearestOf(places, [x, y]);
}

/** @type {(points: Point[], point: Point) => Point} the first of those that are nearest */
function nearestOf(points, point) {
  return points.reduce((best, each) => distance(each, point) < distance(best, point) ? each : best);
}
