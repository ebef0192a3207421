// SPDX-License-Identifier: Apache-2.0
/** Bodies on the canvas: filled, outlined, hatched where they are anchored, with a mark that turns. */

import {pathOf, spanOf} from './body_path.js';

/** @typedef {import('./wire.js').Point} Point */
/** @typedef {import('./wire.js').Body} Body */
/** @typedef {import('./wire.js').Frame} Frame */
/** @typedef {{path: Path2D, radius: number, dark: boolean, fill: string, line: string, tiny: string}} Look */

const SMALL = 5; // px: half the size below which a body has neither outline nor mark

export class BodyView {
  /**
   * @param {CanvasRenderingContext2D} ctx
   * @param {import('./camera.js').Camera} camera
   */
  constructor(ctx, camera) {
    this.ctx = ctx;
    this.camera = camera;
    this.ratio = 1; // pixels of the screen to one of the page
    this.ink = '';
    /** @type {CanvasPattern[]} */
    this.hatches = [];
    /** @type {WeakMap<Body, Look>} */
    this.looks = new WeakMap();
  }

  /** @param {import('./theme.js').Palette} palette */
  repaint({ink}) {
    this.ink = ink;
    this.hatches = [this.#hatch('#111'), this.#hatch('#eee')]; // on light bodies, and on dark ones
    this.looks = new WeakMap();
  }

  /**
   * @param {string} color
   * @returns {CanvasPattern} slanted lines, as in drawings of fixed parts
   */
  #hatch(color) {
    const tile = new OffscreenCanvas(8, 8);
    const ctx = /** @type {OffscreenCanvasRenderingContext2D} */ (tile.getContext('2d'));
    ctx.strokeStyle = color;
    ctx.globalAlpha = 0.6;
    ctx.lineWidth = 1.4;
    for (const x of [-8, 0, 8]) {
      ctx.moveTo(x, 8);
      ctx.lineTo(x + 8, 0);
    }
    ctx.stroke();
    return /** @type {CanvasPattern} */ (this.ctx.createPattern(tile, 'repeat'));
  }

  /**
   * @param {Frame} frame
   * @param {number} row
   * @param {Point} by [m]
   */
  toBody(frame, row, by = [0, 0]) {
    const {camera, ratio} = this, scale = camera.scale * ratio;
    const cos = scale * Math.cos(frame.yaw[row]), sin = scale * Math.sin(frame.yaw[row]);
    const [px, py] = camera.toPage(frame.x[row] + by[0], frame.y[row] + by[1]);
    this.ctx.setTransform(cos, -sin, -sin, -cos, px * ratio, py * ratio);
  }

  /** @param {Body} body */
  look(body) {
    let look = this.looks.get(body);
    if (!look) {
      const points = spanOf(body.shape), [x, y] = body.centroid;
      const radius = Math.max(...points.map(([px, py]) => Math.hypot(px - x, py - y)));
      const night = document.documentElement.dataset.theme === 'dark';
      const dark = Math.max(...body.color.slice(0, 3)) < 0.45, fill = css(body.color);
      const line = css(body.color, night ? 0.45 : -0.4);
      // Without its outline a dark body could not be told from a dark paper.
      look = {path: pathOf(body.shape), radius, fill, dark, line, tiny: night && dark ? line : fill};
      this.looks.set(body, look);
    }
    return look;
  }

  /**
   * @param {Frame} frame
   * @param {number} row
   * @param {Body} body
   */
  draw(frame, row, body) {
    const {ctx, camera} = this;
    const look = this.look(body), pixel = 1 / camera.scale, small = look.radius < SMALL * pixel;
    const [px, py] = camera.toPage(frame.x[row], frame.y[row]);
    const reach = (look.radius + Math.hypot(...body.centroid)) * camera.scale;
    if (!(px > -reach && py > -reach && px < camera.width + reach && py < camera.height + reach)) return;
    this.toBody(frame, row);
    if (body.shape.kind === 'chain') {
      this.#drawChain(body, look, pixel);
      return;
    }
    ctx.strokeStyle = look.line;
    ctx.lineWidth = 3 * pixel;
    ctx.lineJoin = 'round';
    ctx.setLineDash(body.kinematic || body.sensor ? [6 * pixel, 4 * pixel] : []);
    // Filled last, so that pieces of one body have one outline.
    if (!small) ctx.stroke(look.path);
    ctx.setLineDash([]);
    ctx.fillStyle = small ? look.tiny : look.fill;
    ctx.globalAlpha = body.sensor ? 0.35 : 1;
    ctx.fill(look.path, 'nonzero');
    ctx.globalAlpha = 1;
    if (small) return;
    if (body.anchored) {
      this.#drawRim(look, pixel);
      return;
    }
    ctx.lineWidth = 1.8 * pixel;
    // The turning mark; the centre keeps the body's colour.
    const [cx, cy] = body.centroid, inner = insideOf(body, look.radius);
    ctx.beginPath();
    ctx.moveTo(cx + 0.45 * inner, cy);
    ctx.lineTo(cx + 0.85 * inner, cy);
    ctx.stroke();
  }

