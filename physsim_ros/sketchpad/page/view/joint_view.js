// SPDX-License-Identifier: Apache-2.0
/** Joints as what they are: coil, rod, rope, axle, motor, rail, toothed wheels. */

import {boundsOf} from './body_path.js';
import {ALONG_AXIS, AT_POINT} from '../joint_kinds.js';
import {ropeHeadings, ropeStops} from '../rope_path.js';
import {distance, rotated} from '../vectors.js';

/** @import {Joint, Point, SceneView} from '../types.js' */

const SIZE = 0.12; // m: half of a symbol
const LEAST = 4, GREATEST = 14; // px, whatever the zoom
// symbols: made by `make tables`
const COILS = 8, SPIRAL = 3, TEETH = 10, TRACK = 8;
// end: made by `make tables`
const TENSE = 10; // weights at which a joint is drawn in the colour of warning

export class JointView {
  /** @param {SceneView} view whose canvas is in pixels of the page */
  constructor(view) {
    this.view = view;
    this.ctx = view.ctx;
    this.world = view.world;
    this.camera = view.camera;
    this.size = 0; // of symbols now [px]
  }

  draw() {
    const {ctx, world, camera, view: {palette}} = this;
    ctx.lineJoin = ctx.lineCap = 'round';
    const gravity = Math.hypot(...world.scene.gravity) || 9.81;
    world.scene.joints.forEach((joint, number) => {
      const weight = gravity * Math.max(...[joint.a, joint.b].map(
        (row) => world.scene.bodies[row]?.mass ?? 0), 1e-6);
      const share = (world.frame.forces?.[number] ?? 0) / (TENSE * weight);
      ctx.strokeStyle = share > 1 ? palette.warn : share > 1 / 3 ? palette.force : palette.ink;
      ctx.fillStyle = palette.paper;
      ctx.lineWidth = 2;
      this.size = Math.max(Math.min(SIZE * camera.scale, GREATEST, this.#roomFor(joint)), LEAST);
      this.#drawJoint(joint);
    });
  }

  /** @param {Joint} joint */
  #drawJoint(joint) {
    const {world, size} = this;
    const p = this.#page(world.place(joint.a, joint.points[0]));
    const q = this.#page(world.place(joint.b, joint.points[1]));
    const ground = joint.b < 0;
    switch (joint.kind) {
      case 'pin':
        this.view.polyline([[p[0] - size, p[1] - size], [p[0] + size, p[1] + size]]);
        this.view.polyline([[p[0] - size, p[1] + size], [p[0] + size, p[1] - size]]);
        break;
      case 'motor':
        this.#arc(p, 1.9 * size, joint.rate ?? 1);
      // falls through: a motor is an axle that drives
      case 'axle':
        if (ground) this.#support(p);
        // Its circle would cover the links of a chain.
        if (ground || this.#roomFor(joint) > size) this.#circle(p, size);
        this.#dot(p);
        if (joint.stiffness) this.#spiral(p, world.frame.yaw[joint.a]);
        break;
      case 'spring':
        this.view.polyline(coil(p, q, size));
        this.#ends(p, q, ground);
        break;
      case 'rod':
        this.ctx.lineWidth = size * 0.7;
        this.view.polyline([p, q]);
        this.ctx.lineWidth = 2;
        this.#ends(p, q, ground);
        break;
      case 'rope':
        if (joint.guides) this.#path(joint);
        // A winch keeps its rope taut.
        else this.#rope(p, q, joint.rate ? 0 : joint.rest_length * this.camera.scale);
        this.#ends(p, q, ground);
        break;
      case 'slider':
        this.#rail(joint, p, q);
        break;
      case 'gear':
        this.#wheel(joint.a);
        this.#wheel(joint.b);
        break;
      case 'rack':
        this.#wheel(joint.a);
        this.#teeth(joint, q);
        break;
      default:
        this.view.polyline([p, q]);
        this.#ends(p, q, ground);
    }
  }

  /**
   * @param {Joint} joint
   * @returns {number} half of the size for which its bodies have room [px]: the larger one, but a robot's parts each
   */
  #roomFor({kind, a, b}) {
    // The symbol of these lies on their bodies.
    if (![...AT_POINT, ...ALONG_AXIS].includes(kind)) return Infinity;
    const {bodies} = this.world.scene;
    const rooms = [a, b].filter((row) => row >= 0).map((row) => this.view.bodies.appearance(bodies[row]).inner * this.camera.scale);
    return Math.max(...rooms);
  }

  /** @param {Point} point [m] */
  #page(point) {
    return this.camera.toPage(...point);
  }

