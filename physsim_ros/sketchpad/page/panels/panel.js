// SPDX-License-Identifier: Apache-2.0
/**
 * The panel at the right, of one subject at a time: a body, several, a joint, the world, or what is measured.
 *
 * It is rendered again with each scene and each refusal, unless somebody works in it. On a page without room for all of
 * it, and that of a body while time runs or the large plot is open, it is folded to its first lines.
 */

import {bodyContent} from './body_panel.js';
import {createElement, elementOf, iconButton} from '../dom.js';
import {jointContent} from './joint_panel.js';
import {severalContent} from './several_panel.js';
import {t} from '../strings.js';
import {worldContent} from './world_panel.js';

/** @import {App, SceneView} from '../types.js' */

/** @typedef {'' | 'body' | 'several' | 'joint' | 'world' | 'measure'} Kind '' is a closed panel */
/**
 * @typedef {{title: string, name?: string, first?: Node[], rest: Node[], live?: (view: SceneView) => void}} Content
 *   name: of the subject, where that is not the title; first: lines that are always shown; live: shows what changes from
 *   frame to frame, and draws it
 */

/** Of each kind of subject, by its names; null where that is gone. @type {Record<Exclude<Kind, ''>, (app: App, names: string[]) => ?Content>} */
const CONTENTS = {body: bodyContent, several: severalContent, joint: jointContent, world: worldContent, measure: ({stopwatch}) => stopwatch.content()};

export class Panel {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.element = elementOf('panel');
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
    const followSoon = () => queueMicrotask(() => this.#follow());
    app.connection.on('scene', followSoon);
    // A field still shows what was refused.
    app.connection.on('answer', ({request, ok}) => request && !ok && followSoon());
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
      createElement('h2', {}, `${title} `, createElement('small', {}, name)), this.more,
      iconButton(t('Close'), 'close', () => app.selection.select([]))), ...first, this.rest);
    live(app.view);
    this.#fold();
  }

  /** Show the subject as it is, but not while its field is typed in, or its button pressed. */
  #follow() {
    const {element} = this;
    this.isStale = this.kind !== '' && (element.contains(document.activeElement) || element.matches(':active'));
    if (!this.isStale) this.render();
  }

  #fold() {
    const {app, element} = this, inUse = this.rest.contains(document.activeElement) && !this.more.matches(':focus');
    const isWatched = !app.world.paused || !app.plotWindow.element.hidden;
    const usual = !app.room?.isRoomy || this.kind === 'body' && !inUse && isWatched;
    const folded = !this.more.hidden && (this.chosen ?? usual);
    if (folded === this.isFolded) return;
    element.classList.toggle('folded', folded);
    this.more.setAttribute('aria-expanded', String(!folded));
  }
}
