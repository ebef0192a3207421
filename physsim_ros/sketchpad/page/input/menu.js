// SPDX-License-Identifier: Apache-2.0
/**
 * The menu at a place of the canvas, by a click of the right button or the key for menus: what can be done with the
 * body there, or with the world (WAI-ARIA, pattern *Menu*).
 */

import {createElement, textButton} from '../dom.js';
import {t} from '../strings.js';

/** @import {Parts, Point} from '../types.js' */

const GAP = 4; // px to the edges of the page

export class Menu {
  /** @param {Parts<'camera' | 'people' | 'plotting' | 'pointers' | 'room' | 'selection' | 'view' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.element = document.body.appendChild(createElement('div', {id: 'menu', role: 'menu', 'aria-label': t('Menu'), hidden: true}));
    parts.pointers.on('press', () => this.close());
    // What has the focus then keeps it.
    this.element.addEventListener('focusout', ({relatedTarget}) => { this.element.hidden ||= !this.element.contains(/** @type {?Node} */ (relatedTarget)); });
    this.element.addEventListener('keydown', (event) => this.#move(event));
  }

  /** @param {Point} page where it is opened [px] */
  open([x, y]) {
    const {parts, element} = this, {selection, world, camera} = parts, at = camera.toWorld(x, y), name = world.nameAt({at, slop: 0});
    if (parts.people.viewOnly) return;
    if (name && !selection.names.has(name)) selection.select([name]);
    const item = (/** @type {string} */ label, /** @type {() => void} */ done) => {
      const button = textButton(label, () => {
        this.close();
        done();
      });
      button.role = 'menuitem';
      return button;
    };
    const names = [...selection.names];
    element.replaceChildren(...name ? [
      item(t('Copy (Ctrl+C)'), () => selection.keep(false)), item(t('Cut (Ctrl+X)'), () => selection.keep(true)),
      item(t('Duplicate (Ctrl+D)'), () => selection.duplicate()), item(t('Plot'), () => parts.plotting.open(names)),
      item(t('Delete (Del)'), () => selection.deleteSelected())] : [],
    ...selection.kept.names.length ? [item(t('Paste (Ctrl+V)'), () => selection.paste(at))] : [],
    ...name ? [] : [item(t('Select all (Ctrl+A)'), () => selection.selectAll()), item(t('Frame the world (F)'), () => parts.room.frameAll())]);
    element.hidden = false;
    // The view makes room for the panel of what was selected.
    [x, y] = camera.toPage(...at);
    element.style.left = `${Math.min(x, innerWidth - element.offsetWidth - GAP)}px`;
    element.style.top = `${Math.min(y, innerHeight - element.offsetHeight - GAP)}px`;
    element.querySelector('button')?.focus();
  }

  close() {
    if (this.element.hidden) return;
    this.element.hidden = true;
    this.parts.view.canvas.focus({preventScroll: true});
  }

  /** @param {KeyboardEvent} event */
  #move(event) {
    const all = [...this.element.querySelectorAll('button')], at = all.findIndex((each) => each === document.activeElement);
    if (event.key === 'Escape' || event.key === 'Tab') this.close();
    else if (event.key === 'ArrowDown') all[(at + 1) % all.length].focus();
    else if (event.key === 'ArrowUp') all.at(at - 1)?.focus();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
