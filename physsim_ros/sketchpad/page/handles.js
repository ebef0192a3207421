// SPDX-License-Identifier: Apache-2.0
/** Handles of the selected body: the round one turns it about its centre of mass, the square one scales it, the ring sets its velocity. */

import {scaledShape} from './body_path.js';
import {originOf} from './numbers.js';
import {onGrid, threeDigits} from './rounding.js';
import {t} from './strings.js';

/** @import {App, Body, Point, SceneView, Touch} from './types.js' */

const TURN_GAP = 30, SCALE_GAP = 20; // px from the rim of a body to its handles
const GRIP = 12, SIZE = 6; // px: within which a handle is grabbed; half of its size
const FARTHEST = 0.35; // share of the page: handles of larger bodies lie nearer
const STEP = Math.PI / 12, SHARE = 0.25; // rad and steps of the size, with the key of the grid
const LEAST = 0.1, MOST = 10; // of its size
const NEAR = 20; // px beyond the handles within which a pointer shows them
const TOUCHED = 4000, READ = 2500; // ms for which they are shown after a finger, and beside arrows that are read

export class Handles {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {'turn' | 'scale' | ''} the handle that is dragged */
    this.dragged = '';
    /** @type {Point} [px] */
    this.from = [0, 0];
    /** @type {?Touch} */
    this.last = null;
    this.until = 0; // [ms] until then the handles are shown
    app.view.overlays.push((view) => this.#draw(view));
  }

  /** @returns {boolean} whether the handles are there: a pointer is near, or has been */
  get shown() {
    return this.dragged !== '' || performance.now() < this.until;
  }

  /**
   * Show the handles while a pointer is near the selected body, and for a while after a finger was there.
   * @param {?Touch} touch null where it has left
   * @param {boolean} isFinger
   */
  point(touch, isFinger = false) {
    const {app} = this, places = this.places(), before = this.shown, ring = app.arrow.place;
    const near = (/** @type {Point} */ [x, y], /** @type {number} */ reach) =>
      touch !== null && Math.hypot(touch.page[0] - x, touch.page[1] - y) <= reach;
    const isNear = places && (near(places.center, places.reach + TURN_GAP + NEAR) || ring && near(ring, 2 * NEAR));
    const lasting = app.arrows.forces || app.arrows.velocities ? READ : isFinger ? TOUCHED : Infinity;
    this.until = isNear ? performance.now() + lasting : 0;
    if (isNear && lasting < Infinity) setTimeout(() => { app.view.dirty = true; }, lasting);
    if (this.shown !== before) app.view.dirty = true;
  }

  /**
   * @param {Touch} touch
   * @returns {boolean} whether it is on a handle
   */
  isAt(touch) {
    return this.shown && this.#handleAt(touch) !== '';
  }

  /** @param {Touch} touch */
  down(touch) {
    this.dragged = this.#handleAt(touch);
    this.from = touch.page;
    this.last = touch;
  }

  /** @param {Touch} touch */
  move(touch) {
    this.last = touch;
  }

  /** @param {Touch} touch */
  up(touch) {
    this.last = touch;
    const {app, dragged} = this, {connection, world} = app, {name} = app.panel, row = world.row(name);
    const {turn, scale} = this.#change();
    this.cancel();
    if (row < 0) return;
    const body = world.scene.bodies[row];
    if (dragged === 'turn') connection.send('change', {name, properties: {at: poseAbout(app, row, turn)}});
    else if (dragged === 'scale') {
      connection.send('spawn', {body: {name, ...scaledShape(body.shape, scale), at: poseAbout(app, row, 0, scale)}});
    }
  }

  cancel() {
    this.dragged = '';
  }

  /** @returns {?{center: Point, reach: number, turn: Point, scale: Point}} [px]; null where no single body is selected */
  places() {
    const {world, camera, panel, view} = this.app, row = world.row(panel.name);
    if (row < 0 || this.app.viewOnly) return null;
    const body = world.scene.bodies[row], center = camera.toPage(...world.place(row, body.centroid));
    const reach = Math.min(view.bodies.appearance(body).radius * camera.scale,
      FARTHEST * Math.min(camera.width, camera.height));
    const at = (/** @type {number} */ angle, /** @type {number} */ gap) => /** @type {Point} */ ([
      center[0] + (reach + gap) * Math.cos(angle), center[1] - (reach + gap) * Math.sin(angle)]);
    const yaw = world.frame.yaw[row];
    return {center, reach, turn: at(yaw + Math.PI / 2, TURN_GAP), scale: at(yaw - Math.PI / 4, SCALE_GAP)};
  }

