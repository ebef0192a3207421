// SPDX-License-Identifier: Apache-2.0
/**
 * Arrows of velocities, momenta and forces, round ones of angular momenta and torques, with their numbers, to the
 * scales of the legend.
 *
 * Of selected bodies all forces are shown, and of those that touch them or that a joint connects with them. Where
 * none is selected, those of all bodies, as long as they are few, and of a force between two that move the one
 * that bears.
 */

import {ArrowScale, BAR} from './arrow_scale.js';
import {elementOf} from '../dom.js';
import {appliedTo, bearing, forcesOf, neighboursOf, sumsOf} from './forces.js';
import {Legend} from './legend.js';
import {threeDigits} from '../rounding.js';
import {t} from '../strings.js';

/** @import {Force, Palette, Parts, Point, SceneView} from '../types.js' */

const ROOM = 0.3; // share of the view that the longest arrow may take
const CUT = 1.3; // times the room: longer arrows, of impacts, are cut
const LEAST = 4; // px: of an arrow
const LENGTH = 34; // px: of the arrow of a constant force, where forces are not shown to scale
const LEAST_SPEED = 5; // m/s: that there is always room for
const FEW = 12; // bodies that move, of which all forces are shown where none is selected
const WIDE = 4, USUAL = 2.5, NARROW = 1.5; // px: arrows of sums, of others, of bodies beside the selected ones
const ROUND = 30, INNER = 22, ARC = 130; // px: radius of the arrow of a torque, of an angular momentum, and the longest one
const NO_TURN = 1e-3; // N m, N m s: below that, rounding of what does not turn

/**
 * @typedef {{from: Point, x: number, y: number, scale: ArrowScale, color: string, text: string, width?: number, unit?: string,
 *   named?: boolean}} Arrow from [px]; x, y in units, y up; text: its number; unit: of its components, where they are shown
 */

export class Arrows {
  /** @param {Parts<'camera' | 'connection' | 'frames' | 'people' | 'records' | 'selection' | 'view' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.velocities = this.forces = false; // whether they are shown
    this.legend = new Legend(parts);
    /** By their units. */
    this.scales = {'m/s': new ArrowScale(), 'N s': new ArrowScale(), 'N m s': new ArrowScale(), N: new ArrowScale(), 'N m': new ArrowScale()};
    this.frozen = false; // the scale of velocities, while one is dragged
    /** @type {{name: string, kind: string, force: Point, size: string, from: Point, to: Point}[]} */
    this.drawn = []; // forces, as they are drawn
    parts.view.overlays.push((view) => this.#draw(view));
  }

  /**
   * Show them, or show them no longer.
   * @param {'velocities' | 'forces'} what
   */
  toggle(what) {
    this[what] = !this[what];
    const {velocities, forces} = this;
    this.legend.show({velocities, forces});
    this.parts.frames.want(this, {velocities: velocities || forces, contacts: forces});
  }

