// SPDX-License-Identifier: Apache-2.0
/**
 * The panel at the right, of one subject at a time: a body, several, a joint, the world, or what is measured.
 *
 * It is rendered again with each scene and each refusal, unless somebody works in it. It opens on its first lines, the
 * numbers; what can be changed is behind one line, until somebody unfolds it.
 */

import {createElement, elementOf, fold, foldButton, iconButton, replaceContent} from '../dom.js';
import {isRoomy} from '../view/room.js';
import {t} from '../strings.js';

/** @import {Kind} from '../input/selection.js' */
/** @import {Parts, SceneView} from '../types.js' */

/**
 * @typedef {{title: string, name?: string, first?: Node[], rest: Node[], live?: (view: SceneView) => void}} Content
 *   name: of the subject, where that is not the title; first: lines that are always shown; live: shows what changes from
 *   frame to frame, and draws it
 */

/**
 * What the panel shows of a subject of each kind, by its names; null where that is gone. `render` shows the panel again.
 * @typedef {Record<Exclude<Kind, ''>, (names: string[], render: () => void) => ?Content>} Contents
 */

const UNFOLDED = 'physsim-panel'; // key

export class Panel {
  /**
   * @param {Parts<'connection' | 'room' | 'selection' | 'view'>} parts
   * @param {Contents} contents
   */
  constructor(parts, contents) {
    this.parts = parts;
    this.contents = contents;
    this.element = elementOf('panel');
    this.shown = ''; // kind and names of the subject
    /** As somebody has chosen in this browser; a small page has no room for all of it at once. */
    this.unfolded = localStorage.getItem(UNFOLDED) === '1' && isRoomy();
    /** @type {(view: SceneView) => void} */
    this.live = () => {};
    this.isStale = false; // the scene has changed while somebody worked in it
    this.more = foldButton(this.element, t('More'), (folded) => {
      this.unfolded = !folded;
      localStorage.setItem(UNFOLDED, folded ? '0' : '1');
      parts.room.fit();
    }, t('More'));
    const followSoon = () => queueMicrotask(() => this.#follow());
    parts.connection.on('scene', followSoon);
    parts.selection.on('change', () => this.#show());
    // A field still shows what was refused.
    parts.connection.on('answer', ({request, ok}) => request && !ok && followSoon());
    this.element.addEventListener('focusout', () => setTimeout(() => this.isStale && this.#follow()));
    parts.view.overlays.push((view) => {
      if (parts.selection.kind) this.live(view);
    });
  }

  #show() {
    const {kind, subject} = this.parts.selection, shown = `${kind} ${subject}`;
    if (shown !== this.shown) this.element.scrollTop = 0;
    this.shown = shown;
    this.render();
  }

  /** Close it, as somebody has asked. */
  close() {
    this.parts.selection.select([]);
    this.parts.room.fit();
  }

  /** Show the subject as it is now; close the panel where it is gone. */
  render() {
    const {parts, element} = this, {kind, subject} = parts.selection;
    this.isStale = false;
    element.hidden = !kind;
    if (!kind) return;
    const content = this.contents[kind](subject, () => this.render());
    if (!content) {
      parts.selection.select([]);
      return;
    }
    const {title, name = '', first = [], rest, live = () => {}} = content;
    this.live = live;
    this.more.hidden = !first.length;
    replaceContent(element, createElement('header', {},
      createElement('h2', {}, `${title} `, createElement('small', {}, name)),
      iconButton(t('Close'), 'close', () => this.close())), ...first, this.more, createElement('div', {className: 'rest'}, ...rest));
    live(parts.view);
    fold(element, this.more, first.length > 0 && !this.unfolded);
  }

  /** Show the subject as it is, but not while its field is typed in, or its button pressed. */
  #follow() {
    const {element} = this;
    this.isStale = this.parts.selection.kind !== '' && (element.contains(document.activeElement) || element.matches(':active'));
    if (!this.isStale) this.render();
  }
}
