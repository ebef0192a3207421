// SPDX-License-Identifier: Apache-2.0
/** The columns of frames that the server sends, since somebody here wants them. */

/** @import {Parts} from './types.js' */

/** @typedef {{velocities?: boolean, contacts?: boolean, laser?: string}} Wanted laser: name of a robot */

export class FrameColumns {
  /** @param {Parts<'connection'>} parts */
  constructor({connection}) {
    this.connection = connection;
    /** @type {Map<object, Wanted>} by who wants them */
    this.wanted = new Map();
    this.asked = ''; // of this socket, as text
    connection.on('welcome', () => {
      this.asked = '';
      this.#ask();
    });
  }

  /**
   * @param {object} by who wants them
   * @param {Wanted} wanted
   */
  want(by, wanted) {
    this.wanted.set(by, wanted);
    this.#ask();
  }

  #ask() {
    const all = [...this.wanted.values()], show = {velocities: all.some(({velocities}) => velocities),
      contacts: all.some(({contacts}) => contacts), forces: true, laser: all.find(({laser}) => laser)?.laser ?? ''};
    if (JSON.stringify(show) !== this.asked && this.connection.send('show', show)) this.asked = JSON.stringify(show);
  }
}
