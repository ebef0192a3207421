// SPDX-License-Identifier: Apache-2.0
/** Materials and places of pupils: what their names stand for, and the fields of a material. */

import {createElement, inRow, range, textButton} from './dom.js';

/**
 * Of a plate 1 mm thick, so that the density in kg/m² is the usual one in g/cm³. Friction and bounciness are
 * those of two bodies of that material, as tables for schools have them.
 * @type {Record<string, {density: number, friction: number, elasticity: number}>}
 */
const MATERIALS = {
  Ice: {density: 0.92, friction: 0.03, elasticity: 0.3},
  Wood: {density: 0.7, friction: 0.4, elasticity: 0.5},
  Rubber: {density: 1.1, friction: 1, elasticity: 0.8},
  Steel: {density: 7.85, friction: 0.6, elasticity: 0.6},
};
/** Key, label, least, most, step. @type {[string, string, number, number, number][]} */
const RANGES = [['density', 'Density [kg/m²]', 0.1, 10, 0.1], ['friction', 'Friction', 0, 2, 0.05],
  ['elasticity', 'Bounciness', 0, 1, 0.05]];
/** Gravity at the surface [m/s²]. */
const PLACES = {Earth: 9.81, Moon: 1.62, Mars: 3.71, None: 0};

/** @param {(properties: {density: number, friction: number, elasticity: number}) => void} change */
export function materialButtons(change) {
  return presetButtons(MATERIALS, change);
}

/** @param {(gravity: number) => void} change */
export function gravityButtons(change) {
  return presetButtons(PLACES, change);
}

/**
 * @template T
 * @param {Record<string, T>} presets by name
 * @param {(preset: T) => void} change
 */
function presetButtons(presets, change) {
  const row = inRow(...Object.entries(presets).map(([name, preset]) => textButton(name, () => change(preset))));
  row.classList.add('presets');
  return row;
}

/**
 * @param {any} values by key
 * @param {(properties: any) => void} change
 * @returns {HTMLElement[]}
 */
export function materialFields(values, change) {
  const color = createElement('input', {type: 'color', value: hexOf(values.color), onchange: () => change({color: color.value})});
  return [
    ...RANGES.map(([key, label, least, most, step]) => range(label, least, most, step, values[key],
      (value) => change({[key]: value}))),
    createElement('label', {}, 'Colour', color)];
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
