// SPDX-License-Identifier: Apache-2.0
/** What is measured of a body at a time: the axes of plots and the columns of tables. */

import {energiesOf} from './numbers.js';

/** @import {Body, Sample} from './types.js' */

/**
 * @typedef {{label: string, column: string, of: (sample: Sample, body: Body, gravity: number[]) => number}} Quantity
 *   label: of an axis, column: of a table
 */

/** By key, in the order of the columns. @type {Record<string, Quantity>} */
export const QUANTITIES = {
  time: {label: 'Time [s]', column: 'time [s]', of: ({time}) => time},
  x: {label: 'x [m]', column: 'x [m]', of: ({x}) => x},
  y: {label: 'Height [m]', column: 'y [m]', of: ({y}) => y},
  vx: {label: 'vx [m/s]', column: 'vx [m/s]', of: ({vx}) => vx},
  vy: {label: 'vy [m/s]', column: 'vy [m/s]', of: ({vy}) => vy},
  spin: {label: 'Spin [rad/s]', column: 'spin [rad/s]', of: ({spin}) => spin},
  speed: {label: 'Speed [m/s]', column: 'speed [m/s]', of: ({vx, vy}) => Math.hypot(vx, vy)},
  energy: {label: 'Energy [J]', column: 'energy [J]', of: (sample, body, gravity) => {
    const [motion, height] = energiesOf(body, sample, gravity);
    return motion + height;
  }},
  yaw: {label: 'Angle [rad]', column: 'yaw [rad]', of: ({yaw}) => yaw},
  motion: {label: 'Energy of motion [J]', column: 'energy of motion [J]', of: (sample, body, gravity) => energiesOf(body, sample, gravity)[0]},
  height: {label: 'Energy of height [J]', column: 'energy of height [J]', of: (sample, body, gravity) => energiesOf(body, sample, gravity)[1]},
};

/**
 * @param {{name: string, body: Body, samples: Sample[]}[]} records
 * @param {number[]} gravity
 * @returns {string} a table of all quantities (CSV), the bodies one below the other
 */
export function tableOf(records, gravity) {
  const columns = Object.values(QUANTITIES), head = [...columns.map(({column}) => column), 'body'].join(',');
  const rows = records.flatMap(({name, body, samples}) => samples.map((sample) =>
    [...columns.map(({of}) => of(sample, body, gravity)), `"${name.replaceAll('"', '""')}"`].join(',')));
  return [head, ...rows, ''].join('\n');
}
