// SPDX-License-Identifier: Apache-2.0
/** The plots of the selected body, beside the exact curves of free flight. */

import {createElement, inRow, soon, textButton} from '../dom.js';
import {drawChart, EVERY} from './chart.js';
import {QUANTITIES} from './quantities.js';
import {t} from '../strings.js';
import {watchTheme} from '../view/theme.js';

/** @import {Parts, Sample} from '../types.js' */

const WINDOW = 10, AHEAD = 0.5; // s shown, and s that a flight is drawn beyond the last sample
const LEAST_FLIGHT = 4; // samples
// Velocities come as float32: of the change in a frame, and of the velocity itself.
const SLACK = 5e-3, ROUNDING = 1e-6;
const SHOWN = ['y', 'speed', 'energy'];
const CHART = {width: 272, height: 92, size: 11}; // px

export class Plots {
  /** @param {Parts<'plotting' | 'records' | 'selection' | 'view' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.canvases = SHOWN.map((key) => createElement('canvas', {role: 'img', 'aria-label': QUANTITIES[key].label}));
    this.element = createElement('section', {className: 'plots', 'aria-label': t('Plots')}, ...this.canvases,
      createElement('p', {}, t('Broad: free flight by its formula. Dashed: the earlier course.')),
      inRow(textButton(t('Large plot'), () => parts.plotting.open([parts.selection.name])),
        textButton(t('Table (CSV)'), () => parts.plotting.saveTable([parts.selection.name]))));
    parts.selection.on('change', () => parts.records.want(this, parts.selection.name ? [parts.selection.name] : []));
    parts.view.overlays.push(soon(() => this.#draw(), EVERY));
    watchTheme(() => this.#draw());
  }

  #draw() {
    const {world, view, records, selection: {name}} = this.parts, row = world.row(name), samples = records.samples(name);
    if (row < 0 || !samples.length) return;
    const body = world.scene.bodies[row], {gravity, damping} = world.scene, now = world.frame.time;
    const last = samples[samples.length - 1].time;
    const end = Math.max(Math.min(last, now + WINDOW / 2), samples[0].time + 1) + AHEAD;
    const start = Math.max(end - WINDOW, samples[0].time);
    const within = (/** @type {Sample} */ {time}) => time >= start && time <= end;
    const shown = samples.filter(within), left = records.bodies.get(name)?.left.filter(within) ?? [];
    const flights = damping ? [] : flightsOf(shown, gravity, end);
    SHOWN.forEach((key, i) => {
      const {label, of} = QUANTITIES[key];
      const points = (/** @type {Sample[]} */ some) => some.map((s) => [s.time, of(s, body, gravity)]);
      drawChart(this.canvases[i], {...CHART, xLabel: '', yLabel: label, range: [start, end], mark: now, palette: view.palette,
        behind: [...flights.map((flight) => ({points: points(flight), color: view.palette.force, width: 4, alpha: 0.45})),
          {points: points(left), color: view.palette.faint, width: 1.5, dash: [4, 4]}],
        curves: [{points: points(shown), color: view.palette.accent, width: 1.5}]});
    });
  }
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
          vx: s.vx + gx * t, vy: s.vy + gy * t, yaw: s.yaw + s.spin * t, spin: s.spin};
      }));
    }
    first = i;
  }
  return flights;
}
