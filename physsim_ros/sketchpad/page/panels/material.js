// SPDX-License-Identifier: Apache-2.0
/** Materials: their fields, of a body or of the next drawings of this page. */

import {createElement, labelled, presetButtons, range} from '../dom.js';
import {t} from '../strings.js';

/** @import {Parts} from '../types.js' */

/**
 * Of a plate 1 mm thick, so that the density in kg/m² is the usual one in g/cm³. Friction and bounciness are
 * those of two bodies of that material, as tables for schools have them.
 * @type {Record<string, {density: number, friction: number, elasticity: number}>}
 */
const MATERIALS = {
  [t('Ice')]: {density: 0.92, friction: 0.03, elasticity: 0.3},
  [t('Wood')]: {density: 0.7, friction: 0.4, elasticity: 0.5},
  [t('Rubber')]: {density: 1.1, friction: 1, elasticity: 0.8},
  [t('Steel')]: {density: 7.85, friction: 0.6, elasticity: 0.6},
};
/** Key, label, least, most, step. @type {[string, string, number, number, number][]} */
const RANGES = [['density', t('Density [kg/m²]'), 0.1, 10, 0.1], ['friction', t('Friction'), 0, 2, 0.05],
  ['elasticity', t('Bounciness'), 0, 1, 0.05]];

/** The material of the next drawings of this page. */
export class Material {
  /** @param {Parts<'connection' | 'people'>} parts */
  constructor({connection, people}) {
    this.connection = connection;
    /** @type {Record<string, any>} properties that the server knows of */
    this.known = {};
    /** @type {Record<string, any>[]} changes that are not answered */
    this.asked = [];
    /** @type {?string | number[]} where this page chose none */
    this.worldColor = null;
    connection.on('welcome', ({settings = {}}) => {
      this.worldColor = settings.draw_color ?? null;
      // A server that was started anew knows no material of this page; none answers what was asked before.
      [this.known, this.asked] = [this.chosen, []];
      if (Object.keys(this.known).length && !people.viewOnly) connection.send('draw_with', this.known);
    });
  }

  /** @returns {Record<string, any>} properties that this page has chosen; others are the world's */
  get chosen() {
    return Object.assign({}, this.known, ...this.asked);
  }

  /** @returns {?string | number[]} */
  get color() {
    return this.chosen.color ?? this.worldColor;
  }

  /** @param {Record<string, any>} properties */
  async change(properties) {
    this.asked.push(properties);
    const {ok} = await this.connection.ask('draw_with', properties);
    this.asked.splice(this.asked.indexOf(properties), 1);
    if (ok) Object.assign(this.known, properties);
  }
}

/**
 * @param {any} values by key
 * @param {(properties: any) => void} change
 * @param {Record<string, Node[]>} below what is shown below a field, by its key
 * @returns {HTMLElement[]} buttons and fields of a material
 */
export function materialFields(values, change, below = {}) {
  const color = createElement('input', {type: 'color', value: hexOf(values.color), onchange: () => change({color: color.value})});
  return [
    presetButtons(MATERIALS, change),
    ...RANGES.map(([key, label, least, most, step]) => {
      const field = range(label, least, most, step, values[key], (value) => change({[key]: value}));
      field.append(...below[key] ?? []);
      return field;
    }),
    labelled(t('Colour'), color)];
}

/**
 * @param {number[] | string} color channels, each 0 .. 1, or as hexOf returns it
 * @returns {string} as inputs have it
 */
export function hexOf(color) {
  if (typeof color === 'string') return color;
  return `#${color.slice(0, 3).map((channel) =>
    Math.round(255 * channel).toString(16).padStart(2, '0')).join('')}`;
}
