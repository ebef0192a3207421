// SPDX-License-Identifier: Apache-2.0
/** The numbers of the selected body now: mass, place, angle, velocity, and its energies as bars. */

import {createElement} from './dom.js';
import {threeDigits} from './rounding.js';

/** @import {App, Body} from './types.js' */

/** Words of the energies. */
const ENERGIES = ['of motion', 'of height'];

export class Numbers {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.most = 0; // greatest energy that was shown of this body [J]
    this.name = '';
    this.line = createElement('p');
    this.bars = ENERGIES.map((word) => createElement('meter', {min: 0, 'aria-label': `Energy ${word}`}));
    this.values = ENERGIES.map(() => createElement('span'));
    this.element = createElement('section', {className: 'numbers', 'aria-label': 'Numbers'}, this.line,
      ...ENERGIES.flatMap((word, i) => [createElement('span', {textContent: `Energy ${word}`}), this.bars[i], this.values[i]]));
    app.view.overlays.push(() => this.#update());
  }

  #update() {
    const {world, panel} = this.app, row = panel.name ? world.row(panel.name) : -1;
    if (row < 0) return;
    const body = world.scene.bodies[row], {frame} = world, [x, y] = world.place(row, body.centroid);
    const degrees = Math.round(frame.yaw[row] * 180 / Math.PI * 10) / 10;
    const speeds = frame.velocities && !body.anchored ?
      [`${number(Math.hypot(frame.velocities.x[row], frame.velocities.y[row]))} m/s`, `${number(frame.velocities.spin[row])} rad/s`] : [];
    const text = [`${threeDigits(body.mass)} kg`, `at ${number(x)}, ${number(y)} m`, `${degrees}°`, ...speeds].join(' · ');
    if (this.line.textContent !== text) this.line.textContent = text;
    this.#showEnergies(body, row);
  }

  /**
   * @param {Body} body
   * @param {number} row
   */
  #showEnergies(body, row) {
    const {world} = this.app, {frame: {velocities}, scene: {gravity}} = world, {name, centroid, anchored} = body;
    if (name !== this.name) this.most = 0;
    this.name = name;
    this.element.classList.toggle('fixed', anchored || !velocities);
    if (!velocities || anchored) return;
    const [x, y] = world.place(row, centroid);
    const motion = {x, y, vx: velocities.x[row], vy: velocities.y[row], spin: velocities.spin[row]};
    const energies = energiesOf(body, motion, gravity);
    this.most = Math.max(this.most, ...energies);
    energies.forEach((energy, i) => {
      this.bars[i].max = this.most || 1;
      this.bars[i].value = Math.max(energy, 0);
      this.values[i].textContent = `${number(energy)} J`;
    });
  }
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

/** @param {number} value */
function number(value) {
  return Math.abs(value) < 0.005 ? '0' : value.toFixed(Math.abs(value) < 100 ? 2 : 0);
}
