// SPDX-License-Identifier: Apache-2.0
/**
 * The motion of bodies in the course that is shown, as far as the server keeps it, and the course that was left; and the
 * trail of a body: its way, and as in a stroboscope where it was at equal times, numbered, with arrows of v and a.
 */

import {checkField} from '../dom.js';
import {forcesOf, pastForcesOf, sumsOf} from '../view/forces.js';
import {t} from '../strings.js';
import {distance} from '../vectors.js';

/** @import {Force, Parts, Point, Sample, SceneView} from '../types.js' */

const MOST = 36000; // samples: ten minutes at 60 a second

export class Records {
  /** @param {Parts<'connection' | 'frames' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    /** @type {Map<string, {samples: Sample[], left: Sample[]}>} by name of the body, in the order of time */
    this.bodies = new Map();
    /** @type {Map<object, string[]>} names of bodies, by who wants them recorded */
    this.wanted = new Map();
    /** @type {string[]} names of bodies whose past is not asked for yet */
    this.asking = [];
    this.began = 0; // [s] when this world was opened
    this.opened = false; // whether its first frame is to come
    parts.connection.on('frame', () => this.#record());
    parts.connection.on('line', ({since}) => this.#leave(since));
    parts.connection.on('body', (body) => this.#addPast(body));
    parts.connection.on('past_forces', (forces) => this.#addForces(forces));
    // The answers to what was asked are lost.
    parts.connection.on('open', () => this.#ask());
    // In another world, a body of the same name is another body.
    parts.connection.on('answer', ({ok, topic}) => {
      if (ok && topic === '~/reset') this.began = 0;
    });
    parts.connection.on('world', () => {
      this.opened = true;
      for (const name of this.bodies.keys()) this.bodies.set(name, {samples: [], left: []});
    });
  }

  /**
   * @param {object} by who wants them
   * @param {string[]} names of bodies
   */
  want(by, names) {
    this.wanted.set(by, names);
    const all = new Set([...this.wanted.values()].flat());
    for (const name of this.bodies.keys()) if (!all.has(name)) this.bodies.delete(name);
    const fresh = [...all].filter((name) => !this.bodies.has(name));
    for (const name of fresh) this.bodies.set(name, {samples: [], left: []});
    this.#askFor(fresh);
    this.parts.frames.want(this, {velocities: all.size > 0, contacts: all.size > 0});
  }

  /** @param {string} name */
  samples(name) {
    return this.bodies.get(name)?.samples ?? [];
  }

  /** @param {string[]} names of bodies whose past is not known */
  #askFor(names) {
    const waits = this.asking.length > 0;
    this.asking.push(...names.filter((name) => !this.asking.includes(name)));
    if (!waits) this.#ask();
  }

  /** Ask for one past after the other: of several the server sends the last. */
  #ask() {
    const [name] = this.asking;
    if (name) this.parts.connection.send('watch', {name, forces: true});
  }

  /** @param {Record<string, any>} body with the columns of its past */
  #addPast({name, time = [], x, y, yaw, vx, vy, w}) {
    if (name === this.asking[0]) {
      this.asking.shift();
      this.#ask();
    }
    const record = this.bodies.get(name);
    if (!record) return;
    const recorded = new Map(record.samples.map((sample) => [sample.time, sample]));
    time.forEach((/** @type {number} */ at, /** @type {number} */ i) => {
      if (at >= this.began && !recorded.has(at)) recorded.set(at, {time: at, x: x[i], y: y[i], yaw: yaw[i], vx: vx[i], vy: vy[i], spin: w[i]});
    });
    record.samples = [...recorded.values()].sort((one, other) => one.time - other.time);
    record.samples.forEach((sample, i, all) => accelerate(sample, all[i - 1]));
  }

  /** @param {{name: string, time: number[]} & Record<string, Point[]>} columns of its past, with a column of each kind of force */
  #addForces({name, time, type, ...kinds}) {
    const {world} = this.parts, body = world.body(name), samples = this.bodies.get(name)?.samples;
    if (!body || !samples || body.anchored || body.kinematic) return;
    const byTime = new Map(samples.map((sample) => [sample.time, sample]));
    time.forEach((at, i) => {
      const sample = byTime.get(at);
      if (sample) sample.forces ??= sizesOf(pastForcesOf(world, body, sample, Object.entries(kinds).map(([kind, column]) => [kind, ...column[i]])));
    });
  }

