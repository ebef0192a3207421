// SPDX-License-Identifier: Apache-2.0
/** The dialog over the page: worlds, help, people, a link. It shows one thing at a time, by its title. */

import {createElement, elementOf, iconButton, replaceContent} from '../dom.js';
import {t} from '../strings.js';

const PRESSED = 200; // ms until it is looked again whether the dialog is still pressed

export class Dialog {
  constructor() {
    this.element = elementOf('dialog', HTMLDialogElement);
    let beside = false; // was pressed; a text in it may be selected beyond its edge
    this.element.addEventListener('pointerdown', ({clientX, clientY}) => {
      const {left, right, top, bottom} = this.element.getBoundingClientRect();
      beside = clientX < left || clientX > right || clientY < top || clientY > bottom;
    });
    this.element.addEventListener('click', () => beside && this.close());
  }

  get isOpen() {
    return this.element.open;
  }

  /**
   * @param {string} title
   * @param {Node[]} content whose field with `autofocus` can be typed over, or copied, at once
   */
  show(title, ...content) {
    const {element} = this, top = this.#shows(title) ? element.scrollTop : 0;
    element.ariaLabel = title;
    replaceContent(element, createElement('header', {}, createElement('h2', {}, title),
      iconButton(t('Close'), 'close', () => this.close(), '')),
    ...content);
    if (!element.open) element.showModal();
    element.scrollTop = top;
    const field = element.querySelector('input[autofocus]');
    if (!(field instanceof HTMLInputElement)) return;
    field.focus();
    field.select();
  }

  /**
   * Show what has changed, where the dialog shows that; but not while it is pressed: its button would be gone when it is let go.
   * @param {string} title
   * @param {() => void} show
   */
  renew(title, show) {
    if (!this.#shows(title)) return;
    if (this.element.matches(':active')) setTimeout(() => this.renew(title, show), PRESSED);
    else show();
  }

  close() {
    this.element.close();
  }

  /** @param {string} title */
  #shows(title) {
    return this.element.open && this.element.ariaLabel === title;
  }
}
