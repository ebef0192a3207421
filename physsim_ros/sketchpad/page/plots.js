// SPDX-License-Identifier: Apache-2.0
/** Height, speed and energy of a body against time, beside the exact curves of free flight. */

import {createElement, download, textButton} from './dom.js';
import {energiesOf} from './numbers.js';

/** @import {App, Body, Palette} from './types.js' */

/** @typedef {{time: number, x: number, y: number, vx: number, vy: number, spin: number}} Sample */

const WINDOW = 10, AHEAD = 0.5; // s shown, and s that a flight is drawn beyond the last sample
const MOST = 36000; // samples: ten minutes at 60 a second
const LEAST_FLIGHT = 4; // samples
// Velocities come as float32: of the change in a frame, and of the velocity itself.
const SLACK = 5e-3, ROUNDING = 1e-6;
const WIDTH = 272, HEIGHT = 84, LEFT = 40; // px

export class Plots {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.name = '';
    /** @type {Sample[]} in the order of time */
    this.samples = [];
    this.course = 0;
    this.began = 0; // [s] when this world was opened
    this.canvases = ['Height [m]', 'Speed [m/s]', 'Energy [J]'].map((label) =>
      createElement('canvas', {role: 'img', 'aria-label': label, width: 2 * WIDTH, height: 2 * HEIGHT}));
    this.element = createElement('section', {className: 'plots', 'aria-label': 'Plots'}, ...this.canvases,
      createElement('p', {textContent: 'Broad: free flight, by its formula'}),
      textButton('Table (CSV)', () => this.#save()));
    app.connection.on('frame', () => this.#record());
    app.connection.on('timeline', ({course, now}) => {
      if (course !== this.course) this.samples = this.samples.filter(({time}) => time <= now);
      this.course = course;
    });
    app.connection.on('body', (body) => this.#addPast(body));
    // In another world, a body of the same name is another body.
    app.connection.on('answer', ({ok, topic}) => {
      if (!ok || topic !== '~/load_world' && topic !== '~/clear') return;
      this.began = app.world.frame.time;
      this.samples = [];
    });
  }

  /** @param {string} name of a body; '' for none */
  watch(name) {
    if (name === this.name) return;
    this.name = name;
    this.samples = [];
    this.app.connection.send('watch', {name});
    this.app.askForParts();
  }

  /** @param {Record<string, any>} body with the columns of its past */
  #addPast({name, time = [], x, y, vx, vy, w}) {
    if (name !== this.name) return;
    const first = this.samples[0]?.time ?? Infinity;
    const past = time.map((/** @type {number} */ at, /** @type {number} */ i) =>
      ({time: at, x: x[i], y: y[i], vx: vx[i], vy: vy[i], spin: w[i]}));
    this.samples.unshift(...past.filter((/** @type {Sample} */ {time}) => time < first && time >= this.began));
  }

  #record() {
    const {world} = this.app, {frame} = world, row = this.name ? world.row(this.name) : -1;
    if (row < 0 || !frame.velocities) return;
    const [x, y] = world.place(row, world.scene.bodies[row].centroid), {velocities} = frame;
    const last = this.samples.at(-1)?.time ?? -Infinity;
    // A replay of the same course gives the same samples: those that were recorded stay.
    if (frame.time > last) this.samples.push({time: frame.time, x, y, vx: velocities.x[row],
      vy: velocities.y[row], spin: velocities.spin[row]});
    if (this.samples.length > MOST) this.samples.shift();
    if (!this.waits) {
      this.waits = true;
      setTimeout(() => this.#draw(), 80);
    }
  }

  #draw() {
    this.waits = false;
    const {world, view} = this.app, row = world.row(this.name);
    if (row < 0 || !this.samples.length) return;
    const body = world.scene.bodies[row], now = world.frame.time;
    const last = this.samples[this.samples.length - 1].time;
    const end = Math.max(Math.min(last, now + WINDOW / 2), this.samples[0].time + 1) + AHEAD;
    const start = Math.max(end - WINDOW, this.samples[0].time);
    const shown = this.samples.filter(({time}) => time >= start && time <= end);
    const flights = world.scene.damping ? [] : flightsOf(shown, world.scene.gravity, end);
    const quantities = [(/** @type {Sample} */ s) => s.y, speedOf,
      (/** @type {Sample} */ s) => energyOf(s, body, world.scene.gravity)];
    quantities.forEach((quantity, i) => {
      plot(this.canvases[i], {start, end, now, palette: view.palette, label: this.canvases[i].ariaLabel ?? '',
        curve: shown.map((s) => [s.time, quantity(s)]),
        exact: flights.map((flight) => flight.map((s) => [s.time, quantity(s)]))});
    });
  }

  #save() {
    const {world} = this.app, body = world.scene.bodies[world.row(this.name)];
    const rows = this.samples.map((s) => [s.time, s.x, s.y, s.vx, s.vy, s.spin, speedOf(s),
      body ? energyOf(s, body, world.scene.gravity) : ''].join(','));
    const head = 'time [s],x [m],y [m],vx [m/s],vy [m/s],spin [rad/s],speed [m/s],energy [J]';
    download(`${this.name.replaceAll('/', '-')}.csv`, new Blob([[head, ...rows, ''].join('\n')],
      {type: 'text/csv'}));
  }
}

