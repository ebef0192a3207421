// SPDX-License-Identifier: Apache-2.0
/** The people in this world, as the server tells them, and who is at this page. */

import {t} from './strings.js';

/** @import {Classmate, Parts} from './types.js' */

export const NAME = 'physsim-name'; // key of the name of the person at this page
export const TEACHER = 'Teacher'; // name of a teacher without another one

export class People {
  /** @param {Parts<'connection' | 'pointers' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.page = 0; // number of this one
    this.teacher = false;
    /** @type {{frozen: boolean, locked: string[], people: Classmate[], watched: boolean}} */
    this.state = {frozen: false, locked: [], people: [], watched: false};
    this.viewOnly = false; // this page shows the world, and changes nothing
    this.#show(new URLSearchParams(location.search).has('view'));
    parts.connection.on('welcome', ({client, teacher, view_only: viewOnly}) => {
      this.page = Number(client);
      this.teacher = Boolean(teacher);
      this.#show(this.viewOnly || Boolean(viewOnly));
    });
    parts.connection.on('class', (state) => { this.state = state; });
  }

  /** @param {boolean} viewOnly */
  #show(viewOnly) {
    this.viewOnly = this.parts.pointers.onlyMoves = viewOnly;
    document.body.classList.toggle('view', viewOnly);
  }

  /** @returns {boolean} whether several people draw in this world */
  get isShared() {
    return this.state.people.length > 1;
  }

  /**
   * @param {number | undefined} page
   * @returns {string} the name of the person there, as the server has it; '' where it is nobody, or this page
   */
  nameOf(page) {
    return this.state.people.find((each) => each.page === page && page !== this.page)?.name ?? '';
  }

  /**
   * @param {string} stem of a body that a tool of this page adds
   * @returns {string} its name: of the numbers that are free, pages take turns, so that no two choose the same one at once
   */
  freeName(stem) {
    const {people} = this.state, taken = new Set(this.parts.world.scene.bodies.map(({name}) => name));
    let number = 1 + Math.max(people.findIndex(({page}) => page === this.page), 0);
    while (taken.has(`${stem}/${number}`)) number += people.length || 1;
    return `${stem}/${number}`;
  }
}

/** @returns {string} that the person at this page has chosen; '' where it is none */
export function ownName() {
  return localStorage.getItem(NAME) ?? '';
}

/**
 * @param {string} name of a person, as the server has it
 * @returns {string} as it is shown: of who has chosen none, in the language of this page
 */
export function personWord(name) {
  const [, number] = /^Page (\d+)$/.exec(name) ?? [];
  return number ? t('Page {number}', {number}) : name === TEACHER ? t('Teacher') : name;
}
