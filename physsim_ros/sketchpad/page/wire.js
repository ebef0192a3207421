// SPDX-License-Identifier: Apache-2.0
/** Frames of the server, decoded (docs/page_protocol.md). */

/** @import {Frame} from './types.js' */

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
