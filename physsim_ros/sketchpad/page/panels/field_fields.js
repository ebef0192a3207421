// SPDX-License-Identifier: Apache-2.0
/** The fields of what acts from afar: the medium and the charge of a body, the air and the attraction of the world. */

import {checkField, createElement, range} from '../dom.js';
import {t} from '../strings.js';
import {latest} from '../world_state.js';

/** @import {Body, Medium, Parts} from '../types.js' */

/** Of a body that becomes water: twice as dense as a new body, so that this one floats. */
export const WATER = {density: 2, viscosity: 0.5};
const SKIN = 0.01; // m: what lies on a pool does not float in it

/**
 * @param {Parts<'world'>} parts
 * @param {Body} body
 * @param {(properties: object) => void} change
 * @returns {HTMLElement[]} a switch, and of a region its fields
 */
export function mediumFields({world}, {name, medium, charge = 0}, change) {
  if (!medium) {
    return [
      range(t('Charge [C]'), -5, 5, 0.1, charge, (value) => change({charge: value})),
      checkField(t('Water: bodies float in it'), false, () => change({anchored: true, sensor: true, medium: WATER}))];
  }
  // The panel is not rendered again while somebody works in it.
  const {now, say} = latest(world, () => world.body(name)?.medium ?? medium);
  const set = (/** @type {Partial<Medium>} */ said) => change({medium: say({...now(), ...said})});
  return [
    checkField(t('Water: bodies float in it'), true, () => {
      const [left, low, right, high] = world.boundsOfAll([name]);
      // A solid body would overlap what floats in it.
      change({medium: null, sensor: !world.isFree([left + SKIN, low + SKIN, right - SKIN, high - SKIN])});
    }),
    createElement('fieldset', {className: 'force'}, createElement('legend', {}, t('Water or air')),
      range(t('Density of the medium [kg/m²]'), 0, 20, 0.1, medium.density, (density) => set({density})),
      range(t('Viscosity [N s/m²]'), 0, 10, 0.1, medium.viscosity, (viscosity) => set({viscosity})),
      range(t('Current to the right [m/s]'), -10, 10, 0.1, medium.flow[0], (x) => set({flow: [x, now().flow[1]]})),
      range(t('Current upward [m/s]'), -10, 10, 0.1, medium.flow[1], (y) => set({flow: [now().flow[0], y]})),
      range(t('Gusts [m/s]'), 0, 5, 0.1, medium.gusts, (gusts) => set({gusts})))];
}

/**
 * @param {Parts<'connection' | 'world'>} parts
 * @returns {HTMLElement[]} air and attraction of the world
 */
export function airFields({connection, world}) {
  const {scene} = world;
  const send = (/** @type {Record<string, unknown>} */ changes) => connection.send('air', changes);
  return [
    range(t('Air drag [of the speed, each second]'), 0, 0.95, 0.05, scene.damping, (damping) => send({damping})),
    range(t('Density of the air [kg/m²]'), 0, 2, 0.01, scene.air_density, (value) => send({air_density: value})),
    range(t('Viscosity of the air [N s/m²]'), 0, 2, 0.01, scene.air_viscosity, (value) => send({air_viscosity: value})),
    range(t('Wind to the right [m/s]'), -20, 20, 0.5, scene.wind[0], (x) => send({wind: [x, world.scene.wind[1]]})),
    range(t('Gusts [m/s]'), 0, 5, 0.1, scene.gusts, (gusts) => send({gusts})),
    range(t('Attraction of masses, G [N m²/kg²]'), 0, 10, 0.1, scene.gravitation, (gravitation) => send({gravitation})),
    range(t('Force of charges, k [N m²/C²]'), 0, 10, 0.1, scene.coulomb, (coulomb) => send({coulomb}))];
}
