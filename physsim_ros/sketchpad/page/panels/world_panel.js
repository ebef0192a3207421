// SPDX-License-Identifier: Apache-2.0
/** What the panel shows of the world: the material of the next drawings, gravity, air, sound; and the fields of a material. */

import {checkField, createElement, inRow, labelled, range, textButton} from '../dom.js';
import {airFields} from './field_fields.js';
import {t} from '../strings.js';

/** @import {Parts} from '../types.js' */
/** @import {Content} from './panel.js' */

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

/**
 * @param {Parts<'connection' | 'gravity' | 'material' | 'sound' | 'world'>} parts
 * @param {string[]} _names
 * @param {() => void} render the panel again
 * @returns {Content}
 */
export function worldContent(parts, _names, render) {
  const {material, world: {scene}} = parts, {color: chosen} = material, color = chosen || [0.3, 0.47, 0.66];
  const any = checkField(t('Each body another colour'), !chosen, (checked) => material.change({color: checked ? '' : hexOf(color)}));
  return {title: t('Material of new bodies'), rest: [
    ...materialFields({...scene, ...material.chosen, color}, (properties) => {
      if (properties.color) /** @type {HTMLInputElement} */ (any.control).checked = false;
      material.change(properties);
      // A material that was pressed is shown in the fields below.
      if (properties.density && properties.friction) render();
    }),
    any,
    ...parts.gravity.fields(),
    ...airFields(parts),
    checkField(t('Sound of impacts'), parts.sound.on, () => parts.sound.toggle())]};
}

/**
 * @template T
 * @param {Record<string, T>} presets by name
 * @param {(preset: T) => void} change
 */
export function presetButtons(presets, change) {
  const row = inRow(...Object.entries(presets).map(([name, preset]) => textButton(name, () => change(preset))));
  row.classList.add('presets');
  return row;
}

/**
 * @param {any} values by key
 * @param {(properties: any) => void} change
 * @returns {HTMLElement[]} buttons and fields of a material
 */
export function materialFields(values, change) {
  const color = createElement('input', {type: 'color', value: hexOf(values.color), onchange: () => change({color: color.value})});
  return [
    presetButtons(MATERIALS, change),
    ...RANGES.map(([key, label, least, most, step]) => range(label, least, most, step, values[key],
      (value) => change({[key]: value}))),
    labelled(t('Colour'), color)];
}

/**
 * @param {number[] | string} color channels, each 0 .. 1, or as hexOf returns it
 * @returns {string} as inputs have it
 */
function hexOf(color) {
  if (typeof color === 'string') return color;
  return `#${color.slice(0, 3).map((channel) =>
    Math.round(255 * channel).toString(16).padStart(2, '0')).join('')}`;
}