  /** @param {SceneView} view */
  #draw(view) {
    const {world, camera} = this.parts;
    const room = Math.max(ROOM * Math.min(camera.width - view.insets.left - view.insets.right,
      camera.height - view.insets.top - view.insets.bottom), BAR);
    this.drawn = [];
    this.#fitSpeeds(room);
    if (this.velocities && world.frame.velocities) this.#drawVelocities(view, room);
    this.legend.place();
    for (const each of [this.legend.element, elementOf('panel')]) {
      const {left, top, right, bottom} = each.getBoundingClientRect();
      view.covered.push([left, top, right, bottom]);
    }
    let hint = '';
    if (!this.forces) drawApplied(this.parts, view);
    else if (world.count) hint = this.#drawForces(view, room);
    this.legend.showScales(this.scales, hint);
  }

  /** @param {number} room [px] */
  #fitSpeeds(room) {
    const {world, selection} = this.parts, {velocities} = world.frame;
    if (!velocities || this.frozen) return;
    let most = LEAST_SPEED, mostImpulse = 0, mostTurn = 0;
    world.scene.bodies.forEach(({name, anchored, mass, moment}, row) => {
      if (row < world.count && !anchored && (this.velocities || selection.names.has(name))) {
        const speed = Math.hypot(velocities.x[row], velocities.y[row]) || 0;
        most = Math.max(most, speed);
        mostImpulse = Math.max(mostImpulse, mass * speed);
        mostTurn = Math.max(mostTurn, Math.abs(moment * velocities.spin[row]) || 0);
      }
    });
    this.scales['m/s'].fit(most, room, world.paused);
    this.scales['N s'].fit(mostImpulse, room, world.paused);
    this.scales['N m s'].fit(mostTurn, ARC, world.paused);
  }

  /**
   * @param {SceneView} view
   * @param {number} room [px]
   */
  #drawVelocities(view, room) {
    const {world, camera, selection} = this.parts, {velocities} = world.frame, {accent, momentum} = view.palette;
    for (let row = 0; velocities && row < world.count; row++) {
      const {anchored, name, mass, moment} = world.scene.bodies[row], x = velocities.x[row], y = velocities.y[row];
      if (anchored) continue;
      const from = camera.toPage(...world.centerOf(row)), speed = Math.hypot(x, y);
      if (this.legend.momenta) {
        this.#arrow(view, room, {from, x: mass * x, y: mass * y, scale: this.scales['N s'], color: momentum,
          text: `${threeDigits(mass * speed)} N s`, width: WIDE});
        this.#roundArrow(view, from, moment * velocities.spin[row], {unit: 'N m s', radius: INNER, color: momentum});
      }
      const velocity = {from, x, y, scale: this.scales['m/s'], color: accent, text: `${threeDigits(speed)} m/s`, unit: 'm/s'};
      // The arrow of the selected body can be dragged (input/handles.js).
      if (name !== selection.name) this.#arrow(view, room, velocity);
      else if (this.legend.components) this.#components(view, room, velocity);
    }
  }

  /**
   * @param {SceneView} view
   * @param {number} room [px]
   * @returns {string} a hint where more can be shown
   */
  #drawForces(view, room) {
    const {world, camera, selection, people: {viewOnly}} = this.parts, all = forcesOf(world), {bodies} = world.scene;
    const selected = new Set([...selection.names].map((name) => world.row(name)));
    const isSelected = (/** @type {Force} */ {row}) => selected.has(row), sums = sumsOf(world, all);
    this.legend.addKinds([...all, ...sums].map(({kind}) => kind));
    this.#drawTorque(view);
    const some = all.some(isSelected), beside = some ? neighboursOf([...world.touches, ...world.scene.joints], selected) : selected;
    const few = viewOnly || bodies.filter(({anchored, kinematic}) => !anchored && !kinematic).length <= FEW;
    const forces = [...all, ...sums].filter((force) => !this.legend.off.has(force.kind) && (some ? isSelected(force) || beside.has(force.row) : few));
    const shown = some ? forces : bearing(forces, world.scene.gravity);
    const below = camera.height - view.insets.bottom;
    // The tip of a weight on the floor lies above the bar of time.
    this.scales.N.fit(Math.max(...shown.map(({at, x, y}) =>
      Math.max(Math.hypot(x, y), -y * room / Math.max(below - camera.toPage(...at)[1], BAR / 2))), 0), room, world.paused);
    for (const force of shown) {
      const {kind, row, at, x, y} = force, named = some && isSelected(force), color = colorOf(kind, view.palette);
      const size = `${threeDigits(Math.hypot(x, y))} N`, from = camera.toPage(...at), text = named ? `${this.legend.nameOf(kind)} ${size}` : size;
      const width = some && !named ? NARROW : kind === 'sum' ? WIDE : USUAL;
      const to = this.#arrow(view, room, {from, x, y, scale: this.scales.N, color, text, width, unit: named || !some ? 'N' : '', named});
      // A number is told, whether or not its arrow is long enough to be drawn.
      if (!to && named) view.numbers.push({text, color, tip: kind === 'sum' ? [from[0], from[1] - BAR / 2] : from, along: [0, -1], named});
      this.drawn.push({name: bodies[row].name, kind, force: [x, y], size, from, to: to ?? from});
    }
    return some || few ? '' : t('Tap a body: its forces, and those of what touches it.');
  }

  /**
   * The torque of all forces on the selected body about its centre of mass, in the last frame.
   * @param {SceneView} view
   */
  #drawTorque(view) {
    const {world, camera, selection: {name}, records} = this.parts, row = world.row(name), sample = records.now(name);
    if (row < 0 || sample?.spinning === undefined || world.frame.time - sample.time > 2 / world.rate) return;
    const {moment, anchored} = world.scene.bodies[row], torque = moment * sample.spinning;
    if (anchored || this.legend.off.has('torque') || !(Math.abs(torque) > NO_TURN)) return;
    this.legend.addKinds(['torque']);
    this.scales['N m'].fit(Math.abs(torque), ARC, world.paused);
    this.#roundArrow(view, camera.toPage(...world.centerOf(row)), torque,
      {unit: 'N m', radius: ROUND, color: view.palette.ink, name: this.legend.nameOf('torque')});
  }

  /**
   * @param {SceneView} view
   * @param {Point} center [px]
   * @param {number} value counter-clockwise where it is positive [unit]
   * @param {{unit: 'N m' | 'N m s', radius: number, color: string, name?: string}} how
   */
  #roundArrow(view, center, value, {unit, radius, color, name = ''}) {
    const length = Math.min(this.scales[unit].length(Math.abs(value)), ARC);
    if (!(Math.abs(value) > NO_TURN && length >= LEAST)) return;
    const end = view.roundArrow(center, radius, Math.sign(value) * length / radius, color);
    view.numbers.push({text: `${name} ${threeDigits(Math.abs(value))} ${unit}`.trim(), color, ...end, named: name !== ''});
  }

  /**
   * @param {SceneView} view
   * @param {number} room [px]: a much longer arrow is cut
   * @param {Arrow} arrow
   * @returns {?Point} its tip [px]; null where the arrow is too short to be seen
   */
  #arrow(view, room, arrow) {
    const {from, x, y, scale, color, text, width = USUAL, unit = '', named = false} = arrow;
    const size = Math.hypot(x, y), whole = scale.length(size), most = CUT * room;
    if (!(whole >= LEAST)) return null;
    const length = Math.min(whole, most), ux = x / size, uy = -y / size;
    /** @type {Point} */
    const tip = [from[0] + ux * length, from[1] + uy * length];
    if (unit && this.legend.components && whole <= most) this.#components(view, room, arrow);
    view.arrow(from, tip, color, {width, cut: whole > most});
    view.numbers.push({text, color, from, tip, along: [ux, uy], named});
    return tip;
  }

  /**
   * @param {SceneView} view
   * @param {number} room [px]
   * @param {Arrow} arrow
   */
  #components(view, room, {from, x, y, scale, color, unit = ''}) {
    const [dx, dy] = [scale.length(x), -scale.length(y)];
    if (Math.min(Math.abs(dx), Math.abs(dy)) < LEAST || Math.hypot(dx, dy) > CUT * room) return;
    const {ctx} = view;
    ctx.setLineDash([4, 3]);
    for (const [ux, uy, value, name] of /** @type {[number, number, number, string][]} */ ([[dx, 0, x, 'x'], [0, dy, y, 'y']])) {
      const tip = /** @type {Point} */ ([from[0] + ux, from[1] + uy]);
      view.arrow(from, tip, color, {width: 1});
      view.numbers.push({text: `${name} ${threeDigits(value)} ${unit}`, color, from, tip, along: [Math.sign(ux), Math.sign(uy)]});
    }
    ctx.setLineDash([]);
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
 * Draw the constant forces of all bodies as arrows of one length, with the newtons of those on selected ones.
 * @param {Parts<'camera' | 'selection' | 'world'>} parts
 * @param {SceneView} view
 */
function drawApplied({world, camera, selection}, view) {
  const color = view.palette.applied;
  for (let row = 0; row < world.count; row++) {
    const {forces, name} = world.scene.bodies[row];
    for (const {at, force: [x, y]} of forces ? appliedTo(world, row) : []) {
      const size = Math.hypot(x, y), [px, py] = camera.toPage(...at);
      if (!size) continue;
      const along = /** @type {Point} */ ([x / size, -y / size]);
      const tip = /** @type {Point} */ ([px + LENGTH * along[0], py + LENGTH * along[1]]);
      view.arrow([px, py], tip, color);
      if (selection.names.has(name)) view.numbers.push({text: `${threeDigits(size)} N`, color, from: [px, py], tip, along, named: true});
    }
  }
}
