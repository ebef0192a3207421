// SPDX-License-Identifier: Apache-2.0
/** The panel of a body: its numbers, its material, its forces, its trail and its plots. */

import {checkField, choiceField, createElement, inRow, labelled, numberField, textButton, textField, textOf} from '../dom.js';
import {actorLines, drawWay} from './driving.js';
import {mediumFields} from './field_fields.js';
import {forceFields} from './force_fields.js';
import {labelSize} from '../view/label_view.js';
import {capital, server, t} from '../strings.js';
import {inclineFields} from '../tools/incline.js';
import {sendNote} from '../tools/note.js';
import {isDrawn} from '../words.js';
import {materialFields} from './material.js';
import {Numbers} from '../measures/numbers.js';
import {Plots} from '../measures/plots.js';

/** @import {Body, Parts} from '../types.js' */
/** @import {Content} from './panel.js' */

const MOST_JOINTS = 12; // that are listed

export class BodyPanel {
  /** @param {Parts<'connection' | 'driving' | 'meters' | 'notes' | 'plotting' | 'records' | 'selection' | 'trail' | 'view' | 'words' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.numbers = new Numbers(parts);
    this.plots = new Plots(parts);
  }

  /**
   * @param {string[]} names of the body alone
   * @param {() => void} render the panel again
   * @returns {?Content} null where it is gone
   */
  content([name], render) {
    const {parts, numbers, plots} = this, body = parts.world.body(name);
    if (!body) return null;
    const change = (/** @type {object} */ properties) => parts.connection.send('change', {name, properties});
    const label = textField({value: body.label, onchange: () => {
      const value = textOf(label), {height = 0} = body.shape, row = parts.world.row(name);
      if (body.name.startsWith('note/') && height) {
        sendNote(parts, name, value, [...parts.world.place(row, [0, 0]), parts.world.frame.yaw[row]], height / labelSize(parts.view.ctx, body.label)[1]);
      } else change({label: value});
    }});
    return {
      title: parts.words.title(name), name: isDrawn(name) || parts.world.robotOf(name) ? name : '',
      first: [numbers.element, ...inclineFields(parts, body, render),
        ...body.actor ? actorLines(body.actor) : [], ...body.robot ? parts.driving.show(body.robot) : []],
      rest: [
        numbers.turning, numbers.typed,
        ...materialFields(body, change, {friction: [numbers.pairs]}),
        labelled(t('Label'), label),
        // A robot is neither.
        ...body.robot ? [] : [checkField(t('Anchored'), body.anchored, (anchored) => change({anchored})),
          checkField(t('Gate: lets bodies through'), body.sensor, (sensor) => change({sensor}))],
        labelled(t('Belt [m/s]'), numberField(body.belt ?? 0, (belt) => change({belt: belt ?? 0}))),
        labelled(t('Rolling resistance'), numberField(body.rolling_resistance ?? 0, (share) => change({rolling_resistance: share ?? 0}))),
        ...body.robot ? [] : oneWayFields(body, change),
        jointRow(parts, name),
        ...forceFields(parts, body, change),
        ...body.robot ? [] : mediumFields(parts, body, change),
        inRow(
          textButton(t('Copy beside'), () => parts.selection.duplicate()),
          textButton(t('Delete body'), () => parts.selection.deleteSelected(), 'danger')),
        createElement('p', {hidden: body.anchored, textContent: t('Point at the body: its ring is dragged to set the velocity, the round handle to turn, the square one to scale.')}),
        ...parts.trail.switches(name), parts.meters.field(name),
        plots.element,
      ],
      live: (view) => {
        numbers.show(name);
        drawWay(view, parts.world, name);
      },
    };
  }
}

/**
 * @param {Body} body
 * @param {(properties: Record<string, unknown>) => void} change
 * @returns {HTMLElement[]} a choice of the direction in which others pass it, and whether its sides are closed
 */
function oneWayFields({one_way: direction, closed_sides: closed}, change) {
  /** @type {[string, string][]} */
  const directions = [['0,0', t('no')], ['0,1', t('upwards')], ['0,-1', t('downwards')], ['-1,0', t('to the left')], ['1,0', t('to the right')]];
  const now = String(direction ?? [0, 0]);
  if (!directions.some(([each]) => each === now)) directions.push([now, now]);
  return [choiceField(t('Lets others pass'), directions, now, (chosen) => change({one_way: chosen.split(',').map(Number)})),
    ...direction ? [checkField(t('Its sides are closed'), Boolean(closed), (closed_sides) => change({closed_sides}))] : []];
}

/**
 * @param {Parts<'selection' | 'world'>} parts
 * @param {string} name of a body
 * @returns {HTMLElement} its joints, each a button to the panel of that: a gear is nowhere to be tapped
 */
function jointRow({world, selection}, name) {
  const row = world.row(name), joints = world.scene.joints.filter(({a, b}) => a === row || b === row).slice(0, MOST_JOINTS);
  return inRow(...joints.map((joint) => textButton(capital(server(joint.kind)), () => selection.show('joint', [joint.name]))));
}
