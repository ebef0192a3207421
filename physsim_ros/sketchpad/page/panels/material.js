// SPDX-License-Identifier: Apache-2.0
/** The material of the next drawings of this page. */

/** @import {Parts} from '../types.js' */

export class Material {
  /** @param {Parts<'connection' | 'people'>} parts */
  constructor({connection, people}) {
    this.connection = connection;
    /** @type {Record<string, any>} properties that the server knows of */
    this.known = {};
    /** @type {Record<string, any>[]} changes that are not answered */
    this.asked = [];
    /** @type {?string | number[]} where this page chose none */
    this.worldColor = null;
    connection.on('welcome', ({settings = {}}) => {
      this.worldColor = settings.draw_color ?? null;
      // A server that was started anew knows no material of this page; none answers what was asked before.
      [this.known, this.asked] = [this.chosen, []];
      if (Object.keys(this.known).length && !people.viewOnly) connection.send('draw_with', this.known);
    });
  }

  /** @returns {Record<string, any>} properties that this page has chosen; others are the world's */
  get chosen() {
    return Object.assign({}, this.known, ...this.asked);
  }

  /** @returns {?string | number[]} */
  get color() {
    return this.chosen.color ?? this.worldColor;
  }

  /** @param {Record<string, any>} properties */
  async change(properties) {
    this.asked.push(properties);
    const {ok} = await this.connection.ask('draw_with', properties);
    this.asked.splice(this.asked.indexOf(properties), 1);
    if (ok) Object.assign(this.known, properties);
  }
}
