// SPDX-License-Identifier: Apache-2.0
/**
 * What is measured of bodies: place, velocity, momentum, energies now, in words; and of a sample of the past by the axes
 * of plots and the columns of tables.
 */

import {degrees, threeDigits, twoPlaces} from '../rounding.js';
import {t} from '../strings.js';
import {DEGREE, rotated, wrapped} from '../vectors.js';

/** @import {Body, Point, Sample, WorldState} from '../types.js' */

/**
 * The mass of a body [kg], and the place, angle and velocity of its centre of mass [m, °, m/s, rad/s].
 * @typedef {{mass: number, x: number, y: number, angle: number, vx: number, vy: number, spin: number}} Motion
 */

/**
 * @param {WorldState} world
 * @param {number} row
 * @returns {Motion} of a body; its velocity is 0 where it is not known
 */
export function motionOf(world, row) {
  const {frame: {yaw, velocities}, scene} = world, {mass} = scene.bodies[row], [x, y] = world.centerOf(row);
  return {mass, x, y, angle: wrapped(yaw[row]) / DEGREE,
    vx: velocities?.x[row] ?? 0, vy: velocities?.y[row] ?? 0, spin: velocities?.spin[row] ?? 0};
}

/**
 * @param {WorldState} world
 * @param {string[]} names of bodies
 * @returns {string} their mass, momentum and energies together; what is anchored has none
 */
export function totalsOf(world, names) {
  const {bodies, gravity} = world.scene;
  let mass = 0, px = 0, py = 0, energy = [0, 0];
  for (const row of names.map((name) => world.row(name)).filter((each) => each >= 0 && !bodies[each].anchored)) {
    const motion = motionOf(world, row), each = energiesOf(bodies[row], motion, gravity);
    mass += bodies[row].mass;
    px += bodies[row].mass * motion.vx;
    py += bodies[row].mass * motion.vy;
    energy = [energy[0] + each[0], energy[1] + each[1]];
  }
  return t('Together {mass} kg · momentum {momentum} · kinetic energy {motion} J, potential {height} J',
    {mass: threeDigits(mass), momentum: momentumText([px, py]), motion: twoPlaces(energy[0]), height: twoPlaces(energy[1])});
}

/**
 * @param {Body} body
 * @param {{x: number, y: number, vx: number, vy: number, spin: number}} motion of its centre of mass [m, m/s, rad/s]
 * @param {number[]} gravity [m/s²]
 * @returns {[number, number]} energy of motion, and of height above the origin [J]
 */
export function energiesOf({mass, moment}, {x, y, vx, vy, spin}, [gx, gy]) {
  return [mass * (vx * vx + vy * vy) / 2 + moment * spin * spin / 2, -mass * (gx * x + gy * y)];
}

/**
 * @param {Point} centroid in the frame of a body [m]
 * @param {Point} center where that is to be [m]
 * @param {number} yaw [rad]
 * @returns {Point} where the body's origin is then [m]
 */
export function originOf(centroid, [x, y], yaw) {
  const [dx, dy] = rotated(centroid, yaw);
  return [x - dx, y - dy];
}

/**
 * @param {WorldState} world
 * @param {number} row
 * @param {Point} by displacement [m]
 * @returns {string} the place and angle of a body, and how fast it is where that is known
 */
export function placed(world, row, by = [0, 0]) {
  const {frame: {yaw, velocities}, scene} = world, {anchored} = scene.bodies[row];
  const [x, y] = world.centerOf(row);
  const texts = [t('at {x}, {y} m', {x: twoPlaces(x + by[0]), y: twoPlaces(y + by[1])}), degrees(yaw[row])];
  if (velocities && !anchored) {
    texts.push(`${twoPlaces(Math.hypot(velocities.x[row], velocities.y[row]))} m/s`, `${twoPlaces(velocities.spin[row])} rad/s`);
  }
  return texts.join(' · ');
}

/** @param {Point} momentum [N s] */
export function momentumText([px, py]) {
  return `${twoPlaces(Math.hypot(px, py))} N s ${t('({x}, {y})', {x: twoPlaces(px), y: twoPlaces(py)})}`;
}

/**
 * @typedef {{label: string, of: (sample: Sample, body: Body, gravity: number[]) => number, sums?: boolean}} Quantity
 *   label: of an axis, and of a column; of: NaN where it is not known; sums: whether that of several bodies is their sum
 */

/** Kinds of forces, as they are recorded, with their names on axes and in tables. */
const FORCES = {weight: t('Weight'), normal: t('Normal force'), friction: t('Friction'), joint: t('Force of joints'),
  applied: t('Applied force'), sum: t('Sum of forces')};

/** By key, in the order of the columns. @type {Record<string, Quantity>} */
export const QUANTITIES = {
  time: {label: t('Time [s]'), of: ({time}) => time},
  x: {label: 'x [m]', of: ({x}) => x},
  y: {label: t('Height [m]'), of: ({y}) => y},
  vx: {label: 'vx [m/s]', of: ({vx}) => vx},
  vy: {label: 'vy [m/s]', of: ({vy}) => vy},
  spin: {label: t('Spin [rad/s]'), of: ({spin}) => spin},
  speed: {label: t('Speed [m/s]'), of: ({vx, vy}) => Math.hypot(vx, vy)},
  energy: {label: t('Energy [J]'), sums: true, of: (sample, body, gravity) => {
    const [motion, height] = energiesOf(body, sample, gravity);
    return motion + height;
  }},
  px: {label: 'px [N s]', sums: true, of: ({vx}, {mass}) => mass * vx},
  py: {label: 'py [N s]', sums: true, of: ({vy}, {mass}) => mass * vy},
  momentum: {label: t('Momentum [N s]'), of: ({vx, vy}, {mass}) => mass * Math.hypot(vx, vy)},
  turning: {label: t('Angular momentum [N m s]'), of: ({spin}, {moment}) => moment * spin},
  torque: {label: t('Torque, of all forces [N m]'), of: ({spinning = NaN}, {moment}) => moment * spinning},
  ax: {label: 'ax [m/s²]', of: ({ax = NaN}) => ax},
  ay: {label: 'ay [m/s²]', of: ({ay = NaN}) => ay},
  acceleration: {label: t('Acceleration [m/s²]'), of: ({ax = NaN, ay = NaN}) => Math.hypot(ax, ay)},
  yaw: {label: t('Angle [rad]'), of: ({yaw}) => yaw},
  motion: {label: t('Kinetic energy [J]'), sums: true, of: (sample, body, gravity) => energiesOf(body, sample, gravity)[0]},
  height: {label: t('Potential energy [J]'), sums: true, of: (sample, body, gravity) => energiesOf(body, sample, gravity)[1]},
  ...Object.fromEntries(Object.entries(FORCES).map(([kind, name]) =>
    [kind, /** @type {Quantity} */ ({label: `${name} [N]`, of: ({forces}) => forces ? forces[kind] ?? (kind === 'sum' ? NaN : 0) : NaN})])),
};

/**
 * @param {string} key of a quantity
 * @returns {string} its unit, as its label tells it
 */
export function unitOf(key) {
  return QUANTITIES[key].label.replace(/.*\[|\]/g, '');
}

/**
 * @param {string} key of a quantity
 * @param {number} value
 * @returns {string} its name, its value and its unit
 */
export function quantityText(key, value) {
  return QUANTITIES[key].label.replace('[', `${Number.isNaN(value) ? '–' : threeDigits(value)} `).replace(']', '');
}
