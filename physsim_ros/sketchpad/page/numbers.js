// SPDX-License-Identifier: Apache-2.0
/**
 * The numbers of the selected bodies now: mass, place, angle, velocity, momentum, energies; and what is measured of
 * a body at a time: the axes of plots and the columns of tables.
 */

import {createElement, numberField, showText} from './dom.js';
import {digits, fixed, threeDigits} from './rounding.js';
import {t} from './strings.js';
import {DEGREE, rotated} from './vectors.js';

/** @import {App, Body, Point, Sample, WorldState} from './types.js' */

/** What can be typed; of an anchored body the first ones. @type {[string, string][]} */
const TYPED = [['x', 'x [m]'], ['y', 'y [m]'], ['angle', t('Angle [°]')], ['mass', t('Mass [kg]')],
  ['vx', 'vx [m/s]'], ['vy', 'vy [m/s]'], ['spin', t('Spin [rad/s]')]];
const NOTHING = 1e-7; // m, °, m/s, rad/s: that is shown as 0
const AT_REST = 4; // number of those that an anchored body has
/**
 * The mass of a body [kg], and the place, angle and velocity of its centre of mass [m, °, m/s, rad/s].
 * @typedef {{mass: number, x: number, y: number, angle: number, vx: number, vy: number, spin: number}} Motion
 */
/** @typedef {{name: string, motion: Motion, answered: boolean}} Typed */
const ENERGIES = [t('Energy of motion'), t('Energy of height')];
const MOST_PAIRS = 3; // bodies in touch with whose friction that of the pair is told

export class Numbers {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.most = 0; // greatest energy that was shown of this body [J]
    this.name = '';
    /** Numbers that were typed and that no frame shows yet. @type {?Typed} */
    this.ahead = null;
    this.line = createElement('p');
    this.momentum = createElement('p');
    this.pairs = createElement('p', {className: 'pairs'}); // friction with what the body touches
    this.bars = ENERGIES.map((word) => createElement('meter', {min: 0, 'aria-label': word}));
    this.labels = ENERGIES.map((word) => createElement('span', {textContent: word}));
    this.values = ENERGIES.map(() => createElement('span'));
    this.inputs = new Map(TYPED.map(([key]) => [key, numberField(null, (value) => this.#type(key, value))]));
    this.typed = createElement('details', {className: 'typed'}, createElement('summary', {textContent: t('Enter numbers')}),
      createElement('div', {}, ...TYPED.map(([key, label]) => createElement('label', {}, label, /** @type {Node} */ (this.inputs.get(key))))));
    this.element = createElement('section', {className: 'numbers', 'aria-label': t('Numbers')}, this.line, this.momentum,
      ...this.labels.flatMap((label, i) => [label, this.bars[i], this.values[i]]));
    app.connection.on('open', () => { this.ahead = null; });
    // A change is in each frame that comes after its answer.
    app.connection.on('frame', () => {
      if (this.ahead?.answered) this.ahead = null;
    });
  }

  /** @param {string} name of the body whose numbers are shown as they are now */
  show(name) {
    const {world} = this.app, row = world.row(name);
    if (row < 0) return;
    const body = world.scene.bodies[row], {vx, vy} = motionOf(world, row), {mass} = body;
    showText(this.line, `${threeDigits(mass)} kg · ${placed(world, row)}`);
    showText(this.momentum, t('Momentum {momentum}', {momentum: momentumText([mass * vx, mass * vy])}));
    showText(this.pairs, this.#pairsOf(row));
    this.#showTyped(body, row);
    this.#showEnergies(body, row);
  }

  /**
   * @param {number} row of a body
   * @returns {string} the friction with each body that it touches
   */
  #pairsOf(row) {
    const {world: {frame: {contacts}, scene: {bodies}}, words} = this.app, others = new Set();
    for (let i = 0; contacts && i < contacts.a.length; i++) {
      const other = contacts.a[i] === row ? contacts.b[i] : contacts.b[i] === row ? contacts.a[i] : -1;
      if (other >= 0) others.add(other);
    }
    return [...others].slice(0, MOST_PAIRS).map((other) =>
      t('Friction with {name}: {friction}', {name: words.of(bodies[other].name), friction: threeDigits(Math.sqrt(bodies[row].friction * bodies[other].friction))})).join(' · ');
  }

  /**
   * @param {Body} body
   * @param {number} row
   */
  #showTyped({anchored}, row) {
    /** @type {Record<string, number>} */
    const values = motionOf(this.app.world, row);
    TYPED.forEach(([key], i) => {
      // Of what rests, a frame has the rounding errors of the engine.
      const value = Math.abs(values[key]) < NOTHING && key !== 'mass' ? 0 : values[key];
      const input = this.inputs.get(key), text = digits(value, 5);
      if (!input || input === document.activeElement) return;
      input.disabled = anchored && i >= AT_REST;
      if (input.value !== text) input.value = text;
    });
  }

  /**
   * @param {string} key of what was typed
   * @param {?number} value null where that is nothing
   */
  async #type(key, value) {
    const {world, panel: {name}, connection} = this.app, row = world.row(name);
    this.inputs.get(key)?.blur();
    if (row < 0 || value === null) return;
    const motion = {...this.ahead?.name === name ? this.ahead.motion : motionOf(world, row), [key]: value};
    /** @type {Typed} */
    const typed = {name, motion, answered: false};
    this.ahead = typed;
    const {mass, x, y, angle, vx, vy, spin} = motion, yaw = angle * DEGREE;
    const place = {at: [...originOf(world.scene.bodies[row].centroid, [x, y], yaw), yaw]}, velocity = {velocity: [vx, vy]};
    /** @type {Record<string, object>} */
    const changes = {mass: {mass}, x: place, y: place, angle: place, vx: velocity, vy: velocity, spin: {spin}};
    const {ok} = await connection.ask('change', {name, properties: changes[key]});
    typed.answered = true;
    if (!ok && this.ahead === typed) this.ahead = null;
  }

  /**
   * @param {Body} body
   * @param {number} row
   */
  #showEnergies(body, row) {
    const {world} = this.app, {frame: {velocities}, scene: {gravity}} = world, {name, anchored} = body;
    if (name !== this.name) this.most = 0;
    this.name = name;
    this.element.classList.toggle('fixed', anchored);
    // The panel has its size before they come.
    this.element.classList.toggle('waiting', !velocities);
    if (!velocities || anchored) return;
    // Seen from above, there is no height.
    for (const {1: part} of [this.labels, this.bars, this.values]) part.hidden = !gravity[0] && !gravity[1];
    const energies = energiesOf(body, motionOf(world, row), gravity);
    this.most = Math.max(this.most, ...energies);
    energies.forEach((energy, i) => {
      this.bars[i].max = this.most || 1;
      this.bars[i].value = Math.max(energy, 0);
      this.values[i].textContent = `${number(energy)} J`;
    });
  }
}

