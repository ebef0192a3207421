// SPDX-License-Identifier: Apache-2.0
/**
 * Arrows of forces and velocities, with their numbers and a scale that fits the view and is told in it.
 *
 * Of selected bodies all forces are shown; where none is selected, those of all bodies, and of a force between
 * two that move the one that bears.
 */

import {bearing, forcesOf, sumsOf} from './forces.js';
import {roundUp, threeDigits} from './rounding.js';

/** @import {App, Force, Palette, Point, SceneView} from './types.js' */

/** @typedef {{text: string, color: string, x: number, y: number, ux: number, uy: number}} Label at the tip of an arrow */

const BAR = 60; // px: of the bar that a scale is told by
const ROOM = 0.3; // share of the view that the longest arrow may take
const SHORT = 0.12; // share of that room below which the scale becomes finer
const SETTLED = 400; // ms for which an arrow is too long or too short before the scale follows
const CUT = 1.3; // times the room: longer arrows, of impacts, are cut
const BETWEEN = 6, LEGEND = 17; // px: from a tip to its number, from line to line
const LOW = 500; // px: on a lower page the legend is one line
const LEAST = 4; // px: of an arrow
const LEAST_SPEED = 5; // m/s: that there is always room for
const FONT = '13px system-ui, sans-serif';
/** Kinds of forces, and what they are called. @type {Record<Force['kind'], string>} */
const NAMES = {weight: 'weight', normal: 'normal force', friction: 'friction', joint: 'joint', air: 'air', sum: 'sum'};

/** How many units are a bar's length: 1, 2 or 5 times a power of ten. */
class ArrowScale {
  constructor() {
    this.unit = 0;
    this.since = 0; // [ms] since when it does not fit
  }

  /**
   * @param {number} most that is shown [unit]
   * @param {number} room for it [px]
   * @param {boolean} atOnce whether nothing moves
   */
  fit(most, room, atOnce) {
    const length = this.length(most), now = performance.now();
    if (length <= room && length >= SHORT * room || !(most > 0) && this.unit) {
      this.since = 0;
      return;
    }
    this.since ||= now;
    if (this.unit && !atOnce && now - this.since < SETTLED) return;
    this.since = 0;
    this.unit = roundUp((most || 1) * BAR / room);
  }

  /** @param {number} value */
  length(value) {
    return value * BAR / this.unit;
  }
}

export class Arrows {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.velocities = this.forces = false; // whether they are shown
    this.newtons = new ArrowScale();
    this.speeds = new ArrowScale();
    this.frozen = false; // the scale of velocities, while one is dragged
    /** @type {{name: string, kind: string, force: Point, size: string, from: Point, to: Point}[]} */
    this.drawn = []; // forces, as they are drawn
    app.view.overlays.push((view) => this.#draw(view));
  }

  /** @param {SceneView} view */
  #draw(view) {
    const {world, camera} = this.app;
    const room = ROOM * Math.max(Math.min(camera.width - view.insets.left - view.insets.right,
      camera.height - view.insets.top - view.insets.bottom), 2 * BAR);
    /** @type {Label[]} */
    const labels = [];
    /** @type {[string, string, string][]} */
    const legend = [];
    this.drawn = [];
    this.#fitSpeeds(room);
    if (this.velocities && world.frame.velocities) {
      this.#drawVelocities(view, labels, CUT * room);
      legend.push([`${this.speeds.unit} m/s`, view.palette.accent, 'velocity']);
    }
    if (this.forces && world.count) {
      const kinds = this.#drawForces(view, labels, room);
      legend.push([`${this.newtons.unit} N`, view.palette.ink, 'forces'],
        ...kinds.map((kind) => /** @type {[string, string, string]} */ (['', colorOf(kind, view.palette), NAMES[kind]])));
    }
    drawLabels(view, labels);
    if (legend.length) drawLegend(view, legend);
  }

  /** @param {number} room [px] */
  #fitSpeeds(room) {
    const {world, selection} = this.app, {velocities} = world.frame;
    if (!velocities || this.frozen) return;
    let most = LEAST_SPEED;
    world.scene.bodies.forEach(({name, anchored}, row) => {
      if (row < world.count && !anchored && (this.velocities || selection.names.has(name))) {
        most = Math.max(most, Math.hypot(velocities.x[row], velocities.y[row]) || 0);
      }
    });
    this.speeds.fit(most, room, world.paused);
  }

  /**
   * @param {SceneView} view
   * @param {Label[]} labels
   * @param {number} most [px]
   */
  #drawVelocities(view, labels, most) {
    const {world, camera, panel} = this.app, {velocities} = world.frame;
    for (let row = 0; velocities && row < world.count; row++) {
      const body = world.scene.bodies[row], x = velocities.x[row], y = velocities.y[row];
      // The arrow of the selected body has a ring, and stands beside its centre.
      if (body.anchored || body.name === panel.name) continue;
      const from = camera.toPage(...world.place(row, body.centroid));
      drawArrow(view, from, x, y, this.speeds, most, view.palette.accent, `${threeDigits(Math.hypot(x, y))} m/s`, labels);
    }
  }

  /**
   * @param {SceneView} view
   * @param {Label[]} labels
   * @param {number} room [px]
   * @returns {Force['kind'][]} that are shown
   */
  #drawForces(view, labels, room) {
    const {world, camera, selection} = this.app, all = forcesOf(world);
    const chosen = (/** @type {Force} */ {row}) => selection.names.has(world.scene.bodies[row].name);
    const some = all.filter(chosen), sums = sumsOf(world, all);
    const forces = some.length ? [...some, ...sums.filter(chosen)] : [...bearing(all, world.scene.gravity), ...sums];
    this.newtons.fit(Math.max(...forces.map(({x, y}) => Math.hypot(x, y)), 0), room, world.paused);
    for (const {kind, row, at, x, y} of forces) {
      const size = `${threeDigits(Math.hypot(x, y))} N`, from = camera.toPage(...at);
      const text = some.length ? `${NAMES[kind]} ${size}` : size;
      const to = drawArrow(view, from, x, y, this.newtons, CUT * room, colorOf(kind, view.palette), text, labels, kind === 'sum' ? 4 : 2.5);
      if (!to && kind === 'sum' && some.length) labels.push({text: 'sum 0 N', color: view.palette.ink, x: from[0], y: from[1] - BAR / 2, ux: 0, uy: -1});
      this.drawn.push({name: world.scene.bodies[row].name, kind, force: [x, y], size, from, to: to ?? from});
    }
    return /** @type {Force['kind'][]} */ (Object.keys(NAMES)).filter((kind) => forces.some((force) => force.kind === kind));
  }
}