  /** @returns {boolean} */
  get #scales() {
    const body = this.app.world.scene.bodies[this.app.world.row(this.app.panel.name)];
    return !body.robot && body.shape.kind !== 'pieces';
  }

  /**
   * @param {Touch} touch
   * @returns {'turn' | 'scale' | ''}
   */
  #handleAt({page, slop}) {
    const places = this.places(), reach = GRIP + slop * this.app.camera.scale;
    if (!places) return '';
    const near = ([x, y] = places.turn) => Math.hypot(page[0] - x, page[1] - y) <= reach;
    return near() ? 'turn' : this.#scales && near(places.scale) ? 'scale' : '';
  }

  /** @returns {{turn: number, scale: number}} as it is dragged now: angle [rad] and share */
  #change() {
    const places = this.places(), change = {turn: 0, scale: 1};
    if (!places || !this.last) return change;
    const {center: [x, y]} = places, {page: [px, py], grid} = this.last, [fx, fy] = this.from;
    if (this.dragged === 'turn') {
      const turn = Math.atan2(fy - y, fx - x) - Math.atan2(py - y, px - x);
      [change.turn] = onGrid([Math.atan2(Math.sin(turn), Math.cos(turn)), 0], grid && STEP);
    } else if (this.dragged === 'scale') {
      const [share] = onGrid([Math.hypot(px - x, py - y) / (Math.hypot(fx - x, fy - y) || 1), 0], grid && SHARE);
      change.scale = Math.min(Math.max(share, LEAST), MOST);
    }
    return change;
  }

  /** @param {SceneView} view */
  #draw(view) {
    const places = this.shown ? this.places() : null, {palette, ctx} = view;
    if (!places) return;
    const row = this.app.world.row(this.app.panel.name);
    view.onRim(palette.accent, 2, (rim) => {
      ctx.beginPath();
      ctx.arc(...places.turn, SIZE + rim, 0, 2 * Math.PI);
      if (this.#scales) ctx.rect(places.scale[0] - SIZE - rim, places.scale[1] - SIZE - rim, 2 * (SIZE + rim), 2 * (SIZE + rim));
      ctx.fill();
    });
    if (!this.dragged || !this.last) return;
    const {turn, scale} = this.#change(), [x, y] = this.last.page;
    view.outline(row, palette.accent, [0, 0], {turn, scale});
    const text = this.dragged === 'turn' ?
      `${Math.round((this.app.world.frame.yaw[row] + turn) * 180 / Math.PI)}°` : sizeOf(this.app.world.scene.bodies[row], scale);
    view.write(text, [x + 14, y - 14], palette.accent);
  }
}

/**
 * @param {App} app
 * @param {number} row
 * @param {number} turn about the centre of mass [rad]
 * @param {number} scale
 * @returns {number[]} x, y [m], yaw [rad] of a body that is turned and scaled
 */
function poseAbout({world}, row, turn, scale = 1) {
  const {centroid} = world.scene.bodies[row], yaw = world.frame.yaw[row] + turn;
  return [...originOf([scale * centroid[0], scale * centroid[1]], world.place(row, centroid), yaw), yaw];
}

/**
 * @param {Body} body
 * @param {number} scale
 * @returns {string} its size, scaled
 */
function sizeOf({shape: {kind, radius, width, height}}, scale) {
  if (kind === 'disc') return t('radius {length} m', {length: threeDigits(scale * radius)});
  if (width && height) return `${threeDigits(scale * width)} × ${threeDigits(scale * height)} m`;
  return `× ${threeDigits(scale)}`;
}

const RING_GRIP = 14; // px around the tip
const GAP = 22; // px between the tip of the arrow and its ring
const RING = 7; // px
const AT_REST = 5e-4; // m/s: a lower speed is that of a body at rest

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
    const ends = this.#ends(), reach = RING_GRIP + slop * this.app.camera.scale;
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
      if (speed >= AT_REST) view.number({text: `${threeDigits(speed)} m/s`, color: accent, from: center, tip: end, along, named: true});
    }
    if (this.dragged || handles.shown) view.ring(this.app.camera.toWorld(...page), RING, accent);
  }
}