/**
 * @param {WorldState} world
 * @param {number} row
 * @returns {Motion} of a body; its velocity is 0 where it is not known
 */
function motionOf(world, row) {
  const {frame: {yaw, velocities}, scene} = world, {mass, centroid} = scene.bodies[row], [x, y] = world.place(row, centroid);
  return {mass, x, y, angle: yaw[row] / DEGREE,
    vx: velocities?.x[row] ?? 0, vy: velocities?.y[row] ?? 0, spin: velocities?.spin[row] ?? 0};
}

/**
 * @param {WorldState} world
 * @param {string[]} names of bodies
 * @returns {string} their mass, momentum and energies together; what is anchored has none
 */
export function totalsOf(world, names) {
  const {bodies, gravity} = world.scene;
  let mass = 0, px = 0, py = 0, energy = [0, 0];
  for (const row of names.map((name) => world.row(name)).filter((each) => each >= 0 && !bodies[each].anchored)) {
    const motion = motionOf(world, row), each = energiesOf(bodies[row], motion, gravity);
    mass += bodies[row].mass;
    px += bodies[row].mass * motion.vx;
    py += bodies[row].mass * motion.vy;
    energy = [energy[0] + each[0], energy[1] + each[1]];
  }
  return t('Together {mass} kg · momentum {momentum} · energy of motion {motion} J, of height {height} J',
    {mass: threeDigits(mass), momentum: momentumText([px, py]), motion: number(energy[0]), height: number(energy[1])});
}

/**
 * @param {Body} body
 * @param {{x: number, y: number, vx: number, vy: number, spin: number}} motion of its centre of mass [m, m/s, rad/s]
 * @param {number[]} gravity [m/s²]
 * @returns {[number, number]} energy of motion, and of height above the origin [J]
 */
function energiesOf({mass, moment}, {x, y, vx, vy, spin}, [gx, gy]) {
  return [mass * (vx * vx + vy * vy) / 2 + moment * spin * spin / 2, -mass * (gx * x + gy * y)];
}

/**
 * @param {Point} centroid in the frame of a body [m]
 * @param {Point} center where that is to be [m]
 * @param {number} yaw [rad]
 * @returns {Point} where the body's origin is then [m]
 */
export function originOf(centroid, [x, y], yaw) {
  const [dx, dy] = rotated(centroid, yaw);
  return [x - dx, y - dy];
}

/**
 * @param {WorldState} world
 * @param {number} row
 * @param {Point} by displacement [m]
 * @returns {string} the place and angle of a body, and how fast it is where that is known
 */
