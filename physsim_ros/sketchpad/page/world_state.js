// SPDX-License-Identifier: Apache-2.0
/** The newest scene, frame and timeline of the server, and geometry in them. The page computes no motion. */

import {boundsOf, containsPoint, distanceTo, nearestWithin, unionOf} from './view/body_path.js';
import {ALONG_LINE, AT_POINT} from './joint_kinds.js';
import {ropeStops} from './rope_path.js';
import {distance, rotated} from './vectors.js';

/** @import {Body, Bounds, Connection, Frame, Point, Scene, Timeline} from './types.js' */

const HINGE = 0.35; // m: how far the symbol of a hinge on the background reaches

export class WorldState {
  /** @param {Connection} connection */
  constructor(connection) {
    this.connection = connection;
    /** @type {Scene} */
    this.scene = {epoch: -1, bodies: [], joints: [], gravity: [0, -9.81], bounds: [], damping: 0,
      density: 1, friction: 0.5, elasticity: 0.5,
      air_density: 0, air_viscosity: 0, wind: [0, 0], gusts: 0, gravitation: 0, coulomb: 0};
    /** Rows of its bodies, by their names. @type {Map<string, number>} */
    this.rows = new Map();
    /** @type {Frame} */
    this.frame = {epoch: -1, time: 0, speed: 0, ghost: false,
      x: new Float32Array(), y: new Float32Array(), yaw: new Float32Array()};
    /** @type {Timeline} */
    this.timeline = {state: 'paused', oldest: 0, now: 0, newest: 0, course: 0, line: 0, parts: 0, undo_text: ['', {}], redo_text: ['', {}],
      speed: 0, courses: []};
    /** @type {?Frame} of a course that was left, at the time that is shown */
    this.ghost = null;
    /** @type {{epoch: number, bodies: Body[]}} */
    this.ghostScene = {epoch: 0, bodies: []};
    this.rate = 60; // frames a second of simulation
    this.physicsRate = 240; // steps a second of simulation
    connection.on('welcome', (welcome) => {
      this.rate = welcome.rate;
      this.physicsRate = welcome.physics_rate;
    });
    connection.on('open', () => {
      // Another server numbers its scenes from the start.
      this.ghostScene = {epoch: 0, bodies: []};
      this.ghost = null;
    });
    connection.on('scene', (/** @type {Scene} */ scene) => {
      this.scene = scene;
      this.rows = new Map(scene.bodies.map(({name}, row) => [name, row]));
    });
    connection.on('timeline', (timeline) => { this.timeline = timeline; });
    connection.on('ghost', (ghost) => {
      this.ghostScene = ghost;
      this.ghost = null;
    });
    connection.on('ghost_frame', (frame) => { this.ghost = frame.epoch === this.ghostScene.epoch ? frame : null; });
    connection.on('frame', (frame) => { this.frame = frame; });
  }

  /** @returns {boolean} whether time stands still */
  get paused() {
    return this.frame.speed === 0;
  }

  /** @returns {{a: number, b: number}[]} rows of the bodies of each contact, as far as the frame has contacts; -1 is a wall */
  get touches() {
    const {contacts} = this.frame;
    return contacts ? Array.from(contacts.a, (a, i) => ({a, b: contacts.b[i]})) : [];
  }

  /** @returns {number} of bodies whose poses are known */
  get count() {
    return this.frame.epoch === this.scene.epoch ? this.frame.x.length : 0;
  }

  /**
   * @param {string} name
   * @returns {Body | undefined} as the scene has it
   */
  body(name) {
    return this.scene.bodies[this.rows.get(name) ?? -1];
  }

  /**
   * @param {string} name
   * @returns {number} its row; -1 where there is none of that name
   */
  row(name) {
    const row = this.rows.get(name) ?? -1;
    return row < this.count ? row : -1;
  }

