// SPDX-License-Identifier: Apache-2.0
/** Lines, rings, arrows and texts on a canvas, at places of the world or of the page. */

import {readPalette} from './theme.js';

/** @import {Camera, Point} from '../types.js' */
/** @import {Box} from './clearance.js' */

const HEAD = 9, RIM = 1.5; // px: head of an arrow, and the rim of paper around it
const ASIDE = 14; // px from a pointer to what is written beside it

export class CanvasPainter {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {Camera} camera
   */
  constructor(canvas, camera) {
    this.canvas = canvas;
    this.camera = camera;
    this.ctx = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d', {alpha: false}));
    this.palette = readPalette();
    /** Boxes of what is written, of the legend and the panel; no number is put there. @type {Box[]} */
    this.covered = [];
  }

  /**
   * @param {Point[]} points [m]
   * @param {string} color
   * @param {number[]} dash [px]
   */
  line(points, color, dash = []) {
    const {ctx} = this;
    ctx.strokeStyle = color;
    ctx.lineWidth = 2.5;
    ctx.lineCap = ctx.lineJoin = 'round';
    ctx.setLineDash(dash);
    this.polyline(points.map((point) => this.camera.toPage(...point)));
    ctx.setLineDash([]);
  }

  /** @param {Point[]} points of the canvas */
  polyline(points) {
    this.ctx.beginPath();
    for (const [x, y] of points) this.ctx.lineTo(x, y);
    this.ctx.stroke();
  }

  /**
   * @param {Point} center [m]
   * @param {number} radius [px]
   * @param {string} color
   */
  ring(center, radius, color) {
    const {ctx} = this, [x, y] = this.camera.toPage(...center);
    ctx.strokeStyle = color;
    ctx.lineWidth = 2.5;
    ctx.beginPath();
    ctx.arc(x, y, radius, 0, 2 * Math.PI);
    ctx.stroke();
  }

  /**
   * @param {Point} from [px]
   * @param {Point} to [px]
   * @param {string} color
   * @param {{width?: number, cut?: boolean}} how  cut: as long parts are cut in drawings
   */
  arrow([px, py], [qx, qy], color, {width = 2.5, cut = false} = {}) {
    const {ctx} = this, length = Math.hypot(qx - px, qy - py), head = Math.min(HEAD + width, length);
    if (!(length > 3)) return;
    const ux = (qx - px) / length, uy = (qy - py) / length;
    const at = (/** @type {number} */ along, /** @type {number} */ across) =>
      /** @type {Point} */ ([px + ux * along - uy * across, py + uy * along + ux * across]);
    ctx.lineCap = 'butt';
    this.onRim(color, width, (rim) => {
      this.polyline([[px, py], at(length - head / 2, 0)]);
      ctx.beginPath();
      for (const side of [1, -1]) ctx.lineTo(...at(length - head - rim, side * (head * 0.45 + rim)));
      ctx.lineTo(...at(length + rim, 0));
      ctx.fill();
    });
    if (!cut) return;
    ctx.strokeStyle = this.palette.paper;
    ctx.lineWidth = 3;
    for (const along of [0.45, 0.52]) this.polyline([at(along * length - 3, -6), at(along * length + 3, 6)]);
  }

  /**
   * A round arrow that begins above its centre.
   * @param {Point} center [px]
   * @param {number} radius [px]
   * @param {number} sweep angle, counter-clockwise where it is positive [rad]
   * @param {string} color
   * @returns {{tip: Point, along: Point}} its tip, and the direction from the centre there
   */
  roundArrow([x, y], radius, sweep, color) {
    const {ctx} = this, begin = -Math.PI / 2, end = begin - sweep, sign = Math.sign(sweep), head = HEAD / radius;
    const at = (/** @type {number} */ angle, /** @type {number} */ far) => /** @type {Point} */ ([x + far * Math.cos(angle), y + far * Math.sin(angle)]);
    this.onRim(color, 2.5, (rim) => {
      ctx.beginPath();
      ctx.arc(x, y, radius, begin, end + sign * head / 2, sweep > 0);
      ctx.stroke();
      ctx.beginPath();
      for (const side of [1, -1]) ctx.lineTo(...at(end + sign * head, radius + side * (HEAD * 0.5 + rim)));
      ctx.lineTo(...at(end, radius));
      ctx.fill();
    });
    return {tip: at(end, radius), along: [Math.cos(end), Math.sin(end)]};
  }

  /**
   * Draw twice, first on a rim of paper, so that it is seen on bodies of any colour.
   * @param {string} color
   * @param {number} width of lines [px]
   * @param {(rim: number) => void} draw  rim: by which it is larger on each side [px]
   */
  onRim(color, width, draw) {
    const {ctx} = this;
    for (const [style, rim] of /** @type {[string, number][]} */ ([[this.palette.paper, RIM], [color, 0]])) {
      ctx.strokeStyle = ctx.fillStyle = style;
      ctx.lineWidth = width + 2 * rim;
      draw(rim);
    }
  }

  /**
   * @param {string} text on a rim of paper
   * @param {Point} at its begin, or its middle [px]; what begins on the page ends there, too
   * @param {string} color
   * @param {CanvasTextAlign} align
   * @param {number} size of letters [px]
   */
  write(text, [x, y], color, align = 'left', size = 13) {
    const {ctx, camera} = this;
    ctx.font = `${size}px system-ui, sans-serif`;
    ctx.textAlign = align;
    const {width} = ctx.measureText(text);
    if (align === 'left' && x < camera.width) x = Math.min(x, camera.width - width - 4);
    const left = align === 'left' ? x : align === 'right' ? x - width : x - width / 2;
    this.covered.push([left, y - size, left + width, y + 0.3 * size]);
    ctx.lineJoin = 'round';
    ctx.lineWidth = 0.3 * size;
    ctx.strokeStyle = this.palette.paper;
    ctx.strokeText(text, x, y);
    ctx.fillStyle = color;
    ctx.fillText(text, x, y);
  }

  /**
   * @param {string} text what a gesture measures
   * @param {{page: Point}} pointer beside which it is written
   */
  writeBeside(text, {page: [x, y]}) {
    this.write(text, [x + ASIDE, y - ASIDE], this.palette.accent);
  }
}
