// SPDX-License-Identifier: Apache-2.0
/**
 * The legend of arrows, in a corner where nothing moves: their scales, and what is shown of them: each kind of force that
 * has occurred in this world, momenta, components.
 */

import {createElement, elementOf, fold, foldButton, replaceContent, showText, textButton, toggling} from '../dom.js';
import {digits} from '../rounding.js';
import {t} from '../strings.js';

/** @import {Parts} from '../types.js' */
/** @import {ArrowScale} from './arrow_scale.js' */

const CORNERS = ['top-right', 'top-left', 'bottom-right', 'bottom-left']; // of the room
/** Kinds of forces, in their order here, and what they are called, but for those of fields. @type {Record<string, string>} */
const NAMES = {weight: t('weight'), normal: t('normal force'), friction: t('friction'), joint: t('joint'),
  applied: t('applied force'), air: '', sum: t('sum'), torque: t('torque')};

export class Legend {
  /** @param {Parts<'camera' | 'connection' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.momenta = this.components = false; // whether they are shown
    /** @type {Set<string>} kinds of forces that are not shown */
    this.off = new Set();
    /** @type {Set<string>} kinds of forces that have occurred in this world */
    this.kinds = new Set();
    this.arrows = {velocities: false, forces: false}; // whether they are shown
    this.element = elementOf('legend');
    this.element.dataset.corner = CORNERS[0];
    /** The scales, by their unit. @type {Record<string, HTMLElement>} */
    this.bars = {};
    this.hint = createElement('span');
    // On a small page the scales alone are shown until somebody asks.
    this.more = foldButton(this.element, t('Kinds of forces'), () => {});
    fold(this.element, this.more, true);
    parts.connection.on('world', () => {
      this.kinds.clear();
      this.#render();
    });
  }

  /** @param {{velocities: boolean, forces: boolean}} arrows whether they are shown */
  show(arrows) {
    this.arrows = arrows;
    this.#render();
  }

  /** @param {string[]} kinds of forces that occur */
  addKinds(kinds) {
    const known = this.kinds.size;
    for (const kind of kinds) this.kinds.add(kind);
    if (this.kinds.size > known) this.#render();
  }

  /**
   * @param {string} kind of forces
   * @returns {string} what it is called; of fields, by those that this world has
   */
  nameOf(kind) {
    const {bodies, damping, air_density: air, air_viscosity: viscosity, gravitation, coulomb} = this.parts.world.scene;
    const fields = [[t('air'), damping || air || viscosity], [t('water'), bodies.some(({medium}) => medium)], [t('attraction'), gravitation || coulomb]];
    return NAMES[kind] || fields.filter(([, occurs]) => occurs).map(([name]) => name).join(', ');
  }

  #render() {
    const {element, bars, off, arrows: {velocities, forces}} = this;
    const bar = (/** @type {string} */ unit, /** @type {string} */ kind) => {
      bars[unit] = createElement('output');
      return createElement('span', {className: `scale ${kind}`}, bars[unit]);
    };
    const kindButton = (/** @type {string} */ name, /** @type {string} */ kind, /** @type {() => boolean} */ isOn, /** @type {() => void} */ change) =>
      toggling(textButton(name, () => {}, kind), isOn, change);
    element.hidden = !velocities && !forces;
    replaceContent(element,
      ...velocities ? [bar('m/s', 'velocity'), kindButton(t('Momentum'), 'momentum', () => this.momenta, () => {
        this.momenta = !this.momenta;
        this.#render();
      }), ...this.momenta ? [bar('N s', 'momentum'), bar('N m s', 'momentum')] : []] : [],
      ...forces ? [bar('N', ''), ...this.kinds.has('torque') ? [bar('N m', '')] : [], ...Object.keys(NAMES).filter((kind) => this.kinds.has(kind)).map((kind) =>
        kindButton(this.nameOf(kind), kind, () => !off.has(kind), () => off.delete(kind) || off.add(kind)))] : [],
      kindButton(t('x and y'), 'components', () => this.components, () => { this.components = !this.components; }), this.hint, this.more);
  }

  /**
   * @param {Record<string, ArrowScale>} scales by their units
   * @param {string} hint
   */
  showScales(scales, hint) {
    for (const [unit, scale] of Object.entries(scales)) {
      if (this.bars[unit]) showText(this.bars[unit], `${digits(scale.unit, 2)} ${unit}`);
    }
    showText(this.hint, hint);
  }

  /** Once time stands, go to a corner of the room in which no body lies that moves. */
  place() {
    const {element, parts: {world, camera}} = this;
    if (element.hidden || !world.paused) return;
    const {offsetWidth: width, offsetHeight: height} = element;
    const {left, top, right, bottom} = elementOf('room').getBoundingClientRect();
    const isFree = (/** @type {string} */ corner) => {
      const x = corner.includes('left') ? left : right - width, y = corner.includes('top') ? top : bottom - height;
      const [xmin, ymax] = camera.toWorld(x, y), [xmax, ymin] = camera.toWorld(x + width, y + height);
      return world.isFree([xmin, ymin, xmax, ymax]);
    };
    const now = element.dataset.corner ?? '';
    element.dataset.corner = [now, ...CORNERS].find(isFree) ?? now;
  }
}
