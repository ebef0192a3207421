// SPDX-License-Identifier: Apache-2.0
/**
 * Handles of the selected body, for any tool: the round one turns it about its centre of mass, the square one scales
 * it, and the ring at the tip of its velocity changes that.
 */

import {scaledShape} from '../view/body_path.js';
import {originOf} from '../measures/quantities.js';
import {degrees, threeDigits} from '../rounding.js';
import {t} from '../strings.js';
import {Tool} from '../tools/tool.js';
import {distance, onGrid, polar, wrapped} from '../vectors.js';

/** @import {Body, Parts, Point, SceneView, Touch} from '../types.js' */

/** @typedef {'' | 'velocity' | 'turn' | 'scale'} Handle '' is none */

const TURN_GAP = 30, SCALE_GAP = 20; // px from the rim of a body to its handles
const TIP_GAP = 22; // px from the tip of the velocity to its ring
const GRIP = 13, SIZE = 6, RING = 7; // px: within which a handle is grabbed; half of its size; radius of the ring
const FARTHEST = 0.35; // share of the page: handles of larger bodies lie nearer
const STEP = Math.PI / 12, SHARE = 0.25; // rad and steps of the size, with the key of the grid
const LEAST = 0.1; // share of the size to which a body is scaled down at once
const SLOWEST = 5e-4; // m/s: a lower speed is that of a body at rest
const NEAR = 20; // px beyond the handles within which a pointer shows them
const TOUCHED = 4000, READ = 2500; // ms for which they are shown after a finger, and beside arrows that are read

/** @typedef {Parts<'arrows' | 'camera' | 'connection' | 'people' | 'pointers' | 'selection' | 'view' | 'world'>} Needed */

/** @extends {Tool<Needed>} */
export class Handles extends Tool {
  /** @param {Needed} parts */
  constructor(parts) {
    super(parts);
    /** @type {Handle} that is dragged */
    this.dragged = '';
    this.until = 0; // [ms] until then the handles are shown
    parts.view.overlays.push((view) => this.#draw(view));
    parts.pointers.handles = this;
    parts.pointers.on('point', (touch) => this.#point(touch));
    parts.pointers.on('end', ({touch, isFinger}) => this.#point(touch, isFinger));
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
  #point(touch, isFinger = false) {
    const {parts} = this, places = this.places();
    const near = (/** @type {?Point} */ place, /** @type {number} */ reach) => place && touch && distance(touch.page, place) <= reach;
    const isNear = places && (near(places.center, places.reach + TURN_GAP + NEAR) || near(places.velocity, 2 * NEAR));
    const lasting = parts.arrows.forces || parts.arrows.velocities ? READ : isFinger ? TOUCHED : Infinity;
    this.until = isNear ? performance.now() + lasting : 0;
    if (isNear && lasting < Infinity) setTimeout(() => parts.view.redraw(), lasting);
  }

  /**
   * @param {Touch} touch
   * @returns {boolean} whether it is on a handle
   */
  isAt(touch) {
    return this.shown && this.#handleAt(touch) !== '';
  }

  /** @param {Touch} touch */
  begin(touch) {
    this.dragged = this.#handleAt(touch);
    this.parts.arrows.frozen = this.dragged === 'velocity';
  }

  /** @param {Touch} touch */
  end(touch) {
    const {parts, dragged} = this, {connection, world} = parts, {name} = parts.selection, row = world.row(name);
    const {turn, scale} = this.#change(), velocity = this.#velocityAt(touch.page);
    this.cancel();
    if (row < 0) return;
    const body = world.scene.bodies[row];
    if (dragged === 'velocity' && velocity) connection.send('change', {name, properties: {velocity}});
    else if (dragged === 'turn') connection.send('change', {name, properties: {at: poseAbout(parts, row, turn)}});
    else if (dragged === 'scale') {
      connection.send('spawn', {body: {name, ...scaledShape(body.shape, scale), at: poseAbout(parts, row, 0, scale)}});
    }
  }

  cancel() {
    this.dragged = '';
    this.parts.arrows.frozen = false;
  }

  /**
   * @returns {?{center: Point, reach: number, turn: Point, scale: Point, velocity: ?Point}} [px]; null where no single
   *   body is selected; velocity: null where that cannot be set
   */
  places() {
    const {world, camera, selection, view, arrows} = this.parts, row = world.row(selection.name), {velocities} = world.frame;
    if (row < 0 || this.parts.people.viewOnly) return null;
    const body = world.scene.bodies[row], center = camera.toPage(...world.centerOf(row));
    const reach = Math.min(view.bodies.appearance(body).radius * camera.scale,
      FARTHEST * Math.min(camera.width, camera.height));
    const at = (/** @type {number} */ angle, /** @type {number} */ far) => {
      const [dx, dy] = polar(far, angle);
      return /** @type {Point} */ ([center[0] + dx, center[1] - dy]);
    };
    const yaw = world.frame.yaw[row], [vx, vy] = velocities ? [velocities.x[row], velocities.y[row]] : [0, 0];
    return {center, reach, turn: at(yaw + Math.PI / 2, reach + TURN_GAP), scale: at(yaw - Math.PI / 4, reach + SCALE_GAP),
      velocity: velocities && !body.anchored ? at(Math.atan2(vy, vx), Math.hypot(vx, vy) * arrows.scales['m/s'].length(1) + TIP_GAP) : null};
  }

  /** @returns {boolean} */
  get #scales() {
    const {world, selection: {name}} = this.parts, body = world.scene.bodies[world.row(name)];
    return !body.robot && !world.robotOf(name) && body.shape.kind !== 'pieces';
  }

  /**
   * @param {Touch} touch
   * @returns {Handle}
   */
  #handleAt({page, slop}) {
    const places = this.places(), reach = GRIP + slop * this.parts.camera.scale;
    const near = (/** @type {?Point} */ place) => place !== null && distance(page, place) <= reach;
    if (!places) return '';
    return near(places.velocity) ? 'velocity' : near(places.turn) ? 'turn' : near(places.scale) && this.#scales ? 'scale' : '';
  }

  /**
   * @param {Point} ring [px]
   * @returns {?Point} the velocity at whose tip it is [m/s]; null where no body is selected
   */
  #velocityAt(ring) {
    const places = this.places();
    if (!places) return null;
    const [x, y] = places.center, length = distance(ring, places.center);
    const share = Math.max(length - TIP_GAP, 0) / (length || 1) / this.parts.arrows.scales['m/s'].length(1);
    return [(ring[0] - x) * share, (y - ring[1]) * share];
  }

