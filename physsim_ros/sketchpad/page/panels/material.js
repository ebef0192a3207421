// SPDX-License-Identifier: Apache-2.0
/** The material of the next drawings of this page. */

/** @import {Parts} from '../types.js' */

export class Material {
  /** @param {Parts<'connection' | 'people'>} parts */
  constructor({connection, people}) {
    this.connection = connection;
    /** @type {Record<string, any>} properties that this page has chosen; others are the world's */
    this.chosen = {};
    /** @type {?string | number[]} where this page chose none */
    this.worldColor = null;
    connection.on('welcome', ({settings = {}}) => {
      this.worldColor = settings.draw_color ?? null;
      // The server knows this page as a new one, without a material.
      if (Object.keys(this.chosen).length && !people.viewOnly) connection.send('draw_with', this.chosen);
    });
  }

  /** @returns {?string | number[]} */
  get color() {
    return this.chosen.color ?? this.worldColor;
  }

  /** @param {Record<string, any>} properties */
  async change(properties) {
    const before = this.chosen;
    this.chosen = {...before, ...properties};
    if (!(await this.connection.ask('draw_with', properties)).ok) this.chosen = before;
  }
}