/** @param {Sample} sample */
function speedOf({vx, vy}) {
  return Math.hypot(vx, vy);
}

/**
 * @param {Sample} sample
 * @param {Body} body
 * @param {number[]} gravity
 */
function energyOf(sample, body, gravity) {
  const [motion, height] = energiesOf(body, sample, gravity);
  return motion + height;
}

/**
 * Free flights are runs of samples whose velocity changes by gravity alone. Each is drawn from its first
 * sample by the exact law, so that it lies on the curve only if the world keeps that law.
 * @param {Sample[]} samples
 * @param {number[]} gravity
 * @param {number} end [s]
 * @returns {Sample[][]}
 */
function flightsOf(samples, [gx, gy], end) {
  const flights = [];
  const slack = SLACK * Math.hypot(gx, gy);
  for (let first = 0, i = 1; i <= samples.length; i++) {
    const p = samples[i - 1], q = samples[i], dt = q ? q.time - p.time : 0;
    const rounding = ROUNDING * (Math.abs(p.vx) + Math.abs(p.vy));
    if (q && Math.hypot(q.vx - p.vx - gx * dt, q.vy - p.vy - gy * dt) <= slack * dt + rounding) continue;
    if (i - first > LEAST_FLIGHT) {
      const until = q ? p.time : Math.min(p.time + AHEAD, end), s = samples[first];
      flights.push(Array.from({length: 61}, (_, k) => {
        const t = (until - s.time) * k / 60;
        return {time: s.time + t, x: s.x + s.vx * t + gx * t * t / 2, y: s.y + s.vy * t + gy * t * t / 2,
          vx: s.vx + gx * t, vy: s.vy + gy * t, spin: s.spin};
      }));
    }
    first = i;
  }
  return flights;
}

/**
 * @param {HTMLCanvasElement} canvas
 * @param {{start: number, end: number, now: number, label: string, curve: number[][],
 *   exact: number[][][], palette: Palette}} what
 */
function plot(canvas, {start, end, now, label, curve, exact, palette}) {
  const ctx = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  const values = curve.map(([, value]) => value);
  let least = Math.min(...values), most = Math.max(...values);
  const margin = Math.max((most - least) * 0.12, Math.abs(most) * 0.02, 0.05);
  least -= margin;
  most += margin;
  const atX = (/** @type {number} */ t) => LEFT + (WIDTH - LEFT - 4) * (t - start) / (end - start);
  const atY = (/** @type {number} */ v) => HEIGHT - 14 - (HEIGHT - 30) * (v - least) / (most - least);
  const line = (/** @type {number[][]} */ points) => {
    ctx.beginPath();
    for (const [t, v] of points) ctx.lineTo(atX(t), atY(v));
    ctx.stroke();
  };
  ctx.setTransform(2, 0, 0, 2, 0, 0);
  ctx.clearRect(0, 0, WIDTH, HEIGHT);
  ctx.font = '11px system-ui, sans-serif';
  ctx.fillStyle = palette.ink;
  ctx.fillText(label, 0, 10);
  ctx.fillStyle = palette.faint;
  const marks = most - least > 4 * margin ? [least + margin, most - margin] : [(least + most) / 2];
  for (const value of marks) {
    const rounded = Number(Math.abs(value) < 1 ? value.toFixed(2) : value.toPrecision(3));
    ctx.fillText(String(rounded), 0, atY(value) + 4);
  }
  ctx.fillText(`${start.toFixed(1)} s`, LEFT, HEIGHT - 2);
  ctx.fillText(`${end.toFixed(1)} s`, WIDTH - 34, HEIGHT - 2);
  ctx.save();
  ctx.beginPath();
  ctx.rect(LEFT, 14, WIDTH, HEIGHT - 26);
  ctx.clip();
  ctx.lineWidth = 1;
  ctx.strokeStyle = palette.major;
  line([[now, least], [now, most]]);
  ctx.strokeStyle = palette.force;
  ctx.lineWidth = 4;
  ctx.globalAlpha = 0.45;
  for (const flight of exact) line(flight);
  ctx.globalAlpha = 1;
  ctx.strokeStyle = palette.accent;
  ctx.lineWidth = 1.5;
  line(curve);
  ctx.restore();
}
