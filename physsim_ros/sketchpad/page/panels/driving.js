// SPDX-License-Identifier: Apache-2.0
/** What moves on its own: a robot, driven by W A S D or by a stick for thumbs in its panel; an actor, with its way in the world. */

import {createElement} from '../dom.js';
import {digits, threeDigits} from '../rounding.js';
import {t} from '../strings.js';

/** @import {Actor, Parts, Point, Robot, SceneView, WorldState} from '../types.js' */

const PERIOD = 100; // ms between commands: a drive stops without one after half a second
const TURN = 0.5; // share of the greatest turn rate that a key asks for
const REACH = 48; // px of the knob
/** Forward, left and turn of a key, by its place. @type {Record<string, [number, number, number]>} */
const KEYS = {KeyW: [1, 0, 0], KeyS: [-1, 0, 0], KeyA: [0, 0, TURN], KeyD: [0, 0, -TURN], KeyQ: [0, 1, 0], KeyE: [0, -1, 0]};

export class Driving {
  /** @param {Parts<'connection' | 'people' | 'selection' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.name = ''; // of the robot that is driven
    /** @type {Set<string>} that are held */
    this.keys = new Set();
    /** @type {Point} of the knob, right and up, each -1 .. 1 */
    this.stick = [0, 0];
    this.timer = 0;
    this.battery = {name: '', level: 0, current: 0};
    this.charge = createElement('p');
    parts.connection.on('battery', (battery) => {
      this.battery = battery;
      this.#showCharge();
    });
    this.knob = createElement('i');
    this.element = createElement('div', {className: 'stick', role: 'img', 'aria-label': t('Stick: drag to drive')}, this.knob);
    this.element.addEventListener('pointerdown', (event) => {
      this.element.setPointerCapture(event.pointerId);
      this.#drag(event);
    });
    // The canvas keeps the focus, so that keys drive on.
    this.element.addEventListener('mousedown', (event) => event.preventDefault());
    this.element.addEventListener('pointermove', (event) => event.buttons && this.#drag(event));
    this.element.addEventListener('lostpointercapture', () => this.#push([0, 0]));
  }

  /** @returns {?Robot} the selected one, if it drives */
  get #robot() {
    const {selection, world, people: {viewOnly}} = this.parts, row = selection.name && !viewOnly ? world.row(selection.name) : -1;
    const robot = row < 0 ? null : world.scene.bodies[row].robot;
    return robot?.kind ? robot : null;
  }

  /**
   * @param {Robot} robot
   * @returns {Node[]} its part of the panel
   */
  show({kind, namespace, max_speed: speed = 0, max_turn: turn = 0}) {
    if (!kind) return [createElement('h3', {textContent: `${t('Robot')} · /${namespace}`})];
    this.#showCharge();
    return [createElement('h3', {textContent: `${t('Robot, {drive}', {drive: kind})} · /${namespace}`}),
      createElement('p', {}, t('Up to {speed} m/s and {turn} rad/s', {speed, turn})), this.charge,
      createElement('div', {className: 'drive'}, this.element,
        createElement('p', {}, t('Drag the knob; or {keys}, after a click on the world.', {keys: kind === 'omni' ? 'W A S D Q E' : 'W A S D'})))];
  }

  #showCharge() {
    const {name, level, current} = this.battery, amperes = threeDigits(current);
    this.charge.textContent = name && name === this.parts.selection.name ? t('Battery {level} % · {current} A', {level: Math.round(100 * level), current: amperes}) : '';
  }

  /**
   * @param {string} code of a key that is pressed
   * @returns {boolean} whether a robot drives by it
   */
  press(code) {
    if (!(code in KEYS) || !this.#robot) return false;
    if (this.keys.has(code)) return true;
    this.keys.add(code);
    this.#change();
    return true;
  }

  /** @param {string} code of a key that is lifted */
  lift(code) {
    if (this.keys.delete(code)) this.#change();
  }

  /** Lift all keys. */
  liftAll() {
    this.keys.clear();
    this.#change();
  }

  /** @param {PointerEvent} event */
  #drag({clientX, clientY}) {
    const {left, top, width} = this.element.getBoundingClientRect();
    const x = (clientX - left - width / 2) / REACH, y = (top + width / 2 - clientY) / REACH;
    const far = Math.max(Math.hypot(x, y), 1);
    this.#push([x / far, y / far]);
  }

  /** @param {Point} stick */
  #push(stick) {
    this.stick = stick;
    this.knob.style.transform = `translate(${stick[0] * REACH}px, ${-stick[1] * REACH}px)`;
    this.#change();
  }

  /** Command at once, and again while anything is pressed. */
  #change() {
    const active = this.keys.size > 0 || this.stick.some(Boolean);
    if (!active && !this.timer) return;
    clearInterval(this.timer);
    this.timer = active ? setInterval(() => this.#command(), PERIOD) : 0;
    this.#command();
  }

  #command() {
    const {connection, selection, world} = this.parts, robot = this.#robot, [x, y] = this.stick;
    if (this.name && (!robot || this.name !== selection.name)) {
      // Another one was selected meanwhile, or it was deleted.
      if (world.row(this.name) >= 0) connection.send('drive', {name: this.name, velocity: [0, 0, 0]});
      this.name = '';
      this.keys.clear();
      this.#push([0, 0]);
      return;
    }
    if (!robot || !this.timer && !this.name) return;
    const sum = [y, 0, -x * TURN];
    for (const key of this.keys) KEYS[key].forEach((each, i) => { sum[i] += each; });
    const {max_speed: fastest = 0, max_turn: turns = 0} = robot, most = [fastest, fastest, turns];
    connection.send('drive', {name: selection.name, velocity: sum.map((each, i) => Math.max(-1, Math.min(each, 1)) * most[i])});
    this.name = this.timer ? selection.name : '';
  }
}

/** @type {Record<Actor['kind'], string>} */
const KINDS = {path: t('Follows a path'), social_force: t('Walks by social forces'), orca: t('Walks and avoids others (ORCA)')};
/** @type {Record<string, string>} */
const REPEATS = {once: t('once'), loop: t('round and round'), to_and_fro: t('to and fro')};
const POINT = 4; // px: radius of a point of the way

/**
 * @param {Actor} actor
 * @returns {Node[]} lines of the panel
 */
export function actorLines({kind, points, speed, repeat = 'once', start = {}}) {
  const {gate, near, distance, time} = start;
  const texts = [`${KINDS[kind]}, ${REPEATS[repeat]}`, t('{count} points', {count: points.length})];
  if (speed) texts.push(`${digits(speed, 5)} m/s`);
  if (gate) texts.push(t('starts when something is in {name}', {name: gate}));
  if (near) texts.push(t('starts when {name} is within {distance} m', {name: near, distance: distance ?? 0}));
  if (time) texts.push(t('waits {time} s', {time}));
  return [createElement('p', {className: 'actor', textContent: texts.join(' · ')})];
}

/**
 * @param {SceneView} view
 * @param {WorldState} world
 * @param {string} name of the selected body, whose way is drawn if it is an actor
 */
export function drawWay(view, world, name) {
  const actor = world.body(name)?.actor, {accent} = view.palette;
  if (!actor) return;
  const points = actor.points.map(([x, y]) => /** @type {Point} */ ([x, y]));
  view.line(actor.repeat === 'loop' ? [...points, points[0]] : points, accent, [8, 5]);
  for (const point of points) view.ring(point, POINT, accent);
}