  #record() {
    const {world} = this.parts, {frame: {time, yaw, velocities}} = world;
    if (this.opened) this.began = time;
    this.opened = false;
    if (!velocities) return;
    const forces = this.bodies.size && world.frame.contacts ? forcesOf(world) : null, all = forces && [...forces, ...sumsOf(world, forces)];
    const held = Boolean(world.frame.hands?.x.length);
    for (const [name, {samples}] of this.bodies) {
      const row = world.row(name), known = samples.findLast((sample) => sample.time <= time);
      // A replay of the same course gives the same samples: those that were recorded stay, and get the forces of what is shown.
      if (all && known?.time === time) known.forces = sizesOf(all.filter((force) => force.row === row), held);
      if (row < 0 || time <= (samples.at(-1)?.time ?? -Infinity)) continue;
      const [x, y] = world.place(row, world.scene.bodies[row].centroid);
      /** @type {Sample} */
      const sample = {time, x, y, yaw: yaw[row], vx: velocities.x[row], vy: velocities.y[row], spin: velocities.spin[row]};
      accelerate(sample, samples.at(-1));
      if (all) sample.forces = sizesOf(all.filter((force) => force.row === row), held);
      samples.push(sample);
      if (samples.length > MOST) samples.shift();
    }
  }

  /**
   * Keep what did not happen in the line that is in force as the course that was left, and ask for what did.
   * @param {number} since [s]
   */
  #leave(since) {
    for (const [name, {samples, left}] of this.bodies) {
      const place = samples.findIndex(({time}) => time > since - 1e-9), later = place < 0 ? [] : samples.splice(place);
      this.bodies.set(name, {samples, left: later.length > 1 ? later : left});
    }
    if (this.parts.world.timeline.newest > since) this.#askFor([...this.bodies.keys()]);
  }
}

/**
 * @param {Sample} sample that is given its acceleration
 * @param {Sample | undefined} before
 */
function accelerate(sample, before) {
  if (!before) return;
  const time = sample.time - before.time;
  [sample.ax, sample.ay, sample.spinning] = [(sample.vx - before.vx) / time, (sample.vy - before.vy) / time, (sample.spin - before.spin) / time];
}

/**
 * @param {{kind: Force['kind'], x: number, y: number}[]} forces on a body
 * @param {boolean} held whether a hand may draw, whose force is not known
 * @returns {Record<string, number>} the size of the sum of each kind [N]
 */
function sizesOf(forces, held = false) {
  const size = (/** @type {typeof forces} */ some) => Math.hypot(some.reduce((sum, {x}) => sum + x, 0), some.reduce((sum, {y}) => sum + y, 0));
  const kinds = [...new Set(forces.map(({kind}) => kind))];
  const sizes = Object.fromEntries(kinds.map((kind) => [kind, size(forces.filter((force) => force.kind === kind))]));
  // Of fewer than two forces no sum is told beside them.
  return forces.length < 2 && !held ? {...sizes, sum: size(forces)} : sizes;
}

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
    const {world, records} = this.parts, row = world.row(name), now = world.frame.time + 1e-9;
    const samples = records.samples(name).filter(({time}) => time <= now);
    if (row < 0 || samples.length < 2) return;
    const {palette} = view;
    view.line(samples.map(({x, y}) => [x, y]), palette.faint, [2, 5]);
    if (!flashes) return;
    let last = /** @type {Point} */ ([-Infinity, -Infinity]);
    flashesOf(samples).forEach((sample, i) => {
      const {x, y, vx, vy} = sample, at = view.camera.toPage(x, y);
      // Images are at equal times, however near; numbers and arrows, where there is room for them.
      const isApart = distance(at, last) >= APART;
      this.#flash(view, row, sample, isApart);
      if (!isApart) return;
      last = at;
      const speed = Math.hypot(vx, vy) || 1, aside = /** @type {Point} */ ([vy / speed, vx / speed]);
      view.number({text: String(i), color: palette.ink, tip: [at[0] - ASIDE * aside[0], at[1] - ASIDE * aside[1]], along: [-aside[0], -aside[1]]});
    });
  }

  /**
   * @param {SceneView} view
   * @param {number} row
   * @param {Sample} sample
   * @param {boolean} hasArrows
   */
  #flash(view, row, sample, hasArrows) {
    const {world, camera, arrows} = this.parts, {palette} = view;
    const {x, y, yaw, vx, vy, ax = 0, ay = 0} = sample, [nowX, nowY] = world.place(row, world.scene.bodies[row].centroid);
    view.outline(row, palette.faint, [x - nowX, y - nowY], {turn: yaw - world.frame.yaw[row], scale: 1});
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
