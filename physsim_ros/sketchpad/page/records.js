// SPDX-License-Identifier: Apache-2.0
/** The motion of bodies as it was shown, from the past that the server keeps on, and the course that was left. */

/** @import {App, Sample} from './types.js' */

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
    record.samples.unshift(...time.map((/** @type {number} */ at, /** @type {number} */ i) =>
      ({time: at, x: x[i], y: y[i], yaw: yaw[i], vx: vx[i], vy: vy[i], spin: w[i]})).filter(
      (/** @type {Sample} */ {time}) => time < first && time >= this.began));
  }

  #record() {
    const {world} = this.app, {frame: {time, yaw, velocities}} = world;
    if (!velocities) return;
    for (const [name, {samples}] of this.bodies) {
      const row = world.row(name);
      // A replay of the same course gives the same samples: those that were recorded stay.
      if (row < 0 || time <= (samples.at(-1)?.time ?? -Infinity)) continue;
      const [x, y] = world.place(row, world.scene.bodies[row].centroid);
      samples.push({time, x, y, yaw: yaw[row], vx: velocities.x[row], vy: velocities.y[row], spin: velocities.spin[row]});
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
