// SPDX-License-Identifier: Apache-2.0
/**
 * The forces on bodies in newtons: weight, constant forces, normal force and friction of contacts, joints, air
 * and other fields, and their sum.
 *
 * A contact's impulse is divided by the simulated time that it was summed over, so that a force does not
 * depend on how fast the world plays. Hands and commanded wrenches are not among them.
 */

import {rotated} from '../vectors.js';

/** @import {Body, Force, Point, Sample, WorldState} from '../types.js' */

const LEAST = 1e-3; // N: below that, rounding of what does not act

/**
 * @param {WorldState} world
 * @returns {Force[]} on the bodies that forces move
 */
export function forcesOf(world) {
  const {frame: {contacts, pulls, velocities}, scene: {bodies, joints, gravity: [gx, gy], damping}} = world, {fields} = world.frame;
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
    const {mass, centroid} = bodies[row], at = world.place(row, centroid);
    add('weight', row, at, mass * gx, mass * gy);
    for (const {at: point, force: [x, y]} of appliedTo(world, row)) add('applied', row, point, x, y);
    if (fields) add('air', row, at, fields.x[row], fields.y[row]);
    if (!velocities || !(damping > 0 && damping < 1)) continue;
    const rate = mass * Math.log(1 - damping);
    add('air', row, at, rate * velocities.x[row], rate * velocities.y[row]);
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
  joints.forEach(({a, b, points}, i) => {
    if (!pulls || i >= pulls.x.length) return;
    add('joint', b, world.place(b, points[1]), pulls.x[i], pulls.y[i], a);
    add('joint', a, world.place(a, points[0]), -pulls.x[i], -pulls.y[i], b);
  });
  return forces;
}

/**
 * @param {WorldState} world
 * @param {number} row of a body
 * @returns {{at: Point, force: Point}[]} its constant forces now, in world axes [m, N]
 */
export function appliedTo(world, row) {
  const {forces = [], centroid} = world.scene.bodies[row];
  return forces.map(({force, at = centroid, axes}) => ({at: world.place(row, at),
    force: axes === 'body' ? rotated(force, world.frame.yaw[row]) : force}));
}

/**
 * @param {WorldState} world
 * @param {Body} body
 * @param {Sample} motion of that body in the past
 * @param {Record<string, Point>} others sums of the forces of contacts and joints then, by their kind [N]
 * @returns {{kind: Force['kind'], x: number, y: number}[]} all that acted on it [N], and their sum
 */
export function pastForcesOf({scene: {gravity: [gx, gy], damping}}, {mass, forces = []}, {yaw, vx, vy}, others) {
  const rate = damping > 0 && damping < 1 ? mass * Math.log(1 - damping) : 0;
  const all = /** @type {[Force['kind'], number, number][]} */ ([['weight', mass * gx, mass * gy], ['air', rate * vx, rate * vy],
    ...forces.map(({force, axes}) => ['applied', ...axes === 'body' ? rotated(force, yaw) : force]),
    ...Object.entries(others).map(([kind, force]) => [kind, ...force])])
    .filter(([, x, y]) => Math.hypot(x, y) > LEAST).map(([kind, x, y]) => ({kind, x, y}));
  const total = (/** @type {'x' | 'y'} */ axis) => all.reduce((sum, force) => sum + force[axis], 0);
  return all.length > 1 ? [...all, {kind: 'sum', x: total('x'), y: total('y')}] : all;
}

/**
 * @param {WorldState} world
 * @param {Force[]} forces
 * @returns {Force[]} the sum for each body on which more than one acts and no hand draws
 */
export function sumsOf(world, forces) {
  /** @type {Map<number, Force[]>} */
  const byRow = new Map();
  for (const force of forces) {
    const on = byRow.get(force.row);
    if (on) on.push(force);
    else byRow.set(force.row, [force]);
  }
  const {hands} = world.frame, held = new Set();
  for (let i = 0; hands && i < hands.x.length; i++) held.add(world.bodyAt([hands.x[i], hands.y[i]]));
  return [...byRow].filter(([row, on]) => on.length > 1 && !held.has(row)).map(([row, on]) => {
    const x = on.reduce((sum, force) => sum + force.x, 0), y = on.reduce((sum, force) => sum + force.y, 0);
    const rest = Math.hypot(x, y) <= LEAST;
    return {kind: 'sum', row, at: world.place(row, world.scene.bodies[row].centroid), mutual: false,
      x: rest ? 0 : x, y: rest ? 0 : y};
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
