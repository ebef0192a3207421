// SPDX-License-Identifier: Apache-2.0
/** The messages of the server (docs/page_protocol.md): their types, and frames decoded. */

/** @typedef {[number, number]} Point x, y [m]; on the page [px] */
/** @typedef {{kind: string, radius: number, center?: Point, outline: Point[], points: Point[], thickness: number,
 *   pieces: Shape[]}} Shape of a body, in its frame [m]; the fields are those of its kind */
/** @typedef {{name: string, shape: Shape, color: number[], anchored: boolean, kinematic: boolean,
 *   sensor: boolean, mass: number, moment: number, density: number, friction: number,
 *   elasticity: number, centroid: Point}} Body */
/** @typedef {{name: string, kind: string, a: number, b: number, points: Point[], axis: Point,
 *   rest_length: number, lower?: number, upper?: number, rate?: number}} Joint
 *   a, b: rows of its bodies, -1 the background */
/** @typedef {{epoch: number, bodies: Body[], joints: Joint[], gravity: Point, bounds: number[],
 *   damping: number}} Scene */
/** @typedef {{id: number, from: number, to: number}} Course that was left, from .. to [s] */
/** @typedef {{state: string, oldest: number, now: number, newest: number, course: number,
 *   undo: string, redo: string, speed: number, courses?: Course[]}} Timeline */
/** @typedef {{request: string, ok: boolean, code: string, message: string, subject: string,
 *   topic: string,
 *   values: Record<string, string>}} Answer */
/** @typedef {{request: string, meaning: string, confidence: number, runner_up: string,
 *   runner_up_confidence: number, guesses: [string, number][], outline: Point[],
 *   built: boolean}} Reading of a stroke */
/**
 * The state of the world after a step, a column for each quantity; rows as in the scene.
 * @typedef {{epoch: number, time: number, speed: number, ghost: boolean,
 *   x: Float32Array, y: Float32Array, yaw: Float32Array,
 *   velocities?: {x: Float32Array, y: Float32Array, spin: Float32Array},
 *   contacts?: {x: Float32Array, y: Float32Array, nx: Float32Array, ny: Float32Array,
 *     impulse: Float32Array},
 *   forces?: Float32Array,
 *   hands?: {x: Float32Array, y: Float32Array, toX: Float32Array, toY: Float32Array}}} Frame
 */

const HEADER = 24; // bytes
const VELOCITIES = 1, CONTACTS = 2, FORCES = 4, HANDS = 8, GHOST = 16;

/**
 * @param {ArrayBuffer} buffer
 * @returns {Frame}
 */
export function decodeFrame(buffer) {
  const view = new DataView(buffer);
  if (view.getUint8(0) !== 1) throw new RangeError('this page is older than the server: reload it');
  const flags = view.getUint8(1);
  let at = HEADER, count = view.getUint32(20, true);
  const column = () => {
    at += 4 * count;
    return new Float32Array(buffer, at - 4 * count, count);
  };
  const readCount = () => {
    count = view.getUint32(at, true);
    at += 4;
  };
  /** @type {Frame} */
  const frame = {
    epoch: view.getUint32(4, true),
    time: view.getFloat64(8, true),
    speed: view.getFloat32(16, true),
    ghost: (flags & GHOST) > 0,
    x: column(), y: column(), yaw: column(),
  };
  if (flags & VELOCITIES) frame.velocities = {x: column(), y: column(), spin: column()};
  if (flags & CONTACTS) {
    readCount();
    frame.contacts = {x: column(), y: column(), nx: column(), ny: column(), impulse: column()};
  }
  if (flags & FORCES) {
    readCount();
    frame.forces = column();
  }
  if (flags & HANDS) {
    readCount();
    frame.hands = {x: column(), y: column(), toX: column(), toY: column()};
  }
  return frame;
}
