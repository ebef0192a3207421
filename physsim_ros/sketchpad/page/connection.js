// SPDX-License-Identifier: Apache-2.0
/**
 * The socket to the server: sends requests, hands on messages by type, connects again (docs/page_protocol.md).
 *
 * Laws: a request that the server has not received is sent again when the page is back, or told to be lost; the ids of
 * what a server receives ascend, so that the last one tells what it has. A socket that is silent is asked whether it
 * lives: a network that went, or a machine that slept, closes none.
 */

import {Emitter} from './emitter.js';
import {decodeFrame} from './frame_codec.js';

/** @import {Answer, Frame} from './types.js' */

const PERSON = 'physsim-person'; // key with which this tab is the same person again
const REPLACED = 4000; // code of closing: another tab came with that key
/** Topics of requests after which another world is there: what belonged to the one before ends. */
const ENDS = ['~/load_world', '~/clear'];
const SHORTEST_PAUSE = 250, LONGEST_PAUSE = 3000; // ms between attempts to connect
const TICK = 500; // ms between two looks whether something has come; a browser has fewer of a hidden page
/** Ticks of silence after which the server is asked, the page says so, and it connects anew. */
const ASKS = 1, WARNS = 6, LEAVES = 15;
const REACHED = 3000; // ms within which a server that is there answers a request
/** Messages that mean the same in a while: they wait for a server, and are sent again where they were not received. */
const AGAIN = ['stroke', 'spawn', 'change', 'change_joint', 'delete', 'unjoin', 'copy_machine', 'move_bodies', 'place', 'answered', 'say'];
const LASTING = 60000; // ms for which they do
/** Messages that have no answer, or that nobody misses. */
export const PASSING = ['show', 'here', 'move', 'watch', 'drive', 'let_go', 'drop', 'list', 'ping', 'person', 'draw_with', 'raise_hand', 'follow'];

/**
 * Events: messages by their type in the protocol; frame, ghost_frame, open, silent, heard, closed, sent, unsent, again,
 * world; any: each of these.
 */
export class Connection extends Emitter {
  /** @param {string} path of the socket on the server */
  constructor(path = '/ws') {
    super();
    this.path = path;
    /** @type {Map<string, (answer: Answer) => void>} */
    this.waiting = new Map();
    this.number = 0;
    /** @type {Map<string, {message: {id: string, type: string}, at: number, sent: boolean}>} not answered, by id; at: when they were made [ms] */
    this.unanswered = new Map();
    this.expired = 0; // count of those that waited for a server too long
    this.pause = SHORTEST_PAUSE;
    this.silence = 0; // ticks since the last message
    this.opened = false; // whether the last socket was open at all
    this.welcomed = false; // whether the server has told over the socket what it has received: nothing is sent before
    this.line = 0; // number of the line of events that the last timeline told of
    setInterval(() => this.#watch(), TICK);
    /** @type {?WebSocket} */
    this.socket = null;
    /** That has come before its first frame. @type {?{epoch: number}} */
    this.scene = null;
    this.epoch = -1; // of the scene that was handed on
    // Only of the world of this page.
    if (path === '/ws') this.on('welcome', ({person}) => sessionStorage.setItem(PERSON, person));
  }

  connect() {
    const query = new URLSearchParams(location.search);
    query.set('person', sessionStorage.getItem(PERSON) ?? '');
    // A page that is loaded anew has another clock, no material, and no stroke in mind.
    if (this.number) query.set('again', '');
    this.silence = 0;
    this.opened = this.welcomed = false;
    this.socket = new WebSocket(`${location.protocol.replace('http', 'ws')}//${location.host}${this.path}?${query}`);
    this.socket.binaryType = 'arraybuffer';
    this.socket.onopen = () => { this.opened = true; };
    this.socket.onmessage = ({data}) => this.#receive(data);
    this.socket.onclose = ({code}) => {
      if (code === REPLACED) sessionStorage.removeItem(PERSON);
      this.#retry();
    };
  }

  /**
   * @param {string} type
   * @param {Record<string, unknown>} fields
   * @returns {string} the id of the request; '' without a connection, for which it does not wait
   */
  send(type, fields = {}) {
    if (!this.#isOpen && !AGAIN.includes(type)) {
      if (!PASSING.includes(type)) this.emit('unsent', {type, ...fields});
      return '';
    }
    const message = {id: String(++this.number), type, ...fields};
    if (!PASSING.includes(type)) this.unanswered.set(message.id, {message, at: Date.now(), sent: false});
    if (this.#isOpen) this.#sendOut(message);
    else this.#dropExpired();
    return message.id;
  }

  /** @param {{id: string, type: string}} message */
  #sendOut(message) {
    this.socket?.send(JSON.stringify(message));
    const request = this.unanswered.get(message.id);
    if (request) request.sent = true;
    this.emit('sent', message);
  }

  /** Drop what has waited for a server too long. */
  #dropExpired() {
    for (const [id, {at}] of this.unanswered) {
      if (Date.now() - at < LASTING) return;
      this.unanswered.delete(id);
      this.expired++;
    }
  }

