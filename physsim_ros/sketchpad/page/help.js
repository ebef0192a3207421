// SPDX-License-Identifier: Apache-2.0
/** The help: keys, and where there are fingers, gestures and tools first. */

import {createElement, icon} from './dom.js';
import {noteSeen, strokeCard} from './strokes.js';
import {EDIT, TIME} from './time_bar.js';
import {TOOLS} from './toolbar.js';

/** @import {App} from './types.js' */

const TOUCHED = matchMedia('(pointer: coarse)');
const GESTURES = [['Draw', 'The pen, with a finger; if you use a stylus, it draws, and a finger moves the view'],
  ['Grab and throw', 'The hand, on a body; let go while it moves'],
  ['Place and turn', 'While paused: the hand on a body; a second finger turns it'],
  ['Drive a robot', 'Tap it, and drag the knob of its panel'], ['Change a body', 'Tap it with pen, hand or lasso'], ['Move the view', 'Two fingers; or the hand, away from bodies'],
  ['Zoom', 'Pinch with two fingers'], ['Go back in time', 'Drag the time line'],
  ['See what a button does', 'Hold a finger on it']];
const MOVING = [['Space', 'Play or pause; held, dragging moves the view'],
  ['Arrow keys', 'Move the cursor, with Shift in small steps; Enter presses and lifts the tool'],
  ['R, Shift+R', 'Turn the body in the hand, while paused'], ['N, Shift+N', 'Select the next or the previous body'],
  ['W A S D', 'Drive the selected robot; Q and E move it sideways, if its drive can'], ['Shift, held', 'Drawing and dragging with the mouse snaps to the grid; rectangles become squares, lines and handles turn by 15°, handles scale by quarters'], ['Alt, held', 'Hand and lasso drag a copy'], ['Delete', 'Delete the selection'], ['Esc', 'Cancel'], ['+ and −, F', 'Zoom; frame the world'],
  ['Enter', 'Close a polygon'], ['?', 'This list']];

/** @param {App} app */
export function showHelp(app) {
  const key = (/** @type {string} */ name) => createElement('kbd', {textContent: name});
  const keys = [...TOOLS.flat().map(([, name, letter]) => [key(letter.toUpperCase()), name]),
    ...[...TIME, ...EDIT].map(([name, , letter]) => [key(letter), name]), ...MOVING.map(([name, does]) => [key(name), does])];
  const tools = TOOLS.flat().map(([id, name, , hint]) => [icon(id), `${name}: ${hint}`]);
  const strokes = [createElement('h3', {textContent: 'What the pen understands'}), strokeCard()];
  noteSeen();
  const parts = [strokes, section('Keys', keys)];
  if (TOUCHED.matches) parts.splice(1, 0, section('Gestures', GESTURES), section('Tools', tools));
  app.gallery.show('Help', ...parts.flat());
}

/**
 * @param {string} title
 * @param {(string | Node)[][]} rows what is done, and what it does
 * @returns {Node[]}
 */
function section(title, rows) {
  return [createElement('h3', {textContent: title}), createElement('dl', {}, ...rows.map(([done, does]) =>
    createElement('div', {}, createElement('dt', {}, done), createElement('dd', {}, does))))];
}
