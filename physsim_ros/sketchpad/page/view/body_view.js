// SPDX-License-Identifier: Apache-2.0
/** Bodies on the canvas: filled, outlined, hatched where they are anchored, with a mark that turns. */

import {closed, distanceTo, isClockwise, pathOf, reachOf} from './body_path.js';

/** @import {Body, Frame, Point, SceneView, Shape} from '../types.js' */

/** @typedef {{path: Path2D, reach: number, radius: number, inner: number, plain: boolean, dark: boolean,
 *   fill: string, line: string, tiny: string}} Appearance
 *   reach: of the farthest point from the body's origin, radius: of it from the centroid, inner: of a circle
 *   round the centroid within the body [m]; plain: neither anchored, kinematic nor sensor */

// Half of the size of a body [px]. Below SMALL it has no outline, below MARKED no mark; below MEDIUM its
// outline is the rim that a smaller filling leaves free: without a GPU, a stroke costs twice a filling.
const SMALL = 4, MARKED = 8, MEDIUM = 11;
const RIM = 1.2, MARK = 1.8; // px
const TREAD = 20; // px of a belt from tread to tread
const SHEER = 0.35; // opacity of a sensor
const ONE_WAY = 14; // px: half of the arrow of a one-way body
const FLOW_GAP = 90, MOST_ARROWS = 12; // px between the arrows of a flow, and how many of them on each side of the middle

export class BodyView {
  /** @param {SceneView} view */
  constructor(view) {
    this.view = view;
    this.ctx = view.ctx;
    this.camera = view.camera;
    /** @type {CanvasPattern[]} */
    this.hatches = [];
    /** @type {WeakMap<Body, Appearance>} */
    this.appearances = new WeakMap();
  }

  /** Follow the colours of the page. */
  repaint() {
    this.hatches = [this.#hatch('#111'), this.#hatch('#eee')]; // on light bodies, and on dark ones
    this.appearances = new WeakMap();
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
   * Draw in the frame of a body from now on.
   * @param {Frame} frame
   * @param {number} row
   * @param {Point} by displacement [m]
   */
  setTransform(frame, row, by = [0, 0]) {
    const {camera, view: {ratio}} = this, scale = camera.scale * ratio;
    const cos = scale * Math.cos(frame.yaw[row]), sin = scale * Math.sin(frame.yaw[row]);
    const [px, py] = camera.toPage(frame.x[row] + by[0], frame.y[row] + by[1]);
    this.ctx.setTransform(cos, -sin, -sin, -cos, px * ratio, py * ratio);
  }

  /**
   * @param {Body} body
   * @returns {Appearance}
   */
  appearance(body) {
    const {shape, color, centroid: [x, y]} = body;
    let appearance = this.appearances.get(body);
    if (!appearance) {
      const radius = reachOf(shape, [x, y]);
      const night = document.documentElement.dataset.theme === 'dark';
      const dark = Math.max(...color.slice(0, 3)) < 0.45, fill = css(color);
      const line = css(color, night ? 0.45 : -0.4), inner = innerRadius(body, radius);
      const plain = !(body.anchored || body.kinematic || body.sensor);
      appearance = {path: pathOf(shape), reach: radius + Math.hypot(x, y), radius, inner, plain, dark, fill, line,
        // Without its outline a dark body could not be told from a dark paper.
        tiny: night && dark ? line : fill};
      this.appearances.set(body, appearance);
    }
    return appearance;
  }

  /**
   * @param {Frame} frame
   * @param {number} row
   * @param {Appearance} appearance of that body
   * @returns {boolean} whether it may be on the page; no body at NaN is
   */
  isOnPage(frame, row, appearance) {
    const {camera} = this, reach = appearance.reach * camera.scale;
    const [x, y] = camera.toPage(frame.x[row], frame.y[row]);
    return x > -reach && y > -reach && x < camera.width + reach && y < camera.height + reach;
  }

  /**
   * @param {Frame} frame
   * @param {number} row
   * @param {Body} body
   */
  draw(frame, row, body) {
    const {ctx, camera} = this, appearance = this.appearance(body);
    if (!this.isOnPage(frame, row, appearance)) return;
    this.setTransform(frame, row);
    const size = appearance.radius * camera.scale, pixel = 1 / camera.scale;
    if (body.shape.kind === 'chain') this.#drawChain(body, appearance, pixel, frame.yaw[row]);
    else if (size < SMALL) {
      ctx.fillStyle = appearance.tiny;
      ctx.fill(appearance.path);
    } else {
      if (size < MEDIUM && appearance.plain) this.#drawMedium(body, appearance, 1 - RIM / size);
      else this.#drawLarge(body, appearance, pixel);
      const flow = body.medium?.flow ?? body.surface_velocity;
      if (flow) this.#drawFlow(flow, frame.time, appearance, pixel);
      if (body.anchored && !body.medium) this.#drawRim(body, appearance, pixel);
      else if (size >= MARKED && !body.medium) this.#drawMark(body, appearance, pixel);
      if (body.belt) this.#drawBelt(body.belt * frame.time, body.shape, appearance, pixel);
      if (body.one_way) this.#drawOneWay(body.centroid, body.one_way, appearance, pixel);
    }
  }

  /**
   * @param {Body} body
   * @param {Appearance} appearance
   * @param {number} share of the size that is filled
   */
  #drawMedium({centroid: [x, y]}, {path, line, fill}, share) {
    const {ctx} = this;
    ctx.fillStyle = line;
    ctx.fill(path);
    ctx.translate(x * (1 - share), y * (1 - share));
    ctx.scale(share, share);
    ctx.fillStyle = fill;
    ctx.fill(path);
  }

  /**
   * @param {Body} body
   * @param {Appearance} appearance
   * @param {number} pixel [m]
   */
  #drawLarge({kinematic, sensor}, {path, line, fill}, pixel) {
    const {ctx} = this;
    ctx.strokeStyle = line;
    ctx.lineWidth = 3 * pixel;
    ctx.lineJoin = 'round';
    if (kinematic || sensor) ctx.setLineDash([6 * pixel, 4 * pixel]);
    // Filled last, so that pieces of one body have one outline.
    ctx.stroke(path);
    ctx.setLineDash([]);
    ctx.fillStyle = fill;
    ctx.globalAlpha = sensor ? SHEER : 1;
    ctx.fill(path, 'nonzero');
    ctx.globalAlpha = 1;
  }