  /**
   * Send again what the server has not received over the sockets before.
   * @param {string} received the last message that it has; '' where it does not know this page, as it was started anew: it
   *   gets the strokes that were drawn without a server
   * @returns {{sent: number, lost: number}} how many messages, and how many are not sent
   */
  #sendAgain(received) {
    this.#dropExpired();
    let sent = 0, lost = this.expired;
    this.expired = 0;
    for (const [id, {message, sent: wasSent}] of this.unanswered) {
      const missed = !received || Number(id) > Number(received);
      if (missed && (received ? AGAIN.includes(message.type) : message.type === 'stroke' && !wasSent)) {
        this.#sendOut(message);
        sent++;
      } else {
        this.unanswered.delete(id);
        if (missed) lost++;
      }
    }
    for (const id of this.waiting.keys()) if (!this.unanswered.has(id)) this.waiting.delete(id);
    return {sent, lost};
  }

  get #isOpen() {
    return this.welcomed && this.socket?.readyState === WebSocket.OPEN;
  }

  /** Ask a silent server whether it is there, tell that it does not answer, and connect anew. */
  #watch() {
    if (!this.socket) return;
    this.silence++;
    if (this.silence === ASKS && this.#isOpen) this.send('ping');
    if (this.silence === WARNS) this.emit('silent');
    if (this.silence < LEAVES) return;
    this.#drop();
    this.#retry();
  }

  /** Close the socket, and hear nothing of it any more. */
  #drop() {
    if (!this.socket) return;
    this.socket.onclose = this.socket.onmessage = this.socket.onopen = null;
    this.socket.close();
    this.socket = null;
  }

  /** Leave the world for good: who comes back in this tab is another person. */
  leave() {
    this.#drop();
    sessionStorage.removeItem(PERSON);
  }

  /**
   * @param {string} type
   * @param {Record<string, unknown>} fields
   * @returns {Promise<Answer>} never settles where the connection is lost before, and it is not sent again
   */
  ask(type, fields = {}) {
    const id = this.send(type, fields);
    return new Promise((resolve) => id && this.waiting.set(id, resolve));
  }

  /**
   * Open a world, whose clock begins at 0.
   * @param {string} name
   * @returns {Promise<boolean>} whether it is open
   */
  async openWorld(name) {
    return (await this.ask('open', {name})).ok;
  }

  /**
   * Open a lesson, paused.
   * @param {string} name
   * @returns {Promise<boolean>} whether it is open
   */
  openLesson(name) {
    this.send('service', {name: 'pause'});
    return this.openWorld(name);
  }

  /** @param {string | ArrayBuffer} data */
  #receive(data) {
    if (this.silence >= WARNS) this.emit('heard');
    this.silence = 0;
    if (typeof data !== 'string') {
      // Only a frame tells that the server keeps a socket open: until then the pauses grow.
      this.pause = SHORTEST_PAUSE;
      const frame = decodeFrame(data);
      if (frame.ghost) this.emit('ghost_frame', frame);
      else this.#takeFrame(frame);
      return;
    }
    const message = JSON.parse(data);
    if (message.type === 'scene') {
      this.scene = message;
      return;
    }
    if (message.type === 'welcome') {
      this.welcomed = true;
      const again = this.#sendAgain(message.received);
      this.emit('open');
      if (again.sent + again.lost) this.emit('again', again);
    }
    if (message.type === 'answer') {
      this.unanswered.delete(message.request);
      this.waiting.get(message.request)?.(message);
      this.waiting.delete(message.request);
    }
    this.emit(message.type, message);
    if (message.type === 'timeline') this.#followLine(message);
    if (message.type === 'answer' && message.ok && ENDS.includes(message.topic)) this.emit('world', message);
  }

  /**
   * Hand on a frame after its scene, whose bodies are nowhere without it; drop one of another scene.
   * @param {Frame} frame
   */
  #takeFrame(frame) {
    if (this.scene?.epoch === frame.epoch) {
      this.epoch = frame.epoch;
      this.emit('scene', this.scene);
      this.scene = null;
    }
    if (frame.epoch === this.epoch) this.emit('frame', frame);
  }

  /** @param {{line: number, parts: number}} timeline */
  #followLine({line, parts}) {
    if (line === this.line) return;
    // Where it missed one, it does not know since when.
    const since = line === this.line + 1 ? parts : 0;
    this.line = line;
    this.emit('line', {since});
  }

  /**
   * @param {string} type
   * @param {any} message
   */
  emit(type, message = null) {
    for (const each of [type, 'any']) super.emit(each, message);
  }

  /**
   * Connect again after a pause. A refused socket has no reason, so that the cookie is checked by a request; and
   * browsers delay the sockets of a page more and more that tried many in vain, so that a server that is gone is
   * asked by requests alone.
   * @param {boolean} wasGone whether the server was not reachable before
   */
  async #retry(wasGone = false) {
    this.socket = this.scene = null;
    const status = await fetch('/session', {cache: 'no-store', signal: AbortSignal.timeout(REACHED)}).then(
      (response) => response.status, () => 0);
    if (status && wasGone) {
      this.connect();
      return;
    }
    this.emit('closed', {status, opened: this.opened});
    setTimeout(() => status ? this.connect() : this.#retry(true), this.pause);
    this.pause = Math.min(2 * this.pause, LONGEST_PAUSE);
  }
}
