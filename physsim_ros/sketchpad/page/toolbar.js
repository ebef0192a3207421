// SPDX-License-Identifier: Apache-2.0
/** The tools: their names, keys and hints, and the bar at the left. */

import {createElement, elementOf, iconButton} from './dom.js';
import {ClickTool} from './tools/click_tool.js';
import {Lasso, Pen} from './tools/freehand.js';
import {Hand} from './tools/hand.js';
import {Protractor, Ruler} from './tools/measuring.js';
import {Note} from './tools/note.js';

/** @import {App, Tool} from './types.js' */

/** Groups of tools: id, name, key, hint. @type {[string, string, string, string][][]} */
export const TOOLS = [[
  ['pen', 'Pen', 'p', 'draw freely: circles, boxes, lines; a zigzag is a spring, a small circle an axle, an x an anchor'],
  ['hand', 'Hand', 'h', 'drag and throw bodies; tap one to change it'],
  ['lasso', 'Lasso', 's', 'select several bodies, to drag or delete them'],
], [
  ['circle', 'Circle', 'c', 'from the centre to the rim'],
  ['circle_diameter', 'Circle by diameter', 'd', 'from edge to edge'],
  ['rectangle', 'Rectangle', 'b', 'drag from corner to corner, or click three'],
  ['polygon', 'Polygon', 'g', 'click each corner; click the first one again to close it'],
  ['wall', 'Wall', 'w', 'a fixed line'],
], [
  ['anchor', 'Anchor', 'a', 'fix a body to the background'],
  ['release', 'Release', 'e', 'remove anchor, pins and axles of a body'],
  ['pin', 'Pin', 'i', 'weld two bodies'],
  ['axle', 'Axle', 'x', 'let two bodies turn about a point'],
  ['spring', 'Spring', 'z', 'from body to body, or to the background'],
  ['rod', 'Rod', 'o', 'keeps two points at a distance'],
  ['rope', 'Rope', 'y', 'pulls, but does not push'],
  ['chain', 'Chain', '8', 'links from end to end; for a slack one, draw it with the pen as a rope'],
], [
  ['velocity', 'Velocity', 'v', 'drag an arrow from a body: 1 m is 1 m/s'],
  ['gravity', 'Gravity', 'u', 'drag an arrow: that way is down'],
  ['force', 'Force', '1', 'drag an arrow from a point of a body: 1 m is a constant force of 10 N'],
  ['knife', 'Knife', '2', 'drag right through bodies: they are cut'],
  ['delete', 'Delete', 't', 'remove a body'],
], [
  ['ruler', 'Ruler', 'm', 'drag from point to point; tap it to remove it'],
  ['protractor', 'Protractor', 'q', 'drag from the corner along one side, then click the other one; tap it to remove it'],
  ['note', 'Note', '9', 'press where it is to be, type, Enter'],
]];

/** @type {Record<string, new (app: App) => Tool>} */
const OWN = {pen: Pen, hand: Hand, lasso: Lasso, note: Note, ruler: Ruler, protractor: Protractor};

export class Toolbar {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {Map<string, {tool: Tool, button: HTMLButtonElement}>} */
    this.tools = new Map();
    const bar = elementOf('tools', HTMLElement);
    for (const group of TOOLS) {
      const box = createElement('div', {role: 'group'});
      for (const [id, name, key, hint] of group) {
        const button = iconButton(name, id, () => this.selectTool(id), `${name} (${key.toUpperCase()}): ${hint}`);
        this.tools.set(id, {tool: OWN[id] ? new OWN[id](app) : new ClickTool(app, id), button});
        box.append(button);
      }
      bar.append(box);
    }
    bar.lastElementChild?.append(iconButton('Measure', 'measure', () => {
      app.selection.select([]);
      app.panel.show('measure');
    }, 'Stopwatch with gates, counter of collisions'));
    this.#select('pen');
  }

  /**
   * Select a tool, and say how it is used.
   * @param {string} id
   */
  selectTool(id) {
    this.#select(id);
    const [, name, , hint] = TOOLS.flat().find(([each]) => each === id) ?? ['', '', '', ''];
    this.app.hints.showTool(`${name}: ${hint}.`);
  }

  /** @param {string} id */
  #select(id) {
    const selected = this.tools.get(id);
    if (!selected) return;
    this.app.tool?.cancel();
    this.app.tool = selected.tool;
    this.app.view.canvas.dataset.tool = id;
    for (const [each, {button}] of this.tools) button.setAttribute('aria-pressed', String(each === id));
    this.app.view.dirty = true;
  }
}
