// SPDX-License-Identifier: Apache-2.0
/** The velocity of the selected body as an arrow; dragging the ring at its tip changes it, with any tool. */

import {threeDigits} from './rounding.js';

/** @import {App, Point, SceneView, Touch} from './types.js' */

const GRIP = 14; // px around the tip
const GAP = 22; // px between the tip of the arrow and its ring
const RING = 7; // px
const LEAST = 5e-4; // m/s: a lower speed is that of a body at rest

export class VelocityArrow {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {?Point} where the tip is dragged to [px] */
    this.dragged = null;
    app.view.overlays.push((view) => this.#draw(view));
  }

  /**
   * @param {Touch} touch
   * @returns {boolean} whether it is on the tip
   */
  isAt({page, slop}) {
    const ends = this.#ends(), reach = GRIP + slop * this.app.camera.scale;
    return this.app.handles.shown && ends !== null && Math.hypot(page[0] - ends.tip[0], page[1] - ends.tip[1]) <= reach;
  }

  /** @param {Touch} touch */
  down({page}) {
    this.app.arrows.frozen = true;
    this.dragged = page;
  }

  /** @param {Touch} touch */
  move({page}) {
    this.dragged = page;
  }

  /** @param {Touch} touch */
  up({page}) {
    const ends = this.#ends(), {app} = this;
    this.cancel();
    if (ends) app.connection.send('change', {name: app.panel.name, properties: {velocity: this.#velocityAt(ends.center, page)}});
  }

  cancel() {
    this.dragged = null;
    this.app.arrows.frozen = false;
  }

  /**
   * @param {Point} center of the body [px]
   * @param {Point} tip [px]
   * @returns {Point} [m/s]
   */
  #velocityAt(center, tip) {
    const dx = tip[0] - center[0], dy = tip[1] - center[1], length = Math.hypot(dx, dy);
    const share = Math.max(length - GAP, 0) / (length || 1) / this.app.arrows.speeds.length(1);
    return [dx * share, -dy * share];
  }

  /** @returns {?{center: Point, tip: Point, along: Point}} [px]; null where no single body is selected that may move */
  #ends() {
    const {world, camera, panel} = this.app, row = world.row(panel.name);
    const velocities = world.frame.velocities;
    if (row < 0 || !velocities || world.scene.bodies[row].anchored) return null;
    const center = camera.toPage(...world.place(row, world.scene.bodies[row].centroid));
    const pixels = this.app.arrows.speeds.length(1), vx = velocities.x[row] * pixels, vy = -velocities.y[row] * pixels;
    const length = Math.hypot(vx, vy), along = /** @type {Point} */ (length > 1 ? [vx / length, vy / length] : [1, 0]);
    return {center, along, tip: [center[0] + vx + GAP * along[0], center[1] + vy + GAP * along[1]]};
  }

  /** @returns {?Point} of its ring [px] */
  get place() {
    return this.#ends()?.tip ?? null;
  }

  /** @param {SceneView} view */
  #draw(view) {
    const ends = this.#ends(), {arrows, handles} = this.app;
    if (!ends) return;
    const {center, tip} = ends, page = this.dragged ?? tip, length = Math.hypot(page[0] - center[0], page[1] - center[1]);
    const along = /** @type {Point} */ (length ? [(page[0] - center[0]) / length, (page[1] - center[1]) / length] : [1, 0]);
    const end = /** @type {Point} */ ([page[0] - GAP * along[0], page[1] - GAP * along[1]]);
    const speed = Math.hypot(...this.#velocityAt(center, page)), {accent} = view.palette;
    // While forces are read, velocities are shown only where somebody has switched them on.
    if (this.dragged || handles.shown || arrows.velocities || !arrows.forces) {
      if (length > GAP + 1) view.arrow(center, end, accent);
      if (speed >= LEAST) view.number({text: `${threeDigits(speed)} m/s`, color: accent, from: center, tip: end, along, named: true});
    }
    if (this.dragged || handles.shown) view.ring(this.app.camera.toWorld(...page), RING, accent);
  }
}
