// SPDX-License-Identifier: Apache-2.0
/** What is measured of a body at a time: the axes of plots and the columns of tables. */

import {energiesOf} from './numbers.js';

/** @import {Body, Sample} from './types.js' */

/**
 * @typedef {{label: string, column: string, of: (sample: Sample, body: Body, gravity: number[]) => number, sums?: boolean}} Quantity
 *   label: of an axis, column: of a table; of: NaN where it is not known; sums: whether that of several bodies is their sum
 */

/** Kinds of forces, as they are recorded. */
export const FORCES = {weight: 'Weight', normal: 'Normal force', friction: 'Friction', joint: 'Force of joints', sum: 'Sum of forces'};

/** By key, in the order of the columns. @type {Record<string, Quantity>} */
export const QUANTITIES = {
  time: {label: 'Time [s]', column: 'time [s]', of: ({time}) => time},
  x: {label: 'x [m]', column: 'x [m]', of: ({x}) => x},
  y: {label: 'Height [m]', column: 'y [m]', of: ({y}) => y},
  vx: {label: 'vx [m/s]', column: 'vx [m/s]', of: ({vx}) => vx},
  vy: {label: 'vy [m/s]', column: 'vy [m/s]', of: ({vy}) => vy},
  spin: {label: 'Spin [rad/s]', column: 'spin [rad/s]', of: ({spin}) => spin},
  speed: {label: 'Speed [m/s]', column: 'speed [m/s]', of: ({vx, vy}) => Math.hypot(vx, vy)},
  energy: {label: 'Energy [J]', column: 'energy [J]', sums: true, of: (sample, body, gravity) => {
    const [motion, height] = energiesOf(body, sample, gravity);
    return motion + height;
  }},
  px: {label: 'px [N s]', column: 'px [N s]', sums: true, of: ({vx}, {mass}) => mass * vx},
  py: {label: 'py [N s]', column: 'py [N s]', sums: true, of: ({vy}, {mass}) => mass * vy},
  momentum: {label: 'Momentum [N s]', column: 'momentum [N s]', of: ({vx, vy}, {mass}) => mass * Math.hypot(vx, vy)},
  ax: {label: 'ax [m/s²]', column: 'ax [m/s²]', of: ({ax = NaN}) => ax},
  ay: {label: 'ay [m/s²]', column: 'ay [m/s²]', of: ({ay = NaN}) => ay},
  acceleration: {label: 'Acceleration [m/s²]', column: 'acceleration [m/s²]', of: ({ax = NaN, ay = NaN}) => Math.hypot(ax, ay)},
  yaw: {label: 'Angle [rad]', column: 'yaw [rad]', of: ({yaw}) => yaw},
  motion: {label: 'Energy of motion [J]', column: 'energy of motion [J]', sums: true, of: (sample, body, gravity) => energiesOf(body, sample, gravity)[0]},
  height: {label: 'Energy of height [J]', column: 'energy of height [J]', sums: true, of: (sample, body, gravity) => energiesOf(body, sample, gravity)[1]},
  ...Object.fromEntries(Object.entries(FORCES).map(([kind, name]) => [kind, /** @type {Quantity} */ ({label: `${name} [N]`, column: `${name.toLowerCase()} [N]`,
    of: ({forces}) => forces?.[kind] ?? NaN})])),
};

/**
 * @param {{name: string, body: Body, samples: Sample[]}[]} records
 * @param {number[]} gravity
 * @returns {string} a table of all quantities (CSV), the bodies one below the other
 */
export function tableOf(records, gravity) {
  const columns = Object.values(QUANTITIES), head = [...columns.map(({column}) => column), 'body'].join(',');
  const rows = records.flatMap(({name, body, samples}) => samples.map((sample) =>
    [...columns.map(({of}) => of(sample, body, gravity)).map((value) => Number.isNaN(value) ? '' : value), `"${name.replaceAll('"', '""')}"`].join(',')));
  return [head, ...rows, ''].join('\n');
}
