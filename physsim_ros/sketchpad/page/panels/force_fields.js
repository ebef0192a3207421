// SPDX-License-Identifier: Apache-2.0
/**
 * The constant forces on bodies: fields in the panel of a body, and arrows of one length where no forces are shown
 * to scale.
 */

import {checkField, createElement, inRow, numberField, textButton} from '../dom.js';
import {numberOf, threeDigits} from '../rounding.js';
import {t} from '../strings.js';
import {DEGREE, polar, rotated} from '../vectors.js';

/** @import {App, AppliedForce, Body, Point, SceneView, WorldState} from '../types.js' */

const FIRST = 10; // N: of a force that is added, to the right
const LENGTH = 34; // px: of an arrow

/**
 * @param {App} app
 * @param {Body} body
 * @param {(properties: object) => void} change
 * @returns {HTMLElement[]} a row for each force, and a button that adds one
 */
export function forceFields({world}, {name, forces = []}, change) {
  // The panel is not rendered again while somebody works in it.
  const now = () => world.scene.bodies[world.row(name)]?.forces ?? [];
  const send = (/** @type {AppliedForce[]} */ changed) => change({forces: changed});
  const rows = forces.map(({force: [x, y], axes}, i) => {
    const replaced = (/** @type {Partial<AppliedForce>} */ fields) => send(now().map((each, j) => j === i ? {...each, ...fields} : each));
    const number = (/** @type {string} */ label, /** @type {number} */ value) => numberField(value, () => {
      const [newtons, degrees] = [numberOf(size.value), numberOf(angle.value)];
      if (!Number.isNaN(newtons + degrees)) replaced({force: polar(newtons, degrees * DEGREE)});
    }, {'aria-label': `${label} (${i + 1})`});
    const size = number(t('Force [N]'), Math.hypot(x, y)), angle = number(t('Direction [°]'), Math.atan2(y, x) / DEGREE);
    const turns = checkField(t('Turns with the body'), axes === 'body', (isOn) => {
      const yaw = world.frame.yaw[world.row(name)], force = now()[i]?.force ?? [x, y];
      // Its direction of now stays.
      replaced({axes: isOn ? 'body' : 'world', force: rotated(force, isOn ? -yaw : yaw)});
    });
    return createElement('fieldset', {className: 'force'}, createElement('legend', {textContent: t('Constant force {number}', {number: i + 1})}),
      createElement('label', {}, t('Force [N]'), size), createElement('label', {}, t('Direction [°]'), angle),
      turns,
      inRow(textButton(t('Remove'), () => send(now().filter((_, j) => j !== i)), 'danger')));
  });
  return [...rows, inRow(textButton(t('Add a constant force'), () => send([...now(), {force: [FIRST, 0]}])))];
}

/**
 * @param {WorldState} world
 * @param {number} row of a body
 * @returns {{at: Point, force: Point}[]} its constant forces now, in world axes [m, N]
 */
export function appliedTo(world, row) {
  const {forces = [], centroid} = world.scene.bodies[row];
  return forces.map(({force, at = centroid, axes}) => ({at: world.place(row, at),
    force: axes === 'body' ? rotated(force, world.frame.yaw[row]) : force}));
}

/**
 * Draw the constant forces of all bodies, with the newtons of those on selected ones.
 * @param {App} app
 * @param {SceneView} view
 */
export function drawApplied({world, camera, selection}, view) {
  const color = view.palette.applied;
  for (let row = 0; row < world.count; row++) {
    const {forces, name} = world.scene.bodies[row];
    for (const {at, force: [x, y]} of forces ? appliedTo(world, row) : []) {
      const size = Math.hypot(x, y), [px, py] = camera.toPage(...at);
      if (!size) continue;
      const along = /** @type {Point} */ ([x / size, -y / size]);
      const tip = /** @type {Point} */ ([px + LENGTH * along[0], py + LENGTH * along[1]]);
      view.arrow([px, py], tip, color);
      if (selection.names.has(name)) view.number({text: `${threeDigits(size)} N`, color, from: [px, py], tip, along, named: true});
    }
  }
}
