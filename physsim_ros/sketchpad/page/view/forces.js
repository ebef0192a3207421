// SPDX-License-Identifier: Apache-2.0
/**
 * The forces on bodies in newtons: weight, constant forces, normal force and friction of contacts, joints, air
 * and other fields, and their sum.
 *
 * A contact's impulse is divided by the simulated time that it was summed over, so that a force does not
 * depend on how fast the world plays. Hands and commanded wrenches are not among them.
 */

import {ropeHeadings, ropeStops} from '../rope_path.js';
import {polar, rotated} from '../vectors.js';

/** @import {Body, Force, Point, Sample, Scene, WorldState} from '../types.js' */

const LEAST = 1e-3; // N: below that, rounding of what does not act

/**
 * @param {WorldState} world
 * @returns {Force[]} on the bodies that forces move
 */
export function forcesOf(world) {
  const {frame: {contacts, pulls, velocities, fields, yaw}, scene} = world, {bodies, joints} = scene;
  /** @type {Force[]} */
  const forces = [];
  const moves = (/** @type {number} */ row) => row >= 0 && !bodies[row].anchored && !bodies[row].kinematic;
  /**
   * @param {Force['kind']} kind
   * @param {number} row
   * @param {Point} at
   * @param {number} x [N]
   * @param {number} y [N]
   * @param {number} by the row of the body that it comes from
   */
  const add = (kind, row, at, x, y, by = -1) => {
    if (moves(row) && Math.hypot(x, y) > LEAST) forces.push({kind, row, at, x, y, mutual: moves(by)});
  };
  for (let row = 0; row < world.count; row++) {
    const motion = {yaw: yaw[row], vx: velocities?.x[row] ?? 0, vy: velocities?.y[row] ?? 0};
    for (const {kind, at, x, y} of ownForces(scene, bodies[row], motion)) add(kind, row, world.place(row, at), x, y);
    if (fields) add('air', row, world.centerOf(row), fields.x[row], fields.y[row]);
  }
  for (let i = 0; contacts && contacts.steps && i < contacts.x.length; i++) {
    const {a, b, nx, ny} = contacts, rate = world.physicsRate / contacts.steps;
    const x = contacts.jx[i] * rate, y = contacts.jy[i] * rate, along = x * nx[i] + y * ny[i];
    const px = along * nx[i], py = along * ny[i];
    /** @type {Point} */
    const at = [contacts.x[i], contacts.y[i]];
    for (const [row, by, sign] of [[b[i], a[i], 1], [a[i], b[i], -1]]) {
      add('normal', row, at, sign * px, sign * py, by);
      add('friction', row, at, sign * (x - px), sign * (y - py), by);
    }
  }
  joints.forEach((joint, i) => {
    if (!pulls || i >= pulls.x.length) return;
    const {kind, a, b, points: [p, q], guides = []} = joint, x = pulls.x[i], y = pulls.y[i];
    const pull = (/** @type {number} */ one, /** @type {Point} */ from, /** @type {number} */ other, /** @type {Point} */ to, /** @type {Point} */ [dx, dy]) => {
      add('joint', other, to, dx, dy, one);
      add('joint', one, from, -dx, -dy, other);
    };
    if (kind !== 'rope' || !guides.length) {
      pull(a, world.place(a, p), b, world.place(b, q), [x, y]);
      return;
    }
    // Its tension is the same in all spans; one between two places of a body does not move that.
    const stops = ropeStops(world, joint), rows = [a, ...guides.map(([row]) => row), b], tension = Math.hypot(x, y);
    ropeHeadings(stops).forEach((heading, span) => {
      const [one, other] = rows.slice(span);
      if (one !== other) pull(one, stops[span].at, other, stops[span + 1].at, polar(-tension, heading));
    });
  });
  return forces;
}

/**
 * @param {WorldState} world
 * @param {number} row of a body
 * @returns {{at: Point, force: Point}[]} its constant forces now, in world axes [m, N]
 */
