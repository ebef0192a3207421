// SPDX-License-Identifier: Apache-2.0
/**
 * The panel at the right, of one subject at a time: a body, several, a joint, the world, or what is measured.
 *
 * It is rendered again with each scene, unless somebody works in it. On a page without room for all of it, and that
 * of a body while time runs or the large plot is open, it is folded to its first lines.
 */

import {arrangeButtons} from './align.js';
import {checkField, createElement, elementOf, iconButton, inRow, showText, textButton, textField, textOf} from './dom.js';
import {actorLines, drawWay} from './driving.js';
import {forceFields} from './force_fields.js';
import {jointContent} from './joint_panel.js';
import {sizeOf} from './label_view.js';
import {totalsOf} from './numbers.js';
import {t} from './strings.js';
import {inclineFields} from './tools/incline.js';
import {sendNote} from './tools/note.js';
import {isDrawn} from './words.js';
import {materialFields, worldContent} from './world_panel.js';

/** @import {App, SceneView} from './types.js' */

/** @typedef {'' | 'body' | 'several' | 'joint' | 'world' | 'measure'} Kind '' is a closed panel */
/**
 * @typedef {{title: string, name?: string, first?: Node[], rest: Node[], live?: (view: SceneView) => void}} Content
 *   name: of the subject, where that is not the title; first: lines that are always shown; live: shows what changes from
 *   frame to frame, and draws it
 */

