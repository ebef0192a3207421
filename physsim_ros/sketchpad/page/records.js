// SPDX-License-Identifier: Apache-2.0
/** The motion of bodies as it was shown, from the past that the server keeps on, and the course that was left. */

import {forcesOf, sumsOf} from './forces.js';

/** @import {App, Force, Sample} from './types.js' */

const MOST = 36000; // samples: ten minutes at 60 a second

export class Records {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {Map<string, {samples: Sample[], left: Sample[]}>} by name of the body, in the order of time */
    this.bodies = new Map();
    /** @type {Map<object, string[]>} names of bodies, by who wants them recorded */
    this.wanted = new Map();
    /** @type {string[]} names of bodies whose past is not asked for yet */
    this.asking = [];
    this.recordsForces = false; // where they are plotted
    this.course = 0;
    this.began = 0; // [s] when this world was opened
    app.connection.on('frame', ({ghost}) => ghost || this.#record());
    app.connection.on('timeline', ({course, now}) => this.#follow(course, now));
    app.connection.on('body', (body) => this.#addPast(body));
    // The answers to what was asked are lost.
    app.connection.on('open', () => this.#ask());
    // In another world, a body of the same name is another body.
    app.connection.on('answer', ({ok, topic}) => {
      // A world is opened, and then begins at time 0.
      if (ok && topic === '~/reset') this.began = 0;
    });
    app.connection.on('world', () => {
      this.began = app.world.frame.time;
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
    const fresh = [...all].filter((name) => !this.bodies.has(name)), waits = this.asking.length > 0;
    for (const name of fresh) this.bodies.set(name, {samples: [], left: []});
    this.asking.push(...fresh);
    if (!waits) this.#ask();
    this.app.askForParts();
  }

  /** @returns {boolean} whether there is anything to record */
  get records() {
    return this.bodies.size > 0;
  }

  /** @param {string} name */
  samples(name) {
    return this.bodies.get(name)?.samples ?? [];
  }

  /** Ask for one past after the other: of several the server sends the last. */
  #ask() {
    const [name] = this.asking;
    if (name) this.app.connection.send('watch', {name});
  }

  /** @param {Record<string, any>} body with the columns of its past */
  #addPast({name, time = [], x, y, yaw, vx, vy, w}) {
    if (name === this.asking[0]) {
      this.asking.shift();
      this.#ask();
    }
    const record = this.bodies.get(name);
    if (!record) return;
    const first = record.samples[0]?.time ?? Infinity;
    const past = time.map((/** @type {number} */ at, /** @type {number} */ i) =>
      ({time: at, x: x[i], y: y[i], yaw: yaw[i], vx: vx[i], vy: vy[i], spin: w[i]})).filter(
      (/** @type {Sample} */ {time}) => time < first && time >= this.began);
    past.forEach((/** @type {Sample} */ sample, /** @type {number} */ i) => accelerate(sample, past[i - 1]));
    record.samples.unshift(...past);
  }

  #record() {
    const {world} = this.app, {frame: {time, yaw, velocities}} = world;
    if (!velocities) return;
    const forces = this.recordsForces && world.frame.contacts ? forcesOf(world) : null, all = forces && [...forces, ...sumsOf(world, forces)];
    for (const [name, {samples}] of this.bodies) {
      const row = world.row(name);
      // A replay of the same course gives the same samples: those that were recorded stay.
      if (row < 0 || time <= (samples.at(-1)?.time ?? -Infinity)) continue;
      const [x, y] = world.place(row, world.scene.bodies[row].centroid);
      const last = samples.at(-1), sample = /** @type {Sample} */ ({time, x, y, yaw: yaw[row], vx: velocities.x[row], vy: velocities.y[row], spin: velocities.spin[row]});
      accelerate(sample, last);
      if (all) sample.forces = sizesOf(all.filter((force) => force.row === row));
      samples.push(sample);
      if (samples.length > MOST) samples.shift();
    }
  }

  /**
   * @param {number} course
   * @param {number} now where it begins, or is returned to [s]
   */
  #follow(course, now) {
    if (course !== this.course) {
      for (const [name, {samples, left}] of this.bodies) {
        const later = samples.filter(({time}) => time >= now);
        this.bodies.set(name, {samples: samples.filter(({time}) => time <= now), left: later.length > 1 ? later : left});
      }
    }
    this.course = course;
  }
}

/**
 * @param {Sample} sample that is given its acceleration
 * @param {Sample | undefined} before
 */
function accelerate(sample, before) {
  if (!before) return;
  const time = sample.time - before.time;
  [sample.ax, sample.ay] = [(sample.vx - before.vx) / time, (sample.vy - before.vy) / time];
}

/**
 * @param {Force[]} forces on a body
 * @returns {Record<string, number>} the size of the sum of each kind [N]
 */
function sizesOf(forces) {
  const kinds = [...new Set(forces.map(({kind}) => kind))];
  return Object.fromEntries(kinds.map((kind) => {
    const those = forces.filter((force) => force.kind === kind);
    return [kind, Math.hypot(those.reduce((sum, {x}) => sum + x, 0), those.reduce((sum, {y}) => sum + y, 0))];
  }));
}
