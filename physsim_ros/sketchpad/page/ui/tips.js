// SPDX-License-Identifier: Apache-2.0
/** Tips: the title of a button, beside it, as soon as it is pointed at, reached by Tab, or a finger stays on it. */

import {createElement} from '../dom.js';

const HELD = 500; // ms that a finger stays on a button to ask what it does
const GAP = 8; // px between a button and its tip, and to the edges of the page

export class Tips {
  constructor() {
    this.tip = document.body.appendChild(createElement('div', {id: 'tip', role: 'tooltip', hidden: true}));
    /** @type {?HTMLElement} whose title is shown; it has none meanwhile, or the browser would show it too */
    this.owner = null;
    this.timer = 0;
    this.asked = false; // by a finger, what a button does
    document.addEventListener('pointerover', ({target, pointerType}) =>
      pointerType !== 'touch' && this.#show(target));
    document.addEventListener('focusin', ({target}) =>
      target instanceof Element && target.matches(':focus-visible') && this.#show(target));
    document.addEventListener('pointerdown', ({target, pointerType}) => {
      this.asked = false;
      if (pointerType === 'touch') this.timer = setTimeout(() => this.#ask(target), HELD);
    });
    document.addEventListener('pointerup', () => clearTimeout(this.timer));
    document.addEventListener('click', (event) => {
      if (!this.asked) return;
      event.preventDefault();
      event.stopImmediatePropagation();
      this.#hide();
    }, true);
    for (const type of ['pointercancel', 'pointerdown', 'focusout', 'keydown', 'scroll', 'wheel']) {
      document.addEventListener(type, () => this.#hide(), true);
    }
  }

  /** @param {?EventTarget} target */
  #show(target) {
    const owner = target instanceof Element ? /** @type {?HTMLElement} */ (target.closest('button, a')) : null;
    if (owner === this.owner) return;
    this.#hide();
    if (!owner?.title) return;
    this.owner = owner;
    this.tip.textContent = owner.title;
    owner.title = '';
    owner.setAttribute('aria-describedby', 'tip');
    this.tip.hidden = false;
    const {left, right, top, bottom, width, height} = owner.getBoundingClientRect();
    const tip = this.tip.getBoundingClientRect();
    const tools = owner.closest('#tools'), column = tools && tools.clientHeight > tools.clientWidth;
    const x = column ? right + GAP : left + (width - tip.width) / 2;
    const y = column ? top + (height - tip.height) / 2 : top > innerHeight / 2 ? top - tip.height - GAP : bottom + GAP;
    this.tip.style.left = `${Math.max(Math.min(x, innerWidth - tip.width - GAP), GAP)}px`;
    this.tip.style.top = `${y}px`;
  }

  /** @param {?EventTarget} target of a finger that stays: its button says what it does, and does nothing */
  #ask(target) {
    this.#show(target);
    this.asked = this.owner !== null;
  }

  #hide() {
    clearTimeout(this.timer);
    this.tip.hidden = true;
    if (this.owner && !this.owner.title) this.owner.title = this.tip.textContent ?? '';
    this.owner?.removeAttribute('aria-describedby');
    this.owner = null;
  }
}