export function placed(world, row, by = [0, 0]) {
  const {frame: {yaw, velocities}, scene} = world, {centroid, anchored} = scene.bodies[row];
  const [x, y] = world.place(row, centroid), degrees = Math.round(yaw[row] / DEGREE * 10) / 10;
  const texts = [t('at {x}, {y} m', {x: number(x + by[0]), y: number(y + by[1])}), `${digits(degrees, 6)}°`];
  if (velocities && !anchored) {
    texts.push(`${number(Math.hypot(velocities.x[row], velocities.y[row]))} m/s`, `${number(velocities.spin[row])} rad/s`);
  }
  return texts.join(' · ');
}

/** @param {number} value */
function number(value) {
  return Math.abs(value) < 0.005 ? '0' : fixed(value, Math.abs(value) < 100 ? 2 : 0);
}

/** @param {Point} momentum [N s] */
function momentumText([px, py]) {
  return `${number(Math.hypot(px, py))} N s ${t('({x}, {y})', {x: number(px), y: number(py)})}`;
}

/**
 * @typedef {{label: string, column: string, of: (sample: Sample, body: Body, gravity: number[]) => number, sums?: boolean}} Quantity
 *   label: of an axis, column: of a table; of: NaN where it is not known; sums: whether that of several bodies is their sum
 */

/** Kinds of forces, as they are recorded, with their names on axes and in tables. */
export const FORCES = {weight: [t('Weight'), 'weight'], normal: [t('Normal force'), 'normal force'], friction: [t('Friction'), 'friction'],
  joint: [t('Force of joints'), 'force of joints'], applied: [t('Applied force'), 'applied force'], sum: [t('Sum of forces'), 'sum of forces']};

/** By key, in the order of the columns. @type {Record<string, Quantity>} */
export const QUANTITIES = {
  time: {label: t('Time [s]'), column: 'time [s]', of: ({time}) => time},
  x: {label: 'x [m]', column: 'x [m]', of: ({x}) => x},
  y: {label: t('Height [m]'), column: 'y [m]', of: ({y}) => y},
  vx: {label: 'vx [m/s]', column: 'vx [m/s]', of: ({vx}) => vx},
  vy: {label: 'vy [m/s]', column: 'vy [m/s]', of: ({vy}) => vy},
  spin: {label: t('Spin [rad/s]'), column: 'spin [rad/s]', of: ({spin}) => spin},
  speed: {label: t('Speed [m/s]'), column: 'speed [m/s]', of: ({vx, vy}) => Math.hypot(vx, vy)},
  energy: {label: t('Energy [J]'), column: 'energy [J]', sums: true, of: (sample, body, gravity) => {
    const [motion, height] = energiesOf(body, sample, gravity);
    return motion + height;
  }},
  px: {label: 'px [N s]', column: 'px [N s]', sums: true, of: ({vx}, {mass}) => mass * vx},
  py: {label: 'py [N s]', column: 'py [N s]', sums: true, of: ({vy}, {mass}) => mass * vy},
  momentum: {label: t('Momentum [N s]'), column: 'momentum [N s]', of: ({vx, vy}, {mass}) => mass * Math.hypot(vx, vy)},
  ax: {label: 'ax [m/s²]', column: 'ax [m/s²]', of: ({ax = NaN}) => ax},
  ay: {label: 'ay [m/s²]', column: 'ay [m/s²]', of: ({ay = NaN}) => ay},
  acceleration: {label: t('Acceleration [m/s²]'), column: 'acceleration [m/s²]', of: ({ax = NaN, ay = NaN}) => Math.hypot(ax, ay)},
  yaw: {label: t('Angle [rad]'), column: 'yaw [rad]', of: ({yaw}) => yaw},
  motion: {label: t('Energy of motion [J]'), column: 'energy of motion [J]', sums: true, of: (sample, body, gravity) => energiesOf(body, sample, gravity)[0]},
  height: {label: t('Energy of height [J]'), column: 'energy of height [J]', sums: true, of: (sample, body, gravity) => energiesOf(body, sample, gravity)[1]},
  ...Object.fromEntries(Object.entries(FORCES).map(([kind, [name, column]]) => [kind, /** @type {Quantity} */ ({label: `${name} [N]`, column: `${column} [N]`,
    of: ({forces}) => forces?.[kind] ?? NaN})])),
};

/**
 * @param {{name: string, body: Body, samples: Sample[]}[]} records
 * @param {number[]} gravity
 * @returns {string} a table of all quantities (CSV), the bodies one below the other
 */
export function tableOf(records, gravity) {
  const columns = Object.values(QUANTITIES), head = [...columns.map(({column}) => column), 'body'].join(',');
  const rows = records.flatMap(({name, body, samples}) => samples.map((sample) =>
    [...columns.map(({of}) => of(sample, body, gravity)).map((value) => Number.isNaN(value) ? '' : value), `"${name.replaceAll('"', '""')}"`].join(',')));
  return [head, ...rows, ''].join('\n');
}
