// SPDX-License-Identifier: Apache-2.0
/** The trail of a body: its way, and as in a stroboscope where it was at equal times, numbered, with arrows of v and a. */

import {checkField} from './dom.js';
import {t} from './strings.js';

/** @import {App, Point, Sample, SceneView} from './types.js' */

const FLASH = 0.1; // s from flash to flash
const MOST_FLASHES = 100;
const APART = 24, ASIDE = 12; // px: least distance of images, and from an image to its number
const LONGEST = 90; // px: longer arrows, of impacts, are cut
const ACCELERATION = 0.2; // s: the arrow of a is as long as that of the velocity that it gives in this time

export class Trail {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {Map<string, boolean>} names of bodies with a trail, and whether it has flashes */
    this.bodies = new Map();
    app.connection.on('world', () => {
      this.bodies.clear();
      app.records.want(this, []);
    });
    app.view.overlays.push((view) => {
      for (const [name, flashes] of this.bodies) this.#draw(view, name, flashes);
    });
  }

  /**
   * @param {string} name of a body
   * @returns {HTMLElement[]} its switches
   */
  switches(name) {
    let trail = this.bodies.has(name), flashes = this.bodies.get(name) ?? false;
    const follow = () => {
      if (trail || flashes) this.bodies.set(name, flashes);
      else this.bodies.delete(name);
      this.app.records.want(this, [...this.bodies.keys()]);
    };
    return [checkField(t('Trail'), trail, (checked) => {
      trail = checked;
      follow();
    }), checkField(t('Stroboscope, with v and a'), flashes, (checked) => {
      flashes = checked;
      follow();
    })];
  }

  /**
   * @param {SceneView} view
   * @param {string} name
   * @param {boolean} flashes
   */
  #draw(view, name, flashes) {
    const {world, records} = this.app, row = world.row(name), now = world.frame.time + 1e-9;
    const samples = records.samples(name).filter(({time}) => time <= now);
    if (row < 0 || samples.length < 2) return;
    const {palette} = view;
    view.line(samples.map(({x, y}) => [x, y]), palette.faint, [2, 5]);
    if (!flashes) return;
    let last = [-Infinity, -Infinity];
    flashesOf(samples).forEach((number, i) => {
      const {x, y, vx, vy} = samples[number], at = view.camera.toPage(x, y);
      // On a slow way one in so many, so that images do not hide each other.
      if (Math.hypot(at[0] - last[0], at[1] - last[1]) < APART) return;
      last = at;
      this.#flash(view, row, samples, number);
      const speed = Math.hypot(vx, vy) || 1, aside = /** @type {Point} */ ([vy / speed, vx / speed]);
      view.number({text: String(i + 1), color: palette.ink, tip: [at[0] - ASIDE * aside[0], at[1] - ASIDE * aside[1]], along: [-aside[0], -aside[1]]});
    });
  }

  /**
   * @param {SceneView} view
   * @param {number} row
   * @param {Sample[]} samples
   * @param {number} number of the sample
   */
  #flash(view, row, samples, number) {
    const {world, camera, arrows} = this.app, {palette} = view, sample = samples[number];
    const {x, y, yaw, vx, vy, ax = 0, ay = 0} = sample, [nowX, nowY] = world.place(row, world.scene.bodies[row].centroid);
    view.outline(row, palette.faint, [x - nowX, y - nowY], {turn: yaw - world.frame.yaw[row], scale: 1});
    const from = camera.toPage(x, y), pixels = arrows.speeds.length(1);
    drawArrow(view, from, vx * pixels, vy * pixels, palette.accent);
    drawArrow(view, from, ax * pixels * ACCELERATION, ay * pixels * ACCELERATION, palette.weight);
  }
}

/**
 * @param {SceneView} view
 * @param {Point} from [px]
 * @param {number} x [px], y up
 * @param {number} y
 * @param {string} color
 */
function drawArrow(view, [px, py], x, y, color) {
  const length = Math.hypot(x, y), share = Math.min(1, LONGEST / length);
  view.arrow([px, py], [px + x * share, py - y * share], color, {width: 1.5, cut: share < 1});
}

/**
 * @param {Sample[]} samples
 * @returns {number[]} numbers of those next after whole multiples of the time of a flash, the last ones
 */
function flashesOf(samples) {
  const numbers = [];
  for (let i = 1; i < samples.length; i++) {
    if (Math.floor(samples[i].time / FLASH + 1e-6) > Math.floor(samples[i - 1].time / FLASH + 1e-6)) numbers.push(i);
  }
  return numbers.slice(-MOST_FLASHES);
}