export class Panel {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.element = elementOf('panel', HTMLElement);
    /** @type {Kind} */
    this.kind = '';
    /** @type {string[]} of the subject */
    this.names = [];
    /** @type {?boolean} whether it is folded, where somebody has chosen that for this subject */
    this.chosen = null;
    /** @type {(view: SceneView) => void} */
    this.live = () => {};
    this.isStale = false; // the scene has changed while somebody worked in it
    this.more = iconButton(t('More'), 'fold', () => {
      this.chosen = !this.isFolded;
      this.#fold();
      app.room.fit();
    }, t('All of this panel, or its first lines'));
    this.rest = createElement('div');
    app.connection.on('scene', () => queueMicrotask(() => this.#follow()));
    this.element.addEventListener('focusout', () => setTimeout(() => this.isStale && this.#follow()));
    app.view.overlays.push((view) => {
      this.#fold();
      if (this.kind) this.live(view);
    });
  }

  /** @returns {string} the name of the body that is its subject; '' where that is none, or several */
  get name() {
    return this.kind === 'body' ? this.names[0] : '';
  }

  /** @returns {string} the name of the joint that is its subject */
  get joint() {
    return this.kind === 'joint' ? this.names[0] : '';
  }

  get isFolded() {
    return this.element.classList.contains('folded');
  }

  /**
   * @param {Kind} kind of the subject
   * @param {string[]} names of its bodies, or of the joint
   */
  show(kind, names = []) {
    const {app} = this;
    if (kind !== this.kind || String(names) !== String(this.names)) {
      this.chosen = null;
      this.element.scrollTop = 0;
    }
    Object.assign(this, {kind, names});
    app.records.want(this, kind === 'body' ? names : []);
    this.render();
    if (kind && !app.room.isRoomy) app.lessons.card.open = false;
    app.card?.update();
    app.room?.fit();
  }

  /** Show the subject as it is now; close the panel where it is gone. */
  render() {
    const {app, element, kind, names} = this;
    this.isStale = false;
    element.hidden = !kind;
    if (!kind) return;
    /** @type {?Content} */
    const content = CONTENTS[kind](app, names);
    if (!content) {
      app.selection.select([]);
      return;
    }
    const {title, name = '', first = [], rest, live = () => {}} = content;
    this.live = live;
    this.more.hidden = !first.length;
    this.rest.replaceChildren(...rest);
    element.replaceChildren(createElement('header', {},
      createElement('h2', {}, `${title} `, createElement('small', {textContent: name})), this.more,
      iconButton(t('Close'), 'close', () => app.selection.select([]))), ...first, this.rest);
    live(app.view);
    this.#fold();
  }

  /** Follow a scene, but not while its field is typed in, or its button pressed. */
  #follow() {
    const {element} = this;
    this.isStale = this.kind !== '' && (element.contains(document.activeElement) || element.matches(':active'));
    if (!this.isStale) this.render();
  }

  #fold() {
    const {app, element} = this, inUse = this.rest.contains(document.activeElement) && !this.more.matches(':focus');
    const folded = !this.more.hidden && (this.chosen ?? (!app.room?.isRoomy || this.kind === 'body' && !inUse && (!app.world.paused || !app.plotWindow.element.hidden)));
    if (folded === this.isFolded) return;
    element.classList.toggle('folded', folded);
    this.more.setAttribute('aria-expanded', String(!folded));
  }
}

const BESIDE = 0.5; // m: where a copy is put

/**
 * @param {App} app
 * @param {string[]} names of the body alone
 * @returns {?Content} null where it is gone
 */
function bodyContent(app, [name]) {
  const body = app.world.body(name);
  if (!body) return null;
  const change = (/** @type {object} */ properties) => app.connection.send('change', {name, properties});
  const label = textField({value: body.label, onchange: () => {
    const value = textOf(label), {height = 0} = body.shape, row = app.world.row(name);
    if (body.name.startsWith('note/') && height) {
      sendNote(app, name, value, [...app.world.place(row, [0, 0]), app.world.frame.yaw[row]], height / sizeOf(app.view.ctx, body.label)[1]);
    } else change({label: value});
  }});
  const material = materialFields(body, change);
  material.find((each) => each.textContent === t('Friction'))?.append(app.numbers.pairs);
  return {
    title: app.words.title(name), name: isDrawn(name) ? name : '',
    first: [app.numbers.element, ...inclineFields(app, body), ...body.actor ? actorLines(body.actor) : [], ...body.robot ? app.driving.show(body.robot) : []],
    rest: [
      app.numbers.typed,
      ...material,
      createElement('label', {}, t('Label'), label),
      // A robot is neither.
      ...body.robot ? [] : [checkField(t('Anchored'), body.anchored, (anchored) => change({anchored})), checkField(t('Gate: lets bodies through'), body.sensor, (sensor) => change({sensor}))],
      ...forceFields(app, body, change),
      inRow(
        textButton(t('Copy'), () => copy(app, name)),
        textButton(t('Delete body'), () => app.selection.deleteSelected(), 'danger')),
      createElement('p', {hidden: body.anchored, textContent: t('Point at the body: its ring is dragged to set the velocity, the round handle to turn, the square one to scale.')}),
      ...app.trail.switches(name),
      app.plots.element,
    ],
    live: (view) => {
      app.numbers.show(name);
      drawWay(view, app.world, name);
    },
  };
}

/**
 * @param {App} app
 * @param {string[]} names
 * @returns {Content}
 */
function severalContent(app, names) {
  const totals = createElement('p', {className: 'numbers'});
  return {title: t('{count} bodies', {count: names.length}), first: [totals], live: () => showText(totals, totalsOf(app.world, names)), rest: [
    createElement('p', {textContent: t('Drag them with the lasso.')}),
    inRow(textButton(t('Copy beside'), () => {
      const [left, , right] = app.world.boundsOfAll(names);
      app.connection.send('copy_machine', {names, by: [right - left + BESIDE, 0]});
    }), textButton(t('Plot them'), () => app.plotWindow.open(names)), textButton(t('Delete bodies'), () => app.selection.deleteSelected(), 'danger')),
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

/** Of each kind of subject, by its names; null where that is gone. @type {Record<Exclude<Kind, ''>, (app: App, names: string[]) => ?Content>} */
const CONTENTS = {body: bodyContent, several: severalContent, joint: jointContent, world: worldContent, measure: ({stopwatch}) => stopwatch.content()};
