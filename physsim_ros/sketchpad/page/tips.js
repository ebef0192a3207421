// SPDX-License-Identifier: Apache-2.0
/** Tips: the title of a button, beside it, as soon as it is pointed at or reached by Tab. */

import {createElement} from './dom.js';

const GAP = 8; // px between a button and its tip, and to the edges of the page

export class Tips {
  /** @param {import('./camera.js').Camera} camera */
  constructor(camera) {
    this.camera = camera;
    this.tip = document.body.appendChild(createElement('div', {id: 'tip', role: 'tooltip', hidden: true}));
    /** @type {?HTMLElement} whose title is shown; meanwhile it has none, so that the browser shows no second */
    this.owner = null;
    document.addEventListener('pointerover', ({target, pointerType}) =>
      pointerType !== 'touch' && this.#show(target));
    document.addEventListener('focusin', ({target}) =>
      target instanceof Element && target.matches(':focus-visible') && this.#show(target));
    for (const type of ['pointerdown', 'focusout', 'keydown', 'scroll', 'wheel']) {
      document.addEventListener(type, () => this.#hide(), true);
    }
  }

  /** @param {?EventTarget} target */
  #show(target) {
    const owner = target instanceof Element ?
      /** @type {?HTMLElement} */ (target.closest('button, a')) : null;
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
    const column = owner.closest('#tools') && !this.camera.narrow;
    const x = column ? right + GAP : left + (width - tip.width) / 2;
    const y = column ? top + (height - tip.height) / 2 :
      top > innerHeight / 2 ? top - tip.height - GAP : bottom + GAP;
    this.tip.style.left = `${Math.max(Math.min(x, innerWidth - tip.width - GAP), GAP)}px`;
    this.tip.style.top = `${y}px`;
  }

  #hide() {
    this.tip.hidden = true;
    if (this.owner && !this.owner.title) this.owner.title = this.tip.textContent ?? '';
    this.owner?.removeAttribute('aria-describedby');
    this.owner = null;
  }
}
