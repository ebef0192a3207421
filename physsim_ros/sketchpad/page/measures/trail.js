// SPDX-License-Identifier: Apache-2.0
/** The trail of a body: its way, and as in a stroboscope where it was at equal times, numbered, with arrows of v and a. */

import {checkField} from '../dom.js';
import {t} from '../strings.js';
import {distance} from '../vectors.js';

/** @import {Parts, Point, Sample, SceneView} from '../types.js' */

const FLASH = 0.1; // s from flash to flash
const MOST_FLASHES = 100;
const APART = 24, ASIDE = 12; // px: least distance of images with numbers, and from an image to its number
const LONGEST = 90; // px: longer arrows, of impacts, are cut
const ACCELERATION = 0.2; // s: the arrow of a is as long as that of the velocity that it gives in this time

export class Trail {
  /** @param {Parts<'arrows' | 'camera' | 'connection' | 'records' | 'view' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    /** @type {Map<string, boolean>} names of bodies with a trail, and whether it has flashes */
    this.bodies = new Map();
    parts.connection.on('world', () => {
      this.bodies.clear();
      parts.records.want(this, []);
    });
    parts.view.overlays.push((view) => {
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
      this.parts.records.want(this, [...this.bodies.keys()]);
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
    const {world, records} = this.parts, row = world.row(name), samples = records.past(name);
    if (row < 0 || samples.length < 2) return;
    const {palette} = view;
    view.line(samples.map(({x, y}) => [x, y]), palette.faint, [2, 5]);
    if (!flashes) return;
    let last = /** @type {Point} */ ([-Infinity, -Infinity]);
    flashesOf(samples).forEach((sample, i) => {
      const {x, y, vx, vy} = sample, at = view.camera.toPage(x, y);
      // Images are at equal times, however near; numbers and arrows, where there is room for them.
      const isApart = distance(at, last) >= APART;
      this.#flash(view, name, sample, isApart);
      if (!isApart) return;
      last = at;
      const speed = Math.hypot(vx, vy) || 1, aside = /** @type {Point} */ ([vy / speed, vx / speed]);
      view.numbers.push({text: String(i), color: palette.ink, tip: [at[0] - ASIDE * aside[0], at[1] - ASIDE * aside[1]], along: [-aside[0], -aside[1]]});
    });
  }

  /**
   * @param {SceneView} view
   * @param {string} name
   * @param {Sample} sample
   * @param {boolean} hasArrows
   */
  #flash(view, name, sample, hasArrows) {
    const {world, camera, arrows} = this.parts, {palette} = view, row = world.row(name);
    const {x, y, yaw, vx, vy, ax = 0, ay = 0} = sample, [nowX, nowY] = world.centerOf(row);
    view.outline(name, palette.faint, [x - nowX, y - nowY], {turn: yaw - world.frame.yaw[row], scale: 1});
    if (!hasArrows) return;
    const from = camera.toPage(x, y), pixels = arrows.scales['m/s'].length(1);
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
 * @returns {Sample[]} the motion at whole multiples of the time of a flash from the first one on, the last ones; samples may lack
 */
function flashesOf(samples) {
  const flashes = [];
  for (let i = 1, flash = Math.ceil(samples[0].time / FLASH - 1e-6); i < samples.length; i++) {
    for (; flash * FLASH <= samples[i].time + 1e-6; flash++) flashes.push(motionBetween(samples[i - 1], samples[i], flash * FLASH));
  }
  return flashes.slice(-MOST_FLASHES);
}

/**
 * @param {Sample} p
 * @param {Sample} q the next one
 * @param {number} time between them [s]
 * @returns {Sample} by cubic Hermite interpolation, which is exact for constant acceleration
 */
function motionBetween(p, q, time) {
  const h = q.time - p.time, s = (time - p.time) / h, r = 1 - s;
  const place = (/** @type {number[]} */ [from, rate, to, last]) =>
    r * r * (1 + 2 * s) * from + s * r * r * h * rate + s * s * (1 + 2 * r) * to - s * s * r * h * last;
  const linear = (/** @type {'vx' | 'vy' | 'spin'} */ key) => r * p[key] + s * q[key];
  return {...q, time, x: place([p.x, p.vx, q.x, q.vx]), y: place([p.y, p.vy, q.y, q.vy]), yaw: place([p.yaw, p.spin, q.yaw, q.spin]),
    vx: linear('vx'), vy: linear('vy'), spin: linear('spin')};
}
