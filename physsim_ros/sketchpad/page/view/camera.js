// SPDX-License-Identifier: Apache-2.0
/** The part of the world that is shown: metres, y up, to pixels of the page, y down. */

import {roundUp} from '../rounding.js';

/** @import {Bounds, Point} from '../types.js' */

const LEAST_SCALE = 1e-5, GREATEST_SCALE = 5000; // px/m; bodies are at most 1e7 m from the origin
const LEAST_STEP = 70; // px between labelled lines of the grid
const LEAST_SPAN = 3; // m; nothing smaller fills the page at first

export class Camera {
  constructor() {
    this.x = this.y = 0; // the middle of the page [m]
    this.scale = 60; // px/m
    this.width = this.height = 1; // of the page [px]
    this.fitted = false; // nobody has moved the view since
    this.whole = 60; // scale that was fitted last [px/m]
  }

  /** @returns {number} from one labelled line of the grid to the next [m] */
  get gridStep() {
    return roundUp(LEAST_STEP / this.scale);
  }

  /** @returns {number} from one fine line to the next [m] */
  get fineStep() {
    return this.gridStep / 5;
  }

  /**
   * @param {number} x [m]
   * @param {number} y [m]
   * @returns {Point} [px]
   */
  toPage(x, y) {
    return [this.width / 2 + (x - this.x) * this.scale, this.height / 2 - (y - this.y) * this.scale];
  }

  /**
   * @param {number} px [px]
   * @param {number} py [px]
   * @returns {Point} [m]
   */
  toWorld(px, py) {
    return [this.x + (px - this.width / 2) / this.scale, this.y - (py - this.height / 2) / this.scale];
  }

  /**
   * @param {number} dx [px]
   * @param {number} dy [px]
   */
  pan(dx, dy) {
    this.fitted = false;
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
  }

  /**
   * @param {number} px the place that stays [px]
   * @param {number} py [px]
   * @param {number} factor
   */
  zoom(px, py, factor) {
    this.fitted = false;
    const [x, y] = this.toWorld(px, py);
    this.scale = Math.min(Math.max(this.scale * factor, LEAST_SCALE), GREATEST_SCALE);
    const [nowX, nowY] = this.toWorld(px, py);
    this.x += x - nowX;
    this.y += y - nowY;
  }

  /**
   * @param {Bounds} box
   * @param {{left: number, top: number, right: number, bottom: number}} insets covered [px]
   */
  fit([xmin, ymin, xmax, ymax], insets) {
    const width = this.width - insets.left - insets.right;
    const height = this.height - insets.top - insets.bottom;
    this.scale = Math.max(Math.min(width / (xmax - xmin || 1), height / (ymax - ymin || 1), Math.max(width, height) / LEAST_SPAN), LEAST_SCALE);
    this.whole = this.scale;
    this.x = (xmin + xmax) / 2 + (insets.right - insets.left) / 2 / this.scale;
    this.y = (ymin + ymax) / 2 + (insets.top - insets.bottom) / 2 / this.scale;
  }
}
