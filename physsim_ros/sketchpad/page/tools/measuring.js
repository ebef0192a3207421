// SPDX-License-Identifier: Apache-2.0
/** Tools that measure on the page: a ruler and a protractor, which stay until they are tapped away. */

import {Tool} from './tool.js';
import {degrees, threeDigits} from '../rounding.js';
import {onGrid, wrapped} from '../vectors.js';

/** @import {Parts, Point, SceneView, Touch} from '../types.js' */

/** @typedef {Parts<'connection' | 'view'>} Needed */

const TICK = 5, LONG_TICK = 9; // px of the marks of a ruler
const LEAST_TICK = 6; // px from mark to mark
const ARC = 34; // px: radius of the arc of an angle

/** A line from point to point, with marks, its length, slope and differences. @extends {Tool<Needed>} */
export class Ruler extends Tool {
  /** @param {Needed} parts */
  constructor(parts) {
    super(parts);
    /** @type {Point[]} [m] */
    this.ends = [];
    parts.connection.on('world', () => { this.ends = []; });
    parts.view.overlays.push((view) => this.#draw(view));
  }

  begin() {
    this.ends = [];
  }

  /** @param {Touch} touch */
  move(touch) {
    if (this.start) this.ends = [onGrid(this.start.at, touch.grid), onGrid(touch.at, touch.grid)];
  }

  end() {
    if (this.isTap) this.ends = [];
  }

  cancel() {
    if (this.start) this.ends = [];
  }

  /** @param {SceneView} view */
  #draw(view) {
    const [p, q] = this.ends;
    if (!q) return;
    const dx = q[0] - p[0], dy = q[1] - p[1], length = Math.hypot(dx, dy), {ctx, camera, palette} = view;
    view.line([p, q], palette.accent);
    const step = camera.fineStep * Math.max(1, Math.ceil(LEAST_TICK / (camera.fineStep * camera.scale)));
    const [px, py] = camera.toPage(...p), ux = dx / length, uy = -dy / length;
    ctx.strokeStyle = palette.accent;
    ctx.lineWidth = 1.5;
    ctx.beginPath();
    for (let i = 0; length && i * step <= length * (1 + 1e-9); i++) {
      const along = i * step * camera.scale, half = i % 5 ? TICK : LONG_TICK;
      ctx.moveTo(px + along * ux - half * uy, py + along * uy + half * ux);
      ctx.lineTo(px + along * ux + half * uy, py + along * uy - half * ux);
    }
    ctx.stroke();
    const [x, y] = camera.toPage(...q), align = dx < 0 ? 'right' : 'left', aside = x + (dx < 0 ? -14 : 14);
    view.write(`${threeDigits(length)} m, ${degrees(Math.atan2(dy, dx))}`, [aside, y - 3], palette.accent, align);
    view.write(`Δx ${threeDigits(dx)} m, Δy ${threeDigits(dy)} m`, [aside, y + 14], palette.accent, align);
  }
}

/** The angle between two arms: the first one is dragged from the corner, the second one clicked. @extends {Tool<Needed>} */
export class Protractor extends Tool {
  /** @param {Needed} parts */
  constructor(parts) {
    super(parts);
    this.clicks = 2;
    /** @type {Point[]} corner, ends of the arms [m] */
    this.points = [];
    this.follows = false; // whether the second arm follows the pointer
    parts.connection.on('world', () => {
      this.points = [];
      this.follows = false;
    });
    parts.view.overlays.push((view) => this.#draw(view));
  }

  get open() {
    return this.follows;
  }

  /** @param {Touch} touch */
  begin(touch) {
    if (!this.open) this.points = [onGrid(touch.at, touch.grid)];
  }

  /** @param {Touch} touch */
  move(touch) {
    this.points[this.open ? 2 : 1] = onGrid(touch.at, touch.grid);
  }

  /** @param {Touch} touch */
  point(touch) {
    if (this.open) this.move(touch);
  }

  /** @param {Touch} touch */
  end(touch) {
    this.move(touch);
    if (!this.open && this.isTap) this.points = [];
    else this.follows = !this.follows;
  }

  cancel() {
    if (this.follows || this.start) this.points = [];
    this.follows = false;
  }

  /** @param {SceneView} view */
  #draw(view) {
    const [corner, p, q] = this.points;
    if (!p) return;
    const {ctx, camera, palette} = view;
    view.line(q ? [p, corner, q] : [corner, p], palette.accent);
    const [first, second] = [p, q ?? [corner[0] + 1, corner[1]]].map(([x, y]) => Math.atan2(y - corner[1], x - corner[0]));
    const turn = wrapped(second - first), middle = first + turn / 2;
    const [x, y] = camera.toPage(...corner);
    ctx.beginPath();
    ctx.arc(x, y, ARC, -first, -first - turn, turn > 0);
    ctx.stroke();
    view.write(degrees(Math.abs(turn)), [x + 2 * ARC * Math.cos(middle), y - 2 * ARC * Math.sin(middle) + 5], palette.accent, 'center');
  }
}