/**
 * @param {Force['kind']} kind
 * @param {Palette} palette
 */
function colorOf(kind, palette) {
  return kind === 'sum' ? palette.ink : kind === 'normal' ? palette.force : palette[kind];
}

/**
 * @param {SceneView} view
 * @param {Point} from [px]
 * @param {number} x in units, y up
 * @param {number} y
 * @param {ArrowScale} scale
 * @param {number} most length [px]; a longer arrow is cut
 * @param {string} color
 * @param {string} text its number
 * @param {Label[]} labels that the number is added to
 * @param {number} width [px]
 * @returns {?Point} its tip [px]; null where the arrow is too short to be seen
 */
function drawArrow(view, from, x, y, scale, most, color, text, labels, width = 2.5) {
  const size = Math.hypot(x, y), whole = scale.length(size);
  if (!(whole >= LEAST)) return null;
  const length = Math.min(whole, most), ux = x / size, uy = -y / size;
  /** @type {Point} */
  const tip = [from[0] + ux * length, from[1] + uy * length];
  view.arrow(from, tip, color, {width, cut: whole > most});
  // What lies beyond the page has no number at its edge.
  const {width: right, height: bottom} = view.camera, [left, top] = from;
  if (left > 0 && left < right && top > 0 && top < bottom) labels.push({text, color, x: tip[0], y: tip[1], ux, uy});
  return tip;
}

/**
 * Numbers beyond the tips, where none covers one before.
 * @param {SceneView} view
 * @param {Label[]} labels
 */
function drawLabels(view, labels) {
  /** @type {number[][]} left, top, right, bottom */
  const taken = [];
  view.ctx.font = FONT;
  for (const {text, color, x, y, ux, uy} of labels) {
    const half = view.ctx.measureText(text).width / 2, {insets, camera} = view;
    const cx = Math.min(Math.max(x + ux * (BETWEEN + half), insets.left + half + 4), camera.width - half - 4);
    const cy = Math.min(Math.max(y + uy * (BETWEEN + 8), insets.top + 12), camera.height - insets.bottom - 12);
    const box = [cx - half, cy - 8, cx + half, cy + 8];
    if (taken.some(([left, top, right, bottom]) => box[0] < right && left < box[2] && box[1] < bottom && top < box[3])) continue;
    taken.push(box);
    view.write(text, [cx, cy + 4], color, 'center');
  }
}

/**
 * The scales, as bars of their lengths, and the colours.
 * @param {SceneView} view
 * @param {[string, string, string][]} lines length of a bar, '' for a line of colour alone; colour; word
 */
function drawLegend(view, lines) {
  const {ctx, insets, camera} = view, low = camera.height < LOW;
  let left = insets.left + 56, y = insets.top + (low ? 28 : 40);
  for (const [length, color, word] of lines) {
    const width = length ? BAR : 18, text = length ? `${length}  ${word}` : word;
    const begin = left;
    view.onRim(color, 2.5, () => {
      ctx.beginPath();
      ctx.moveTo(begin, y);
      ctx.lineTo(begin + width, y);
      if (length) for (const x of [begin, begin + BAR]) {
        ctx.moveTo(x, y - 4);
        ctx.lineTo(x, y + 4);
      }
      ctx.stroke();
    });
    view.write(text, [left + width + 8, y + 4], color);
    if (low) left += width + ctx.measureText(text).width + 24;
    else y += LEGEND;
  }
}
