// SPDX-License-Identifier: Apache-2.0
/** What parts of the page listen to: events by their type. */

export class Emitter {
  /** @type {Map<string, ((event: any) => void)[]>} */
  #listeners = new Map();

  /**
   * @param {string} type
   * @param {(event: any) => void} listener
   */
  on(type, listener) {
    this.#listeners.set(type, [...this.#listeners.get(type) ?? [], listener]);
  }

  /**
   * @param {string} type
   * @param {any} event
   */
  emit(type, event = null) {
    for (const listener of this.#listeners.get(type) ?? []) listener(event);
  }
}