  /** @returns {{turn: number, scale: number}} as it is dragged now: angle [rad] and share */
  #change() {
    const places = this.places(), change = {turn: 0, scale: 1};
    if (!places || !this.start || !this.last) return change;
    const {center: [x, y]} = places, {page: [px, py], grid} = this.last, [fx, fy] = this.start.page;
    if (this.dragged === 'turn') {
      const turn = Math.atan2(fy - y, fx - x) - Math.atan2(py - y, px - x);
      [change.turn] = onGrid([wrapped(turn), 0], grid && STEP);
    } else if (this.dragged === 'scale') {
      const [share] = onGrid([distance([px, py], [x, y]) / (distance([fx, fy], [x, y]) || 1), 0], grid && SHARE);
      change.scale = Math.max(share, LEAST);
    }
    return change;
  }

  /** @param {SceneView} view */
  #draw(view) {
    const places = this.places(), {palette, ctx} = view;
    if (!places) return;
    if (places.velocity) this.#drawVelocity(view, places.center, this.dragged === 'velocity' && this.last ? this.last.page : places.velocity);
    if (!this.shown) return;
    view.onRim(palette.accent, 2, (rim) => {
      ctx.beginPath();
      ctx.arc(...places.turn, SIZE + rim, 0, 2 * Math.PI);
      if (this.#scales) ctx.rect(places.scale[0] - SIZE - rim, places.scale[1] - SIZE - rim, 2 * (SIZE + rim), 2 * (SIZE + rim));
      ctx.fill();
    });
    if (!this.last || this.dragged !== 'turn' && this.dragged !== 'scale') return;
    const {turn, scale} = this.#change(), {world, selection} = this.parts, row = world.row(selection.name);
    view.outline(selection.name, palette.accent, [0, 0], {turn, scale});
    view.writeBeside(this.dragged === 'turn' ? degrees(world.frame.yaw[row] + turn, 0) : sizeText(world.scene.bodies[row], scale), this.last);
  }

  /**
   * @param {SceneView} view
   * @param {Point} center of the body [px]
   * @param {Point} ring [px]
   */
  #drawVelocity(view, center, ring) {
    const {arrows, camera} = this.parts, {accent} = view.palette, length = distance(ring, center) || 1;
    const along = /** @type {Point} */ ([(ring[0] - center[0]) / length, (ring[1] - center[1]) / length]);
    const tip = /** @type {Point} */ ([ring[0] - TIP_GAP * along[0], ring[1] - TIP_GAP * along[1]]);
    const speed = Math.hypot(...this.#velocityAt(ring) ?? [0, 0]);
    // While forces are read, velocities are shown only where somebody has switched them on.
    if (this.shown || arrows.velocities || !arrows.forces) {
      if (length > TIP_GAP + 1) view.arrow(center, tip, accent);
      if (speed >= SLOWEST) view.numbers.push({text: `${threeDigits(speed)} m/s`, color: accent, from: center, tip, along, named: true});
    }
    if (this.shown) view.ring(camera.toWorld(...ring), RING, accent);
  }
}

/**
 * @param {Parts<'world'>} parts
 * @param {number} row
 * @param {number} turn about the centre of mass [rad]
 * @param {number} scale
 * @returns {number[]} x, y [m], yaw [rad] of a body that is turned and scaled
 */
function poseAbout({world}, row, turn, scale = 1) {
  const {centroid} = world.scene.bodies[row], yaw = world.frame.yaw[row] + turn;
  return [...originOf([scale * centroid[0], scale * centroid[1]], world.centerOf(row), yaw), yaw];
}

/**
 * @param {Body} body
 * @param {number} scale
 * @returns {string} its size, scaled
 */
function sizeText({shape: {kind, radius, width, height}}, scale) {
  if (kind === 'disc') return t('radius {length} m', {length: threeDigits(scale * radius)});
  if (width && height) return `${threeDigits(scale * width)} × ${threeDigits(scale * height)} m`;
  return `× ${threeDigits(scale)}`;
}
