// SPDX-License-Identifier: Apache-2.0
/** The socket to the server: requests out with an id, messages in by type, and back when it goes (docs/page_protocol.md). */

/** @import {Answer, Frame} from './types.js' */

const SHORTEST_PAUSE = 250, LONGEST_PAUSE = 3000; // ms between attempts to connect
const HEADER = 24; // bytes of a frame
const VERSION = 2;
const VELOCITIES = 1, CONTACTS = 2, FORCES = 4, HANDS = 8, GHOST = 16, PULLS = 32; // flags of its parts

export class Connection {
  constructor() {
    /** @type {Map<string, ((message: any) => void)[]>} */
    this.listeners = new Map();
    /** @type {Map<string, (answer: Answer) => void>} */
    this.waiting = new Map();
    this.number = 0;
    this.pause = SHORTEST_PAUSE;
    /** @type {?WebSocket} */
    this.socket = null;
  }

  /**
   * @param {string} type of messages: one of the protocol, or frame, open, closed, sent, unsent
   * @param {(message: any) => void} listener
   */
  on(type, listener) {
    this.listeners.set(type, [...this.listeners.get(type) ?? [], listener]);
  }

  connect() {
    const address = `${location.protocol.replace('http', 'ws')}//${location.host}/ws`;
    this.socket = new WebSocket(address + location.search);
    this.socket.binaryType = 'arraybuffer';
    this.socket.onopen = () => this.#emit('open', null);
    this.socket.onmessage = ({data}) => this.#receive(data);
    this.socket.onclose = () => this.#retry();
  }

  /**
   * @param {string} type
   * @param {Record<string, unknown>} fields
   * @returns {string} the id of the request; '' where nobody hears it
   */
  send(type, fields = {}) {
    if (this.socket?.readyState !== WebSocket.OPEN) {
      this.#emit('unsent', {type, ...fields});
      return '';
    }
    const message = {id: String(++this.number), type, ...fields};
    this.socket.send(JSON.stringify(message));
    this.#emit('sent', message);
    return message.id;
  }

  /**
   * @param {string} type
   * @param {Record<string, unknown>} fields
   * @returns {Promise<Answer>} never settles where the server goes
   */
  ask(type, fields = {}) {
    const id = this.send(type, fields);
    return new Promise((resolve) => id && this.waiting.set(id, resolve));
  }

  /** @param {string | ArrayBuffer} data */
  #receive(data) {
    if (typeof data !== 'string') {
      // A server that closes each socket again is asked ever less often.
      this.pause = SHORTEST_PAUSE;
      this.#emit('frame', decodeFrame(data));
      return;
    }
    const message = JSON.parse(data);
    if (message.type === 'answer' && this.waiting.has(message.request)) {
      this.waiting.get(message.request)?.(message);
      this.waiting.delete(message.request);
    }
    this.#emit(message.type, message);
  }

  /**
   * @param {string} type
   * @param {any} message
   */
  #emit(type, message) {
    for (const listener of this.listeners.get(type) ?? []) listener(message);
  }

  /** A socket that is refused cannot say why: whether the cookie is right is asked for. */
  async #retry() {
    this.socket = null;
    this.waiting.clear();
    const status = await fetch('/session', {cache: 'no-store'}).then(
      (response) => response.status, () => 0);
    this.#emit('closed', status);
    setTimeout(() => this.connect(), this.pause);
    this.pause = Math.min(2 * this.pause, LONGEST_PAUSE);
  }
}

/**
 * @param {ArrayBuffer} buffer
 * @returns {Frame}
 */
function decodeFrame(buffer) {
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
    speed: view.getFloat32(16, true),
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
  return frame;
}
