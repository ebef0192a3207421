// SPDX-License-Identifier: Apache-2.0
/** The fields of the constant forces on a body, in its panel. */

import {checkField, createElement, inRow, labelled, numberField, textButton} from '../dom.js';
import {numberOf} from '../rounding.js';
import {t} from '../strings.js';
import {DEGREE, polar, rotated} from '../vectors.js';
import {latest} from '../world_state.js';

/** @import {AppliedForce, Body, Parts} from '../types.js' */

const FIRST = 10; // N: of a force that is added, to the right

/**
 * @param {Parts<'world'>} parts
 * @param {Body} body
 * @param {(properties: object) => void} change
 * @returns {HTMLElement[]} a row for each force, and a button that adds one
 */
export function forceFields({world}, {name, forces = []}, change) {
  // The panel is not rendered again while somebody works in it.
  const {now, say} = latest(world, () => world.body(name)?.forces ?? []);
  const send = (/** @type {AppliedForce[]} */ changed) => change({forces: say(changed)});
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
    return createElement('fieldset', {className: 'force'}, createElement('legend', {}, t('Constant force {number}', {number: i + 1})),
      labelled(t('Force [N]'), size), labelled(t('Direction [°]'), angle), turns,
      inRow(textButton(t('Remove'), () => send(now().filter((_, j) => j !== i)), 'danger')));
  });
  return [...rows, inRow(textButton(t('Add a constant force'), () => send([...now(), {force: [FIRST, 0]}])))];
}