export function appliedTo(world, row) {
  return ownForces(world.scene, world.scene.bodies[row], {yaw: world.frame.yaw[row], vx: 0, vy: 0}).filter(({kind}) => kind === 'applied').map(({at, x, y}) => ({at: world.place(row, at), force: [x, y]}));
}

/**
 * @param {Scene} scene
 * @param {Body} body
 * @param {{yaw: number, vx: number, vy: number}} motion [rad, m/s]
 * @returns {{kind: Force['kind'], at: Point, x: number, y: number}[]} what acts on it without a contact or joint, in world axes [N];
 *   at: in its frame [m]
 */
function ownForces({gravity: [gx, gy], damping}, {mass, centroid, forces = []}, {yaw, vx, vy}) {
  const rate = damping > 0 && damping < 1 ? mass * Math.log(1 - damping) : 0;
  return [{kind: 'weight', at: centroid, x: mass * gx, y: mass * gy}, {kind: 'air', at: centroid, x: rate * vx, y: rate * vy},
    ...forces.map(({force, at = centroid, axes}) => {
      const [x, y] = axes === 'body' ? rotated(force, yaw) : force;
      return {kind: /** @type {const} */ ('applied'), at, x, y};
    })];
}

/**
 * @param {WorldState} world
 * @param {Body} body
 * @param {Sample} motion of that body in the past
 * @param {[kind: string, x: number, y: number][]} others sums of the other forces then [N]
 * @returns {{kind: Force['kind'], x: number, y: number}[]} all that acted on it [N], and their sum
 */
export function pastForcesOf({scene}, body, motion, others) {
  const given = others.map(([kind, x, y]) => ({kind: /** @type {Force['kind']} */ (kind), x, y}));
  const all = [...ownForces(scene, body, motion), ...given].filter(({x, y}) => Math.hypot(x, y) > LEAST);
  const [x, y] = totalOf(all);
  return [...all, {kind: 'sum', x, y}];
}

/** @type {(forces: {x: number, y: number}[]) => Point} [N] */
export function totalOf(forces) {
  return [forces.reduce((sum, {x}) => sum + x, 0), forces.reduce((sum, {y}) => sum + y, 0)];
}

/**
 * @param {WorldState} world
 * @param {Force[]} forces
 * @returns {Force[]} the sum for each body on which more than one acts and no hand draws
 */
export function sumsOf(world, forces) {
  /** @type {Map<number, Force[]>} */
  const byRow = new Map();
  for (const {row} of forces) byRow.set(row, []);
  for (const force of forces) byRow.get(force.row)?.push(force);
  const {hands} = world.frame, held = new Set();
  for (let i = 0; hands && i < hands.x.length; i++) held.add(world.bodyAt([hands.x[i], hands.y[i]]));
  return [...byRow].filter(([row, on]) => on.length > 1 && !held.has(row)).map(([row, on]) => {
    const total = totalOf(on), [x, y] = Math.hypot(...total) <= LEAST ? [0, 0] : total;
    return {kind: 'sum', row, at: world.centerOf(row), mutual: false, x, y};
  });
}

/**
 * @param {Iterable<{a: number, b: number}>} pairs of rows: contacts or joints
 * @param {Set<number>} rows of bodies
 * @returns {Set<number>} rows of those that are paired with one of them; -1 is a wall or the background
 */
export function neighboursOf(pairs, rows) {
  /** @type {Set<number>} */
  const found = new Set();
  for (const {a, b} of pairs) {
    if (rows.has(a)) found.add(b);
    if (rows.has(b)) found.add(a);
  }
  return found;
}

/**
 * @param {Force[]} forces
 * @param {Point} gravity
 * @returns {Force[]} of a force and its reaction, the one that bears
 */
export function bearing(forces, [gx, gy]) {
  return forces.filter(({mutual, x, y}) => !mutual || (gx || gy ? x * gx + y * gy <= 0 : y > 0));
}
