// SPDX-License-Identifier: Apache-2.0
/** The table of tools: a tool of its own is a class that is made here; a tool of clicks says here how many and what for. */

import {ClickTool} from './click_tool.js';
import {Lasso, Pen} from './freehand.js';
import {Hand} from './hand.js';
import {InclineTool} from './incline.js';
import {Protractor, Ruler} from './measuring.js';
import {Note} from './note.js';
import {Prediction} from './prediction.js';
import {t} from '../strings.js';
import {WaterTool} from './water.js';

/** @import {ClickUse, Tool, ToolParts} from '../types.js' */

/** @typedef {{id: string, name: string, key: string, keyName: string, hint: string, make: (parts: ToolParts) => Tool}} Entry id: of its icon, too; keyName: as help tells it */

/**
 * @param {string} id
 * @param {string} name
 * @param {string} key
 * @param {string} hint how it is used, after its name
 * @param {ClickUse | (new (parts: ToolParts) => Tool)} use of a tool of clicks; the class of another one
 * @returns {Entry}
 */
function tool(id, name, key, hint, use) {
  return {id, name, key: key.replace('Shift+', ''), keyName: key.length > 1 ? key : key.toUpperCase(), hint, make: (parts) => typeof use === 'function' ? new use(parts) : new ClickTool(parts, id, use)};
}

/** In the groups of the toolbar. */
export const TOOLS = [[
  tool('pen', t('Pen'), 'p', t('draw freely: circles, boxes, lines; a zigzag is a spring, a small circle an axle, an x an anchor'), Pen),
  tool('hand', t('Hand'), 'h', t('drag and throw bodies; tap one to change it'), Hand),
  tool('lasso', t('Lasso'), 's', t('select several bodies, to drag or delete them'), Lasso),
], [
  tool('circle', t('Circle'), 'c', t('from the centre to the rim'), {clicks: 2}),
  tool('circle_diameter', t('Circle by diameter'), 'd', t('from edge to edge'), {clicks: 2}),
  tool('rectangle', t('Rectangle'), 'b', t('drag from corner to corner, or click three'), {clicks: 3, angled: true}),
  tool('polygon', t('Polygon'), 'g', t('click each corner; click the first one again to close it'), {clicks: Infinity}),
  tool('wall', t('Wall'), 'w', t('a fixed line'), {clicks: 2, angled: true}),
  tool('incline', t('Inclined plane'), '3', t('drag along the slope, or tap; its panel has its angle and length'), InclineTool),
  tool('water', t('Water'), 'Shift+W', t('drag from corner to corner: bodies float in it'), WaterTool),
], [
  tool('anchor', t('Anchor'), 'a', t('fix a body to the background'), {clicks: 1, aims: 'accent'}),
  tool('release', t('Release'), 'e', t('remove anchor, pins and axles of a body'), {clicks: 1, aims: 'accent'}),
  tool('pin', t('Pin'), 'i', t('weld two bodies'), {clicks: 1, aims: 'accent'}),
  tool('axle', t('Axle'), 'x', t('let two bodies turn about a point'), {clicks: 1, aims: 'accent'}),
  tool('spring', t('Spring'), 'z', t('from body to body, or to the background'), {clicks: 2, joins: true}),
  tool('rod', t('Rod'), 'o', t('keeps two points at a distance'), {clicks: 2, joins: true}),
  tool('rope', t('Rope'), 'y', t('pulls, but does not push'), {clicks: 2, joins: true}),
  tool('pulley', t('Pulley'), 'Shift+Y', t('a rope: click its end, each wheel or ring that it passes, and its other end twice'), {clicks: Infinity, joins: true}),
  tool('slider', t('Slider'), 'Shift+S', t('from a body along its rail, to another body or the background'), {clicks: 2, joins: true}),
  tool('gear', t('Gears'), 'Shift+G', t('one wheel, then the other'), {clicks: 2, joins: true}),
  tool('rack', t('Rack and pinion'), 'Shift+T', t('a wheel, then the bar that it rolls on'), {clicks: 2, joins: true}),
  tool('chain', t('Chain'), '8', t('links from end to end; for a slack one, draw it with the pen as a rope'), {clicks: 2, joins: true}),
], [
  tool('velocity', t('Velocity'), 'v', t('drag an arrow from a body: 1 m is 1 m/s'), {clicks: 2, angled: true, arrow: true, aims: 'accent'}),
  tool('gravity', t('Gravity'), 'u', t('drag an arrow: that way is down'), {clicks: 2, angled: true, arrow: true}),
  tool('force', t('Force'), '1', t('drag an arrow from a point of a body: 1 m is a constant force of 10 N'), {clicks: 2, angled: true, arrow: true, aims: 'accent'}),
  tool('knife', t('Knife'), '2', t('drag right through bodies: they are cut'), {clicks: 2, angled: true}),
  tool('delete', t('Delete'), 't', t('remove a body'), {clicks: 1, aims: 'warn'}),
], [
  tool('ruler', t('Ruler'), 'm', t('drag from point to point; tap it to remove it'), Ruler),
  tool('protractor', t('Protractor'), 'q', t('drag from the corner along one side, then click the other one; tap it to remove it'), Protractor),
  tool('predict', t('Predict'), '4', t('draw from a body the way that it will go, then play; tap the body to remove it'), Prediction),
  tool('note', t('Note'), '9', t('press where it is to be, type, Enter'), Note),
]];
