// SPDX-License-Identifier: Apache-2.0
/** Frames from bytes (docs/page_protocol.md): `frame_codec.py` encodes them. */

/** @import {Frame} from './types.js' */

const HEADER = 24; // bytes of a frame
const VERSION = 2;
const VELOCITIES = 1, CONTACTS = 2, FORCES = 4, HANDS = 8, GHOST = 16, PULLS = 32, SCAN = 64, FIELDS = 128; // flags of its columns

/**
 * @param {ArrayBuffer} buffer
 * @returns {Frame}
 */
export function decodeFrame(buffer) {
  const view = new DataView(buffer);
  if (view.getUint8(0) !== VERSION) throw new RangeError('another version of frames: load the page again');
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
    // As it was asked for: 0.1 is 0.10000000149 there.
    speed: Number(view.getFloat32(16, true).toPrecision(7)),
    ghost: (flags & GHOST) > 0,
    x: column(), y: column(), yaw: column(),
  };
  if (flags & VELOCITIES) frame.velocities = {x: column(), y: column(), spin: column()};
  if (flags & CONTACTS) {
    readCount();
    const steps = view.getUint32(at, true);
    at += 4;
    const rows = () => new Int32Array(buffer, (at += 4 * count) - 4 * count, count);
    frame.contacts = {steps, a: rows(), b: rows(), x: column(), y: column(), nx: column(), ny: column(),
      jx: column(), jy: column()};
  }
  if (flags & FORCES) {
    readCount();
    frame.forces = column();
  }
  if (flags & HANDS) {
    readCount();
    frame.hands = {x: column(), y: column(), toX: column(), toY: column()};
  }
  if (flags & PULLS) {
    readCount();
    frame.pulls = {x: column(), y: column()};
  }
  if (flags & SCAN) {
    readCount();
    frame.scan = {x: column(), y: column(), hit: column()};
  }
  if (flags & FIELDS) {
    count = frame.x.length;
    frame.fields = {x: column(), y: column()};
  }
  return frame;
}