  /**
   * @param {number} row -1 is the background
   * @param {Point} point in the frame of that body [m]
   * @returns {Point} in the world [m]
   */
  place(row, [x, y]) {
    if (row < 0 || row >= this.count) return [x, y];
    const [dx, dy] = rotated([x, y], this.frame.yaw[row]);
    return [this.frame.x[row] + dx, this.frame.y[row] + dy];
  }

  /** @type {(row: number) => Point} the centre of mass of a body [m] */
  centerOf(row) {
    return this.place(row, this.scene.bodies[row].centroid);
  }

  /**
   * @param {string} name of a body
   * @returns {?Point} its highest point [m]; null where there is none of that name
   */
  topOf(name) {
    const row = this.row(name);
    if (row < 0) return null;
    const [x] = this.centerOf(row);
    return [x, this.#boundsOf(row)[3]];
  }

  /**
   * @param {Iterable<string>} names of bodies
   * @returns {Bounds} of those that are there
   */
  boundsOfAll(names) {
    return unionOf([...names].map((name) => this.row(name)).filter((row) => row >= 0).map((row) => this.#boundsOf(row)));
  }

  /**
   * @param {Point} point [m]
   * @param {number} reach how near it counts [m]
   * @returns {number} height of the floor that is next to the point: the lower bound, or the upper edge of what is
   *   anchored; the height of the point where there is none [m]
   */
  floorBy([x, y], reach) {
    const {bounds, bodies} = this.scene, anchored = bodies.slice(0, this.count).flatMap((body, row) => body.anchored && !body.sensor ? [this.#boundsOf(row)] : []);
    const heights = [...bounds.slice(1, 2), ...anchored.filter(([left, , right]) => left <= x && x <= right).map((box) => box[3])];
    const far = (/** @type {number} */ height) => Math.abs(height - y);
    return heights.filter((height) => far(height) <= reach).sort((one, other) => far(one) - far(other))[0] ?? y;
  }

  /** @returns {Bounds[]} of the bodies that are kept in sight: all; of a lesson that has a view, those that move */
  get boxes() {
    const {bodies, lesson} = this.scene;
    return bodies.slice(0, this.count).flatMap(({anchored}, row) => lesson?.view && anchored ? [] : [this.#boundsOf(row)]);
  }

  /**
   * @param {Bounds} box
   * @returns {Bounds} of the bodies kept in sight that lie in it whole; infinite where there are none
   */
  boundsWithin([xmin, ymin, xmax, ymax]) {
    return unionOf(this.boxes.filter(([left, low, right, high]) => left >= xmin && low >= ymin && right <= xmax && high <= ymax));
  }

  /**
   * @param {Bounds} box
   * @returns {boolean} whether no body that moves reaches into it
   */
  isFree([xmin, ymin, xmax, ymax]) {
    return this.scene.bodies.slice(0, this.count).every(({anchored}, row) => {
      if (anchored) return true;
      const [left, low, right, high] = this.#boundsOf(row);
      return left > xmax || right < xmin || low > ymax || high < ymin;
    });
  }

  /**
   * @param {number} row
   * @returns {Bounds} of a body
   */
  #boundsOf(row) {
    return boundsOf(this.scene.bodies[row].shape, (point) => this.place(row, point));
  }

  /**
   * @param {Point} point [m]
   * @param {number} slop how far beside a body counts [m]
   * @returns {number} the row of the topmost body there, else of the topmost beside it, else of the water there; -1
   *   where there is none
   */
  bodyAt(point, slop = 0) {
    const {bodies} = this.scene;
    for (const [isWater, margin] of /** @type {const} */ ([[false, 0], [false, slop], [true, 0]])) {
      for (let row = this.count - 1; row >= 0; row--) {
        if (Boolean(bodies[row].medium) === isWater && containsPoint(bodies[row].shape, this.toBody(row, point), margin)) return row;
      }
    }
    return -1;
  }

  /**
   * @param {{at: Point, slop: number}} touch
   * @returns {string} the name of the body there; '' where there is none
   */
  nameAt({at, slop}) {
    return this.scene.bodies[this.bodyAt(at, slop)]?.name ?? '';
  }

  /**
   * @param {string} name of a body
   * @returns {Body | undefined} the robot of which it is a part
   */
  robotOf(name) {
    return this.scene.bodies.find(({robot}) => robot?.parts?.includes(name));
  }

  /**
   * @param {Point} point [m]
   * @param {number} reach how near it counts [m]
   * @param {boolean} onBody whether a body is there, which comes before lines
   * @returns {string} the name of the joint there; '' where there is none
   */
  jointAt(point, reach, onBody) {
    const near = this.scene.joints.filter((joint) => {
      const stops = ropeStops(this, joint).map(({at}) => at);
      if (AT_POINT.includes(joint.kind)) return distance(stops[0], point) <= reach;
      return !onBody && joint.kind !== 'gear' && distanceTo(stops, point) <= reach;
    });
    return near.at(-1)?.name ?? '';
  }

  /**
   * @param {number} row
   * @param {Point} point in the world [m]
   * @returns {Point} where a finger at or beside the body means it, in the frame of that body [m]
   */
  gripOn(row, point) {
    const {shape} = this.scene.bodies[row], local = this.toBody(row, point);
    return containsPoint(shape, local, 0) ? local : nearestWithin(shape, local);
  }

  /**
   * @param {number} row
   * @param {Point} point in the world [m]
   * @returns {Point} in the frame of that body [m]
   */
  toBody(row, [x, y]) {
    const {frame} = this;
    return rotated([x - frame.x[row], y - frame.y[row]], -frame.yaw[row]);
  }

  /** @returns {?Bounds} a square about the heaviest body that attracts the others, as they go around it; null where none does */
  #orbits() {
    const {scene: {bodies, gravitation}, frame: {x, y}} = this;
    if (!gravitation || !this.count) return null;
    const sun = bodies.reduce((heaviest, {mass}, row) => mass > bodies[heaviest].mass ? row : heaviest, 0);
    const reach = 1.1 * Math.max(...bodies.map((_, row) => Math.hypot(x[row] - x[sun], y[row] - y[sun])));
    return [x[sun] - reach, y[sun] - reach, x[sun] + reach, y[sun] + reach];
  }

  /**
   * @param {Bounds} box
   * @returns {Bounds[]} of the symbols of hinges on the background that are in the box: below an axle, beyond the end of a line
   */
  #hingesIn([left, low, right, high]) {
    const hinges = this.scene.joints.filter(({kind, b, points: [, [x, y]]}) => b < 0 && kind !== 'pin' && [...AT_POINT, ...ALONG_LINE].includes(kind) && left <= x && x <= right && low <= y && y <= high);
    return hinges.map(({a, points: [p, [x, y]]}) => {
      const [, from] = this.place(a, p);
      return from < y - HINGE / 2 ? [x, y, x, y + HINGE] : [x, y - HINGE, x, y];
    });
  }

  /** @returns {Bounds} of what a lesson shows first; of the world, or of its bodies, with the hinges in it */
  extent() {
    const {bounds, lesson} = this.scene, box = lesson?.view ?? (bounds.length ? bounds : this.#orbits() ?? unionOf(this.boxes));
    return box.every(Number.isFinite) ? unionOf([box, ...this.#hingesIn(box)]) : [-6, -1, 6, 6];
  }
}

/**
 * What the world has of a value that changes only as a whole, with what was said of it since the last scene: of two
 * changes in a row, none undoes the other.
 * @template T
 * @param {WorldState} world
 * @param {() => T} read
 */
export function latest(world, read) {
  let said = read(), {scene} = world;
  return {
    now: () => world.scene === scene ? said : read(),
    say: (/** @type {T} */ value) => {
      scene = world.scene;
      return said = value;
    },
  };
}
