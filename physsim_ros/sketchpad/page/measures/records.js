// SPDX-License-Identifier: Apache-2.0
/** The motion of bodies in the line of events in force, as far as the server keeps it, and in the course that was left. */

import {forcesOf, pastForcesOf, sumsOf, totalOf} from '../view/forces.js';

/** @import {Force, Parts, Point, Sample} from '../types.js' */

const MOST = 36000; // samples: ten minutes at 60 a second
const ROUNDED = 1e-6; // more than float32 rounds off, in shares

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

  /**
   * @param {string} name
   * @returns {Sample[]} up to the moment that is shown
   */
  past(name) {
    return this.samples(name).filter(({time}) => time <= this.parts.world.frame.time + 1e-9);
  }

  /**
   * @param {string} name
   * @returns {Sample | undefined} of the moment that is shown, or the last one before
   */
  now(name) {
    return this.samples(name).findLast(({time}) => time <= this.parts.world.frame.time + 1e-9);
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
      if (row < 0) continue;
      const [x, y] = world.centerOf(row);
      /** @type {Sample} */
      const sample = {time, x, y, yaw: yaw[row], vx: velocities.x[row], vy: velocities.y[row], spin: velocities.spin[row]};
      if (known?.time === time) {
        // A replay of the same course gives the same motion, but for what is rounded: the recorded one stays, unless a
        // request has changed it while time stands. The forces are those of what is shown.
        if (differ(known, sample)) Object.assign(known, sample);
        if (all) known.forces = sizesOf(all.filter((force) => force.row === row), held);
      }
      if (time <= (samples.at(-1)?.time ?? -Infinity)) continue;
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
 * @param {Sample} recorded
 * @param {Sample} shown by a frame, whose numbers are float32
 * @returns {boolean} whether they are two motions
 */
function differ(recorded, shown) {
  const keys = /** @type {const} */ (['x', 'y', 'yaw', 'vx', 'vy', 'spin']);
  return keys.some((key) => Math.abs(recorded[key] - shown[key]) > ROUNDED * (1 + Math.abs(shown[key])));
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
  const size = (/** @type {typeof forces} */ some) => Math.hypot(...totalOf(some));
  const kinds = [...new Set(forces.map(({kind}) => kind))];
  const sizes = Object.fromEntries(kinds.map((kind) => [kind, size(forces.filter((force) => force.kind === kind))]));
  // Of fewer than two forces no sum is told beside them.
  return forces.length < 2 && !held ? {...sizes, sum: size(forces)} : sizes;
}