  /**
   * @param {{path: Path2D, dark: boolean}} look
   * @param {number} pixel [m]
   */
  #drawRim({path, dark}, pixel) {
    const {ctx} = this, hatch = this.hatches[Number(dark)];
    hatch.setTransform(ctx.getTransform().inverse().scaleSelf(this.ratio, this.ratio));
    ctx.save();
    ctx.clip(path);
    ctx.strokeStyle = hatch;
    ctx.lineWidth = 14 * pixel;
    ctx.stroke(path);
    ctx.restore();
  }

  /**
   * @param {Body} body
   * @param {{path: Path2D, fill: string, line: string}} look
   * @param {number} pixel [m]
   */
  #drawChain({shape, anchored}, look, pixel) {
    const {ctx} = this, width = Math.max(shape.thickness, 2 * pixel);
    ctx.lineCap = ctx.lineJoin = 'round';
    ctx.strokeStyle = look.line;
    ctx.lineWidth = width + 2 * pixel;
    ctx.stroke(look.path);
    ctx.strokeStyle = look.fill;
    ctx.lineWidth = width;
    ctx.stroke(look.path);
    if (!anchored) return;
    ctx.strokeStyle = this.ink;
    ctx.lineWidth = 1.2 * pixel;
    ctx.globalAlpha = 0.55;
    ctx.beginPath();
    for (let i = 1; i < shape.points.length; i++) groundTicks(ctx, shape.points[i - 1], shape.points[i],
      width / 2 + pixel, 10 * pixel);
    ctx.stroke();
    ctx.globalAlpha = 1;
  }
}

/**
 * @param {number[]} color red, green, blue, alpha, each 0 .. 1
 * @param {number} share of white (or, where it is negative, of black) mixed in
 */
function css([red, green, blue, alpha], share = 0) {
  const mix = (/** @type {number} */ c) => 255 * (share > 0 ? c + (1 - c) * share : c * (1 + share));
  return `rgb(${mix(red)} ${mix(green)} ${mix(blue)} / ${alpha})`;
}

/**
 * @param {Body} body
 * @param {number} radius of its farthest point [m]
 * @returns {number} radius of a circle round the centroid that is within the body [m]
 */
function insideOf({shape, centroid: [x, y]}, radius) {
  if (!shape.outline) return shape.radius ?? radius / 3;
  return 0.9 * Math.min(...shape.outline.map(([ax, ay], i) => {
    const [bx, by] = shape.outline[(i + 1) % shape.outline.length];
    return Math.abs((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / Math.hypot(bx - ax, by - ay);
  }));
}

/**
 * Short slanted strokes on the lower side of a segment.
 * @param {CanvasRenderingContext2D} ctx
 * @param {Point} a
 * @param {Point} b
 * @param {number} away from the segment [m]
 * @param {number} size [m]
 */
function groundTicks(ctx, a, b, away, size) {
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]), flip = b[0] < a[0] ? -1 : 1;
  const ux = flip * (b[0] - a[0]) / length, uy = flip * (b[1] - a[1]) / length;
  const start = flip > 0 ? a : b;
  for (let s = size / 2; s < length; s += size) {
    const x = start[0] + s * ux + away * uy, y = start[1] + s * uy - away * ux;
    ctx.moveTo(x, y);
    ctx.lineTo(x - 0.6 * size * ux + 0.6 * size * uy, y - 0.6 * size * uy - 0.6 * size * ux);
  }
}
