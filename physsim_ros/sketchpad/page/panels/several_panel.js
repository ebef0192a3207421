// SPDX-License-Identifier: Apache-2.0
/** The panel of several bodies: what they have together, copies, and places at one line or with equal gaps, which one undo takes back. */

import {createElement, inRow, showText, textButton} from '../dom.js';
import {totalsOf} from '../measures/quantities.js';
import {unionOf} from '../view/body_path.js';
import {t} from '../strings.js';

/** @import {Bounds, Parts} from '../types.js' */
/** @import {Content} from './panel.js' */

/** Label, axis (0 is x), and the share of the distance from the lower edge to the upper one. @type {[string, number, number][]} */
const ALIGNMENTS = [[t('Left'), 0, 0], [t('Centre'), 0, 0.5], [t('Right'), 0, 1], [t('Top'), 1, 1], [t('Middle'), 1, 0.5], [t('Bottom'), 1, 0]];
/** @type {[string, number][]} */
const DISTRIBUTIONS = [[t('Across'), 0], [t('Up'), 1]];

/**
 * @param {Parts<'connection' | 'plotting' | 'selection' | 'world'>} parts
 * @param {string[]} names
 * @returns {Content}
 */
export function severalContent(parts, names) {
  const totals = createElement('p', {className: 'numbers'});
  return {title: t('{count} bodies', {count: names.length}), first: [totals], live: () => showText(totals, totalsOf(parts.world, names)), rest: [
    createElement('p', {}, t('Drag them with the lasso.')),
    inRow(textButton(t('Copy beside'), () => parts.selection.duplicate()), textButton(t('Plot them'), () => parts.plotting.open(names)), textButton(t('Delete bodies'), () => parts.selection.deleteSelected(), 'danger')),
    ...arrangeButtons(parts, names)]};
}

/**
 * @param {Parts<'connection' | 'world'>} parts
 * @param {string[]} names of bodies
 * @returns {HTMLElement[]} buttons, in rows
 */
function arrangeButtons(parts, names) {
  const align = ALIGNMENTS.map(([label, axis, share]) => textButton(label, () => place(parts, names, (boxes) => {
    const at = edge(unionOf(boxes), axis, share);
    return boxes.map((box) => along(axis, at - edge(box, axis, share)));
  })));
  const distribute = DISTRIBUTIONS.map(([label, axis]) => textButton(label, () => place(parts, names, (boxes) => distances(boxes, axis))));
  // Two bodies have one gap.
  const gaps = names.length > 2 ? [createElement('h3', {}, t('Equal gaps')), inRow(...distribute)] : [];
  return [createElement('h3', {}, t('Align')), inRow(...align), ...gaps];
}

/**
 * @param {Parts<'connection' | 'world'>} parts
 * @param {string[]} names
 * @param {(boxes: Bounds[]) => number[][]} shiftsOf how far each body is moved [m], by their boxes
 */
function place({world, connection}, names, shiftsOf) {
  const known = names.filter((name) => world.row(name) >= 0);
  const shifts = shiftsOf(known.map((name) => world.boundsOfAll([name])));
  const poses = known.map((name, i) => {
    const row = world.row(name), [dx, dy] = shifts[i];
    return [world.frame.x[row] + dx, world.frame.y[row] + dy, world.frame.yaw[row]];
  });
  connection.send('place', {names: known, poses});
}

/**
 * @param {Bounds[]} boxes
 * @param {number} axis
 * @returns {number[][]} how far each body is moved so that the gaps are equal; the outermost stay [m]
 */
function distances(boxes, axis) {
  const order = boxes.map((_, i) => i).sort((i, j) => edge(boxes[i], axis, 0.5) - edge(boxes[j], axis, 0.5));
  const sizes = order.map((i) => boxes[i][axis + 2] - boxes[i][axis]);
  const first = boxes[order[0]][axis], last = boxes[order[order.length - 1]][axis + 2];
  const gap = (last - first - sizes.reduce((sum, size) => sum + size, 0)) / Math.max(order.length - 1, 1);
  const shifts = boxes.map(() => [0, 0]);
  let at = first;
  order.forEach((i, number) => {
    shifts[i] = along(axis, at - boxes[i][axis]);
    at += sizes[number] + gap;
  });
  return shifts;
}

/**
 * @param {Bounds} box
 * @param {number} axis
 * @param {number} share 0 is the lower edge, 1 the upper one
 */
function edge(box, axis, share) {
  return box[axis] + share * (box[axis + 2] - box[axis]);
}

/**
 * @param {number} axis
 * @param {number} distance [m]
 */
function along(axis, distance) {
  return axis ? [0, distance] : [distance, 0];
}
