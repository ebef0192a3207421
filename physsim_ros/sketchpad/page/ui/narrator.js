// SPDX-License-Identifier: Apache-2.0
/** What happens, for screen readers: the list of bodies, and sentences about what moves. */

import {createElement, elementOf, showText} from '../dom.js';
import {fixed} from '../rounding.js';
import {t} from '../strings.js';
import {shapeWord} from '../words.js';

/** @import {Parts} from '../types.js' */

const PERIOD = 1500; // ms between two announcements
const LISTED = 200, LIST_EVERY = 1000; // bodies that are listed, and ms from list to list
const TOLD = 3; // sentences of an announcement, the newest ones
const APART = 0.25; // s without a touch after which a pair touches anew
const MOVES = 0.05, RESTS = 0.02; // m/s: faster is motion, slower rest
const STILL = 0.5; // s of rest after which it is told

/** @typedef {{moves: boolean, since: number}} Followed since: when the body was faster than a body at rest [s] */

export class Narrator {
  /** @param {Parts<'connection' | 'selection' | 'settings' | 'words' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.line = elementOf('moves');
    this.time = 0; // of the last frame [s]
    /** @type {Map<string, number>} when pairs of bodies touched last [s] */
    this.touched = new Map();
    /** @type {Map<string, Followed>} by name of the body */
    this.motions = new Map();
    /** @type {string[]} */
    this.sentences = [];
    this.timer = 0;
    parts.connection.on('frame', () => this.#follow());
    parts.connection.on('world', () => this.#forget());
    setInterval(() => this.#listBodies(), LIST_EVERY);
  }

  #forget() {
    this.touched.clear();
    this.motions.clear();
  }

  #follow() {
    const {world, selection, settings} = this.parts, {frame: {time, velocities}, scene: {bodies}} = world;
    // What was told of a time lies ahead again after a rewind.
    if (time < this.time) this.#forget();
    const later = time > this.time;
    this.time = time;
    if (!later || !velocities || !selection.names.size && !settings.speaks) return;
    const rows = new Set();
    for (let row = 0; row < world.count; row++) {
      const {name, anchored} = bodies[row];
      if (anchored || selection.names.size && !selection.names.has(name)) continue;
      rows.add(row);
      this.#followBody(row, Math.hypot(velocities.x[row], velocities.y[row]));
    }
    this.#followTouches(rows);
  }

  /**
   * @param {number} row
   * @param {number} speed [m/s]
   */
  #followBody(row, speed) {
    const {world, words} = this.parts, {name} = world.scene.bodies[row], time = fixed(this.time, 1);
    const motion = this.motions.get(name) ?? {moves: speed > MOVES, since: this.time};
    this.motions.set(name, motion);
    if (speed > RESTS) motion.since = this.time;
    if (!motion.moves && speed > MOVES) {
      motion.moves = true;
      this.#announce(t('{name} moves at {time} s', {name: words.item(name), time}));
    } else if (motion.moves && this.time - motion.since > STILL) {
      motion.moves = false;
      const [x, y] = world.centerOf(row);
      this.#announce(t('{name} rests at {x}, {y} m, at {time} s', {name: words.item(name), x: fixed(x, 1), y: fixed(y, 1), time}));
    }
  }

  /** @param {Set<number>} rows of the bodies that are followed */
  #followTouches(rows) {
    const {world: {touches, scene: {bodies}}, words} = this.parts;
    for (const {a, b} of touches) {
      const [one, other] = rows.has(a) ? [a, b] : [b, a];
      if (!rows.has(one)) continue;
      const pair = `${bodies[one].name} ${bodies[other]?.name}`, before = this.touched.get(pair) ?? -Infinity;
      this.touched.set(pair, this.time);
      if (this.time - before < APART) continue;
      this.#announce(t('{name} touches {other} at {time} s', {name: words.item(bodies[one].name),
        other: bodies[other] ? words.item(bodies[other].name) : t('a wall'), time: fixed(this.time, 1)}));
    }
  }

  /** List the bodies, with their places now. */
  #listBodies() {
    const {world} = this.parts, {bodies} = world.scene;
    const texts = bodies.slice(0, LISTED).map((body, row) => {
      const {name, anchored, label} = body, [x, y] = world.place(row, [0, 0]);
      return [`${name}: ${shapeWord(body)}${label && ` ${label}`}`, ...anchored ? [t('anchored')] : [],
        t('at {x}, {y} m', {x: fixed(x, 1), y: fixed(y, 1)})].join(', ');
    });
    if (bodies.length > LISTED) texts.push(t('and {count} more', {count: bodies.length - LISTED}));
    const list = elementOf('list');
    while (list.children.length > texts.length) list.lastChild?.remove();
    texts.forEach((text, i) => {
      showText(/** @type {HTMLElement} */ (list.children[i] ?? list.appendChild(createElement('li'))), text);
    });
  }

  /** @param {string} sentence */
  #announce(sentence) {
    this.sentences.push(sentence);
    this.timer ||= setTimeout(() => {
      this.timer = 0;
      this.line.textContent = this.sentences.splice(0).slice(-TOLD).join('. ');
    }, this.line.textContent ? PERIOD : 0);
  }
}
