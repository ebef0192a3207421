// SPDX-License-Identifier: Apache-2.0
/** What the panel shows of a body, and of several: their numbers, their properties, plots. */

import {arrangeButtons} from './align.js';
import {createElement, inRow, textButton, textField, textOf} from './dom.js';
import {forceFields} from './force_fields.js';
import {sizeOf} from './label_view.js';
import {sendNote} from './tools/note.js';
import {isDrawn} from './words.js';
import {materialButtons, materialFields} from './world_panel.js';

/** @import {App} from './types.js' */
/** @import {Content} from './panel.js' */

const BESIDE = 0.5; // m: where a copy is put

/**
 * @param {App} app
 * @param {string} name
 * @returns {?Content} null where there is no such body
 */
export function bodyContent(app, name) {
  const body = app.world.scene.bodies.find((each) => each.name === name);
  if (!body) return null;
  const change = (/** @type {object} */ properties) => app.connection.send('change', {name, properties});
  const anchored = createElement('input', {type: 'checkbox', checked: body.anchored,
    onchange: () => change({anchored: anchored.checked})});
  const gate = createElement('input', {type: 'checkbox', checked: body.sensor,
    onchange: () => change({sensor: gate.checked})});
  const label = textField({value: body.label, onchange: () => {
    const value = textOf(label), {height = 0} = body.shape, row = app.world.row(name);
    if (body.name.startsWith('note/') && height) {
      sendNote(app, name, value, [...app.world.place(row, [0, 0]), app.world.frame.yaw[row]], height / sizeOf(app.view.ctx, body.label)[1]);
    } else change({label: value});
  }});
  const material = materialFields(body, change);
  material.find((each) => each.textContent === 'Friction')?.append(app.numbers.pairs);
  return {
    title: app.words.title(name), name: isDrawn(name) ? name : '',
    first: [app.numbers.element, ...body.robot ? app.driving.show(body.robot) : []],
    rest: [
      app.numbers.typed,
      materialButtons(change),
      ...material,
      createElement('label', {}, 'Label', label),
      // A robot is neither.
      ...body.robot ? [] : [createElement('label', {}, 'Anchored', anchored), createElement('label', {}, 'Gate: lets bodies through', gate)],
      ...forceFields(app, body, change),
      inRow(
        textButton('Copy', () => copy(app, name)),
        textButton('Delete body', () => app.selection.deleteBodies(), 'danger')),
      createElement('p', {hidden: body.anchored, textContent: 'Point at the body: its ring is dragged to set the velocity, the round handle to turn, the square one to scale.'}),
      ...app.trail.switches(name),
      app.plots.element,
    ],
    place: () => {
      const row = app.world.row(name);
      return row < 0 ? null : app.world.place(row, app.world.scene.bodies[row].centroid);
    },
  };
}

/**
 * @param {App} app
 * @param {string[]} names
 * @returns {Content}
 */
export function severalContent(app, names) {
  return {title: `${names.length} bodies`, first: [app.numbers.totals], rest: [
    createElement('p', {textContent: 'Drag them with the lasso.'}),
    inRow(textButton('Copy beside', () => {
      const [left, , right] = app.world.boundsOfAll(names);
      app.connection.send('copy_machine', {names, by: [right - left + BESIDE, 0]});
    }), textButton('Plot them', () => app.plotWindow.open(names)), textButton('Delete bodies', () => app.selection.deleteBodies(), 'danger')),
    ...arrangeButtons(app, names)]};
}

/**
 * @param {App} app
 * @param {string} name of the body
 */
function copy({world, connection}, name) {
  const row = world.row(name);
  if (row >= 0) connection.send('copy', {name, to: [world.frame.x[row] + BESIDE, world.frame.y[row] + BESIDE]});
}
