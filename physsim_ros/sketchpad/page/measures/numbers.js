// SPDX-License-Identifier: Apache-2.0
/** The numbers of the selected body now: mass, place, angle, velocity, momentum, energies, which can be typed, too. */

import {createElement, labelled, numberField, showText} from '../dom.js';
import {neighboursOf} from '../view/forces.js';
import {energiesOf, momentumText, motionOf, originOf, placed} from './quantities.js';
import {digits, threeDigits, twoPlaces} from '../rounding.js';
import {t} from '../strings.js';
import {DEGREE, wrapped} from '../vectors.js';

/** @import {Body, Parts} from '../types.js' */
/** @import {Motion} from './quantities.js' */

/** What can be typed; of an anchored body the first ones. @type {[string, string][]} */
const TYPED = [['x', 'x [m]'], ['y', 'y [m]'], ['angle', t('Angle [°]')], ['mass', t('Mass [kg]')],
  ['vx', 'vx [m/s]'], ['vy', 'vy [m/s]'], ['spin', t('Spin [rad/s]')]];
const NOTHING = 1e-7; // m, °, m/s, rad/s: that is shown as 0
const AT_REST = 4; // number of those that an anchored body has
/** @typedef {{name: string, motion: Motion, answered: boolean}} Typed */
const ENERGIES = [t('Kinetic energy'), t('Potential energy')];
const MOST_PAIRS = 3; // bodies in touch with whose friction that of the pair is told

export class Numbers {
  /** @param {Parts<'connection' | 'selection' | 'words' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.most = 0; // greatest energy that was shown of this body [J]
    this.name = '';
    /** Numbers that were typed and that no frame shows yet. @type {?Typed} */
    this.ahead = null;
    this.line = createElement('p');
    this.momentum = createElement('p');
    this.turning = createElement('p', {className: 'pairs'}); // moment of inertia and angular momentum
    this.pairs = createElement('p', {className: 'pairs'}); // friction with what the body touches
    this.bars = ENERGIES.map((word) => createElement('meter', {min: 0, 'aria-label': word}));
    this.labels = ENERGIES.map((word) => createElement('span', {}, word));
    this.values = ENERGIES.map(() => createElement('span'));
    this.inputs = new Map(TYPED.map(([key]) => [key, numberField(null, (value) => this.#type(key, value), {inputMode: key === 'mass' ? 'decimal' : 'text'})]));
    this.typed = createElement('details', {className: 'typed'}, createElement('summary', {}, t('Enter numbers')),
      createElement('div', {}, ...TYPED.map(([key, label]) => labelled(label, /** @type {Node} */ (this.inputs.get(key))))));
    this.element = createElement('section', {className: 'numbers', 'aria-label': t('Numbers')}, this.line, this.momentum,
      ...this.labels.flatMap((label, i) => [label, this.bars[i], this.values[i]]));
    parts.connection.on('open', () => { this.ahead = null; });
    // A change is in each frame that comes after its answer.
    parts.connection.on('frame', () => {
      if (this.ahead?.answered) this.ahead = null;
    });
  }

  /** @param {string} name of the body whose numbers are shown as they are now */
  show(name) {
    const {world} = this.parts, row = world.row(name);
    if (row < 0) return;
    const body = world.scene.bodies[row], {vx, vy, spin} = motionOf(world, row), {mass} = body;
    // The line breaks between quantities, not before a unit.
    showText(this.line, `${threeDigits(mass)} kg · ${placed(world, row)}`.replace(/(?<!·) /g, '\u00a0'));
    showText(this.momentum, t('Momentum {momentum}', {momentum: momentumText([mass * vx, mass * vy])}));
    showText(this.turning, t('Angular momentum {turning} N m s · moment of inertia {moment} kg m²',
      {turning: twoPlaces(body.moment * spin), moment: threeDigits(body.moment)}));
    showText(this.pairs, this.#pairsOf(row));
    this.#showTyped(body, row);
    this.#showEnergies(body, row);
  }

  /**
   * @param {number} row of a body
   * @returns {string} the friction with each body that it touches
   */
  #pairsOf(row) {
    const {world: {touches, scene: {bodies}}, words} = this.parts;
    const others = [...neighboursOf(touches, new Set([row]))].filter((other) => other >= 0);
    return others.slice(0, MOST_PAIRS).map((other) => {
      const friction = threeDigits(Math.sqrt(bodies[row].friction * bodies[other].friction));
      return t('Friction with {name}: {friction}', {name: words.of(bodies[other].name), friction});
    }).join(' · ');
  }

  /**
   * @param {Body} body
   * @param {number} row
   */
  #showTyped({anchored}, row) {
    /** @type {Record<string, number>} */
    const values = motionOf(this.parts.world, row);
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
    const {world, selection: {name}, connection} = this.parts, row = world.row(name);
    this.inputs.get(key)?.blur();
    if (row < 0 || value === null) return;
    const motion = {...this.ahead?.name === name ? this.ahead.motion : motionOf(world, row), [key]: value};
    /** @type {Typed} */
    const typed = {name, motion, answered: false};
    this.ahead = typed;
    const {mass, x, y, angle, vx, vy, spin} = motion, now = world.frame.yaw[row];
    // A spring that turns with the body keeps its turns.
    const yaw = now + wrapped(angle * DEGREE - now);
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
    const {world} = this.parts, {frame: {velocities}, scene: {gravity}} = world, {name, anchored} = body;
    if (name !== this.name) this.most = 0;
    this.name = name;
    this.element.classList.toggle('fixed', anchored);
    // The panel has its size before they come.
    this.element.classList.toggle('waiting', !velocities);
    if (!velocities || anchored) return;
    // Seen from above, there is no height.
    for (const {1: ofHeight} of [this.labels, this.bars, this.values]) ofHeight.hidden = !gravity[0] && !gravity[1];
    const energies = energiesOf(body, motionOf(world, row), gravity);
    this.most = Math.max(this.most, ...energies);
    energies.forEach((energy, i) => {
      this.bars[i].max = this.most || 1;
      this.bars[i].value = Math.max(energy, 0);
      this.values[i].textContent = `${twoPlaces(energy)} J`;
    });
  }
}