  /**
   * @param {Point} center
   * @param {number} radius
   */
  #circle([x, y], radius) {
    this.ctx.beginPath();
    this.ctx.arc(x, y, radius, 0, 2 * Math.PI);
    this.ctx.fill();
    this.ctx.stroke();
  }

  /** @param {Point} center */
  #dot([x, y]) {
    this.ctx.fillStyle = this.ctx.strokeStyle;
    this.ctx.beginPath();
    this.ctx.arc(x, y, this.size / 3, 0, 2 * Math.PI);
    this.ctx.fill();
  }

  /**
   * @param {Point} center of a torsion spring
   * @param {number} yaw of the body that it turns with [rad]
   */
  #spiral([x, y], yaw) {
    /** @type {Point[]} */
    const points = [];
    for (let angle = 0; angle <= SPIRAL * 2 * Math.PI; angle += Math.PI / 8) {
      const reach = this.size * (1 + angle / (4 * Math.PI));
      points.push([x + reach * Math.cos(angle + yaw), y - reach * Math.sin(angle + yaw)]);
    }
    this.view.polyline(points);
  }

  /**
   * @param {Point} p
   * @param {Point} q
   * @param {boolean} ground whether q is on the background
   */
  #ends(p, q, ground) {
    this.#circle(p, this.size / 2);
    if (ground) this.#support(q, p[1]);
    this.#circle(q, this.size / 2);
  }

  /**
   * The support of a joint to the background: a triangle on hatched ground.
   * @param {Point} point
   * @param {number} fromY where the joint comes from; the support lies on the other side
   */
  #support([x, y], fromY = y - 1) {
    const s = this.size, up = fromY > y ? -s : s, base = y + 2.2 * up;
    this.view.polyline([[x, y], [x - 1.3 * s, base], [x + 1.3 * s, base], [x, y]]);
    for (const dx of [-1.2, -0.3, 0.6, 1.5]) {
      this.view.polyline([[x + dx * s, base], [x + (dx - 0.6) * s, base + 0.7 * up]]);
    }
  }

  /**
   * @param {Point} center
   * @param {number} radius
   * @param {number} rate counter-clockwise where it is positive [rad/s]
   */
  #arc([x, y], radius, rate) {
    const turn = -Math.sign(rate) || -1, s = radius / 2.5;
    this.ctx.beginPath();
    this.ctx.arc(x, y, radius, 0, turn * 1.5 * Math.PI, turn < 0);
    this.ctx.stroke();
    const tip = y - turn * radius;
    this.view.polyline([[x - s, tip - s], [x, tip], [x - s, tip + s]]);
  }

  /**
   * @param {Point} p
   * @param {Point} q
   * @param {number} length [px]
   */
  #rope(p, q, length) {
    const span = distance(p, q);
    // Depth of a shallow arc of that length: https://en.wikipedia.org/wiki/Parabola#Arc_length
    const depth = Math.sqrt(3 / 8 * Math.max(0, length - span) * length);
    this.ctx.beginPath();
    this.ctx.moveTo(...p);
    this.ctx.quadraticCurveTo((p[0] + q[0]) / 2, (p[1] + q[1]) / 2 + 2 * depth, ...q);
    this.ctx.stroke();
  }

  /** @param {Joint} joint a rope past its guides */
  #path(joint) {
    const {ctx, world} = this, stops = ropeStops(world, joint), headings = ropeHeadings(stops);
    ctx.beginPath();
    stops.forEach(({at, radius}, number) => {
      const [x, y] = this.#page(at), r = Math.abs(radius) * this.camera.scale, side = Math.sign(radius);
      if (!r) ctx.lineTo(x, y);
      // The centre of a wheel that the rope runs around counter-clockwise is on its left.
      else ctx.arc(x, y, r, side * Math.PI / 2 - headings[number - 1], side * Math.PI / 2 - headings[number], side > 0);
    });
    ctx.stroke();
    for (const {at, radius} of stops.slice(1, -1)) if (!radius) this.#circle(this.#page(at), this.size / 2);
  }

  /**
   * @param {Joint} joint
   * @param {Point} p the block
   * @param {Point} q the seat of the rail
   */
  #rail({axis: [ux, uy], b, lower, upper}, p, q) {
    const yaw = b < 0 ? 0 : this.world.frame.yaw[b], scale = this.camera.scale, s = this.size;
    const [dx, up] = rotated([ux, uy], yaw), dy = -up;
    /** @type {(along: number, across: number, from?: Point) => Point} */
    const at = (along, across, from = q) => [from[0] + along * dx - across * dy,
      from[1] + along * dy + across * dx];
    const least = (lower ?? -TRACK * SIZE) * scale, most = (upper ?? TRACK * SIZE) * scale;
    this.ctx.save();
    // Nothing slides beyond the bounds of the world.
    this.ctx.clip(this.view.boundsPath());
    this.view.polyline([at(least, 0), at(most, 0)]);
    if (lower !== undefined) this.view.polyline([at(least, -s), at(least, s)]);
    if (upper !== undefined) this.view.polyline([at(most, -s), at(most, s)]);
    this.ctx.restore();
    this.ctx.beginPath();
    for (const [u, v] of [[1.5, 0.8], [-1.5, 0.8], [-1.5, -0.8], [1.5, -0.8]]) {
      this.ctx.lineTo(...at(u * s, v * s, p));
    }
    this.ctx.closePath();
    this.ctx.fill();
    this.ctx.stroke();
  }

  /**
   * @param {Joint} rack whose teeth are as long as its bar
   * @param {Point} q where they begin
   */
  #teeth({axis: [ux, uy], b, points: [, [sx, sy]], rest_length: radius}, [x, y]) {
    const {scene: {bodies}, frame} = this.world, scale = this.camera.scale;
    const [dx, dy] = rotated([ux, uy], b < 0 ? 0 : frame.yaw[b]), pitch = 2 * Math.PI * radius / TEETH;
    const [least, , most] = b < 0 ? [-TEETH * pitch, 0, TEETH * pitch] :
      boundsOf(bodies[b].shape, (point) => rotated([point[0] - sx, point[1] - sy], -Math.atan2(uy, ux)));
    /** @type {Point[]} */
    const points = [];
    for (let i = Math.ceil(4 * least / pitch); i <= 4 * most / pitch; i++) {
      const along = i * pitch / 4 * scale, down = (i & 2 ? -0.15 : 0.15) * pitch * scale;
      points.push([x + along * dx + down * dy, y - along * dy + down * dx]);
    }
    this.view.polyline(points);
  }

  /** @param {number} row a body with teeth, which turn with it */
  #wheel(row) {
    if (row < 0) return;
    const {shape} = this.world.scene.bodies[row], yaw = this.world.frame.yaw[row];
    const [x, y] = this.#page(this.world.centerOf(row));
    const radius = (shape.radius ?? 2 * SIZE) * 0.7 * this.camera.scale, tooth = Math.PI / TEETH / 2;
    /** @type {Point[]} */
    const points = [];
    for (let i = 0; i <= 4 * TEETH; i++) {
      const reach = radius * (i & 2 ? 1.1 : 0.9), angle = i * tooth - yaw;
      points.push([x + reach * Math.cos(angle), y + reach * Math.sin(angle)]);
    }
    this.view.polyline(points);
  }
}

/**
 * @param {Point} p
 * @param {Point} q
 * @param {number} size
 * @returns {Point[]} a zigzag with straight ends
 */
function coil(p, q, size) {
  const dx = q[0] - p[0], dy = q[1] - p[1], length = Math.hypot(dx, dy) || 1;
  /** @type {Point[]} */
  const points = [p];
  for (let i = 0; i <= 2 * COILS; i++) {
    const along = 0.1 + 0.8 * i / (2 * COILS);
    const across = i % (2 * COILS) ? size * (i % 2 ? 1 : -1) / length : 0;
    points.push([p[0] + along * dx - across * dy, p[1] + along * dy + across * dx]);
  }
  return [...points, q];
}