  /**
   * Arrows along the flow of a medium, or the surface of a conveyor, which move with it; none in still water.
   * @param {Point} flow [m/s]
   * @param {number} time [s]
   * @param {Appearance} appearance
   * @param {number} pixel [m]
   */
  #drawFlow([vx, vy], time, {path, line, reach}, pixel) {
    if (!Math.hypot(vx, vy)) return;
    const {ctx} = this, gap = Math.max(FLOW_GAP * pixel, reach / MOST_ARROWS), first = -Math.ceil(reach / gap + 1) * gap;
    ctx.save();
    ctx.clip(path);
    ctx.strokeStyle = line;
    ctx.globalAlpha = SHEER;
    ctx.lineWidth = 2 * pixel;
    ctx.beginPath();
    const along = Math.atan2(vy, vx), half = gap / 5;
    for (let x = first + vx * time % gap; x <= reach + gap; x += gap) {
      for (let y = first + vy * time % gap; y <= reach + gap; y += gap) {
        const at = (/** @type {number} */ ahead, /** @type {number} */ aside) => /** @type {[number, number]} */ (
          [x + Math.cos(along) * ahead - Math.sin(along) * aside, y + Math.sin(along) * ahead + Math.cos(along) * aside]);
        ctx.moveTo(...at(-half, 0));
        ctx.lineTo(...at(half, 0));
        ctx.moveTo(...at(half / 3, half / 2));
        ctx.lineTo(...at(half, 0));
        ctx.lineTo(...at(half / 3, -half / 2));
      }
    }
    ctx.stroke();
    ctx.restore();
  }

  /**
   * The arrow of a one-way body, across its middle.
   * @param {Point} centroid
   * @param {Point} direction in which others pass it
   * @param {Appearance} appearance
   * @param {number} pixel [m]
   */
  #drawOneWay([x, y], [dx, dy], {line}, pixel) {
    const {ctx} = this, half = ONE_WAY / Math.hypot(dx, dy) * pixel;
    const at = (/** @type {number} */ ahead, /** @type {number} */ aside) => /** @type {Point} */ (
      [x + (dx * ahead - dy * aside) * half, y + (dy * ahead + dx * aside) * half]);
    ctx.strokeStyle = line;
    ctx.lineWidth = 2 * pixel;
    this.view.polyline([at(-1, 0), at(1, 0), at(0.3, 0.5), at(1, 0), at(0.3, -0.5)]);
  }

  /**
   * The mark that turns with a body; the centre keeps the body's colour. Of a robot it is the front.
   * @param {Body} body
   * @param {Appearance} appearance
   * @param {number} pixel [m]
   */
  #drawMark({centroid: [x, y], robot}, {inner, line, dark}, pixel) {
    if (robot) {
      this.ctx.fillStyle = dark ? '#eee' : '#111';
      this.ctx.beginPath();
      for (const [ahead, aside] of [[0.85, 0], [0.2, 0.5], [0.2, -0.5]]) this.ctx.lineTo(x + ahead * inner, y + aside * inner);
      this.ctx.fill();
      return;
    }
    this.ctx.fillStyle = line;
    this.ctx.fillRect(x + 0.45 * inner, y - MARK / 2 * pixel, 0.4 * inner, MARK * pixel);
  }

  /**
   * @param {Body} body
   * @param {Appearance} appearance
   * @param {number} pixel [m]
   */
  #drawRim({sensor}, {path, dark}, pixel) {
    const {ctx} = this, hatch = this.hatches[Number(dark)];
    hatch.setTransform(ctx.getTransform().inverse().scaleSelf(this.view.ratio, this.view.ratio));
    ctx.save();
    ctx.clip(path);
    ctx.globalAlpha = sensor ? SHEER : 1;
    ctx.strokeStyle = hatch;
    ctx.lineWidth = 14 * pixel;
    ctx.stroke(path);
    ctx.restore();
  }

  /**
   * The treads of a belt, which run along the outline.
   * @param {number} gone how far they have run, counter-clockwise [m]
   * @param {Shape} shape
   * @param {Appearance} appearance
   * @param {number} pixel [m]
   */
  #drawBelt(gone, {outline}, {path}, pixel) {
    const {ctx, view: {palette}} = this, tread = TREAD * pixel;
    for (const [style, width] of /** @type {const} */ ([[palette.ink, 6], [palette.paper, 3]])) {
      ctx.strokeStyle = style;
      ctx.lineWidth = width * pixel;
      ctx.stroke(path);
      ctx.setLineDash([tread / 2, tread / 2]);
      ctx.lineDashOffset = (outline && isClockwise(outline) ? gone : -gone) % tread;
    }
    ctx.setLineDash([]);
  }

  /**
   * @param {Body} body
   * @param {Appearance} appearance
   * @param {number} pixel [m]
   * @param {number} yaw
   */
  #drawChain({shape, anchored}, {path, line, fill}, pixel, yaw) {
    const {ctx} = this, width = Math.max(shape.thickness, 2 * pixel);
    ctx.lineCap = ctx.lineJoin = 'round';
    ctx.strokeStyle = line;
    ctx.lineWidth = width + 2 * pixel;
    ctx.stroke(path);
    ctx.strokeStyle = fill;
    ctx.lineWidth = width;
    ctx.stroke(path);
    if (!anchored) return;
    ctx.strokeStyle = this.view.palette.ink;
    ctx.lineWidth = 1.2 * pixel;
    ctx.globalAlpha = 0.55;
    ctx.beginPath();
    for (let i = 1; i < shape.points.length; i++) groundTicks(ctx, shape.points[i - 1], shape.points[i],
      yaw, width / 2 + pixel, 10 * pixel);
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
function innerRadius({shape, centroid}, radius) {
  if (!shape.outline) return shape.radius ?? radius / 3;
  return 0.9 * distanceTo(closed(shape.outline), centroid);
}

/**
 * Short slanted strokes on the side of a segment that is lower in the world.
 * @param {CanvasRenderingContext2D} ctx
 * @param {Point} a in the frame of its body
 * @param {Point} b
 * @param {number} yaw of the body
 * @param {number} away from the segment [m]
 * @param {number} size [m]
 */
export function groundTicks(ctx, a, b, yaw, away, size) {
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  const flip = (b[0] - a[0]) * Math.cos(yaw) < (b[1] - a[1]) * Math.sin(yaw) ? -1 : 1;
  const ux = flip * (b[0] - a[0]) / length, uy = flip * (b[1] - a[1]) / length;
  const start = flip > 0 ? a : b;
  for (let s = size / 2; s < length; s += size) {
    const x = start[0] + s * ux + away * uy, y = start[1] + s * uy - away * ux;
    ctx.moveTo(x, y);
    ctx.lineTo(x - 0.6 * size * ux + 0.6 * size * uy, y - 0.6 * size * uy - 0.6 * size * ux);
  }
}
