// SPDX-License-Identifier: Apache-2.0
/** The help: keys, and where there are fingers, gestures and tools first. */

import {createElement, icon, inRow} from '../dom.js';
import {t} from '../strings.js';
import {strokeCard} from './strokes.js';
import {EDIT, TIME} from './time_bar.js';
import {TOOLS} from '../tools/tools.js';

/** @import {Dialog} from './dialog.js' */

const TOUCHED = matchMedia('(pointer: coarse)');
const GESTURES = [
  [t('Draw'), t('The pen, with a finger; if you use a stylus, it draws, and a finger moves the view')],
  [t('Grab and throw'), t('The hand, on a body; let go while it moves')],
  [t('Place and turn'), t('While paused: the hand on a body; a second finger turns it')],
  [t('Drive a robot'), t('Tap it, and drag the knob of its panel')],
  [t('Change a body'), t('Tap it with pen, hand or lasso')],
  [t('Move the view'), t('Two fingers; or the hand, away from bodies')],
  [t('Zoom'), t('Pinch with two fingers')],
  [t('Go back in time'), t('Drag the time line')],
  [t('See what a button does'), t('Hold a finger on it')],
];
const MOVING = [
  [t('Space'), t('Play or pause; held, dragging moves the view')],
  [t('Arrow keys'), t('Move the cursor, with Shift in small steps; Enter presses and lifts the tool, or a handle')],
  ['R, Shift+R', t('Turn the body in the hand, while paused')],
  ['N, Shift+N', t('Select the next or the previous body')],
  ['W A S D', t('Drive the selected robot; Q and E move it sideways, if its drive can')],
  [t('Shift, held'), t('Drawing and dragging with the mouse snaps to the grid; rectangles become squares, lines and handles turn by 15°, handles scale by quarters')],
  [t('Alt, held'), t('Hand and lasso drag a copy')],
  ['7, 6', t('Stopwatch by hand: start and stop; lap')],
  ['5', t('In a lesson: all tools, or those that it needs')],
  [t('Ctrl+C, X, V, D, A'), t('Copy, cut, paste, duplicate, select all; the same by the right button')],
  [t('Delete'), t('Delete the selection')],
  [t('Esc'), t('Cancel')],
  ['+, −, F', t('Zoom; frame the world')],
  ['Enter', t('Close a polygon')],
  ['?', t('This list')],
];

/**
 * @param {Dialog} dialog
 * @param {HTMLElement[]} settings fields
 */
export function showHelp(dialog, settings) {
  const key = (/** @type {string} */ name) => createElement('kbd', {}, name);
  const keys = [...TOOLS.flat().map(({name, keyName}) => [key(keyName), name]),
    ...[...TIME, ...EDIT].map(([name, , letter]) => [key(letter), name]), ...MOVING.map(([name, does]) => [key(name), does])];
  const tools = TOOLS.flat().map(({id, name, hint}) => [icon(id), `${name}: ${hint}`]);
  const strokes = [createElement('h3', {}, t('What the pen understands')), strokeCard()];
  const sections = [strokes, section(t('Keys'), keys)];
  if (TOUCHED.matches) sections.splice(1, 0, section(t('Gestures'), GESTURES), section(t('Tools'), tools));
  dialog.show(t('Help'), inRow(...settings), ...sections.flat());
}

/**
 * @param {string} title
 * @param {(string | Node)[][]} rows what is done, and what it does
 * @returns {Node[]}
 */
function section(title, rows) {
  return [createElement('h3', {}, title), createElement('dl', {}, ...rows.map(([done, does]) =>
    createElement('div', {}, createElement('dt', {}, done), createElement('dd', {}, does))))];
}
