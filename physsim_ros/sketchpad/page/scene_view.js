// SPDX-License-Identifier: Apache-2.0
/** The canvas: grid, ghost, bodies, joints, arrows, and on top what the tool in hand draws. */

import {pathOf, spanOf} from './body_path.js';
import {drawGrid} from './grid_view.js';
import {JointView} from './joint_view.js';
import {readPalette, watchTheme} from './theme.js';

/** @typedef {import('./wire.js').Point} Point */
/** @typedef {import('./wire.js').Body} Body */
/** @typedef {import('./wire.js').Frame} Frame */

const SMALL = 5; // px: half the size below which a body has neither outline nor mark
const NEWTONS = 10; // of a contact's arrow of one metre
const HEAD = 9; // px: of an arrow

export class SceneView {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {import('./world_state.js').WorldState} world
   * @param {import('./camera.js').Camera} camera
   */
  constructor(canvas, world, camera) {
    this.canvas = canvas;
    this.world = world;
    this.camera = camera;
    this.ctx = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d', {alpha: false}));
    this.palette = readPalette();
    /** @type {CanvasPattern[]} */
    this.hatches = [];
    /** @type {WeakMap<Body, {path: Path2D, radius: number, dark: boolean, fill: string, line: string,
     *   tiny: string}>} */
    this.looks = new WeakMap();
    /** @type {((view: SceneView) => void)[]} */
    this.overlays = [];
    this.insets = {left: 0, top: 0, right: 0, bottom: 0}; // covered by bars [px]
    this.velocities = false; // whether they are shown; frames have them for plots too
    this.ratio = 1;
    this.dirty = true;
    this.drawn = -1; // version of the world
    new ResizeObserver(() => this.#resize()).observe(canvas);
    watchTheme(() => this.#repaint());
    this.#resize();
    const loop = () => {
      if (this.dirty || this.drawn !== world.version) this.#draw();
      requestAnimationFrame(loop);
    };
    requestAnimationFrame(loop);
  }

  #repaint() {
    this.palette = readPalette();
    this.hatches = [this.#hatch('#111'), this.#hatch('#eee')]; // on light bodies, and on dark ones
    this.looks = new WeakMap();
    this.dirty = true;
  }

  #resize() {
    this.ratio = devicePixelRatio;
    this.camera.width = this.canvas.clientWidth;
    this.camera.height = this.canvas.clientHeight;
    this.canvas.width = Math.round(this.camera.width * this.ratio);
    this.canvas.height = Math.round(this.camera.height * this.ratio);
    this.dirty = true;
  }

  /**
   * @param {string} color
   * @returns {CanvasPattern} slanted lines, as on a drawing of what is fixed
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

  #draw() {
    const {ctx, camera, palette, world} = this;
    this.dirty = false;
    this.drawn = world.version;
    this.#toPixels();
    ctx.fillStyle = palette.paper;
    ctx.fillRect(0, 0, camera.width, camera.height);
    drawGrid(ctx, camera, palette, this.insets);
    this.#drawBounds();
    if (world.ghost) this.#drawGhost(world.ghost, world.ghostScene.bodies);
    for (let row = 0; row < world.count; row++) this.#drawBody(row);
    this.#toPixels();
    if (world.count) new JointView(ctx, world, camera, palette).draw();
    this.#drawArrows();
    for (const overlay of this.overlays) overlay(this);
  }

  #toPixels() {
    this.ctx.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
  }

  /**
   * @param {Frame} frame
   * @param {number} row
   * @param {Point} by [m]
   */
  #toBody(frame, row, by = [0, 0]) {
    const {camera, ratio} = this, scale = camera.scale * ratio;
    const cos = scale * Math.cos(frame.yaw[row]), sin = scale * Math.sin(frame.yaw[row]);
    const [px, py] = camera.toPage(frame.x[row] + by[0], frame.y[row] + by[1]);
    this.ctx.setTransform(cos, -sin, -sin, -cos, px * ratio, py * ratio);
  }

  /** @param {Body} body */
  #look(body) {
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

  /** @param {number} row */
  #drawBody(row) {
    const {ctx, camera} = this, {frame, scene} = this.world, body = scene.bodies[row];
    const look = this.#look(body), pixel = 1 / camera.scale, small = look.radius < SMALL * pixel;
    const [px, py] = camera.toPage(frame.x[row], frame.y[row]);
    const reach = (look.radius + Math.hypot(...body.centroid)) * camera.scale;
    if (!(px > -reach && py > -reach && px < camera.width + reach && py < camera.height + reach)) return;
    this.#toBody(frame, row);
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
    ctx.strokeStyle = this.palette.ink;
    ctx.lineWidth = 1.2 * pixel;
    ctx.globalAlpha = 0.55;
    ctx.beginPath();
    for (let i = 1; i < shape.points.length; i++) groundTicks(ctx, shape.points[i - 1], shape.points[i],
      width / 2 + pixel, 10 * pixel);
    ctx.stroke();
    ctx.globalAlpha = 1;
  }

  #drawBounds() {
    const {ctx, camera, palette} = this, {bounds} = this.world.scene;
    if (!bounds.length) return;
    const [x, y] = camera.toPage(bounds[0], bounds[3]);
    ctx.strokeStyle = palette.ink;
    ctx.lineWidth = 2;
    ctx.strokeRect(x, y, (bounds[2] - bounds[0]) * camera.scale, (bounds[3] - bounds[1]) * camera.scale);
  }

  /**
   * @param {Frame} frame
   * @param {Body[]} bodies
   */
  #drawGhost(frame, bodies) {
    const {ctx, camera} = this;
    ctx.globalAlpha = 0.8;
    bodies.forEach((body, row) => {
      if (body.anchored || row >= frame.x.length) return;
      const look = this.#look(body);
      this.#toBody(frame, row);
      ctx.strokeStyle = look.fill;
      ctx.lineWidth = 1.5 / camera.scale;
      ctx.setLineDash([5 / camera.scale, 4 / camera.scale]);
      ctx.stroke(look.path);
    });
    ctx.setLineDash([]);
    ctx.globalAlpha = 1;
    this.#toPixels();
  }

  #drawArrows() {
    const {palette, world} = this, {frame, scene} = world, {velocities, contacts, hands} = frame;
    for (let row = 0; this.velocities && velocities && row < world.count; row++) {
      if (scene.bodies[row].anchored) continue;
      const from = world.place(row, scene.bodies[row].centroid);
      this.arrow(from, [from[0] + velocities.x[row], from[1] + velocities.y[row]], palette.accent);
    }
    const [gx, gy] = scene.gravity;
    for (let i = 0; contacts && i < contacts.x.length; i++) {
      // Of action and reaction, the one that bears.
      const bears = contacts.nx[i] * gx + contacts.ny[i] * gy > 0 ? -1 : 1;
      const length = bears * contacts.impulse[i] * world.rate / NEWTONS;
      this.arrow([contacts.x[i], contacts.y[i]], [contacts.x[i] + contacts.nx[i] * length,
        contacts.y[i] + contacts.ny[i] * length], palette.force);
    }
    for (let i = 0; hands && i < hands.x.length; i++) {
      this.line([[hands.x[i], hands.y[i]], [hands.toX[i], hands.toY[i]]], palette.accent, [2, 4]);
      this.ring([hands.x[i], hands.y[i]], 4, palette.accent);
    }
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
    ctx.beginPath();
    for (const point of points) ctx.lineTo(...this.camera.toPage(...point));
    ctx.stroke();
    ctx.setLineDash([]);
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
   * @param {Point} from [m]
   * @param {Point} to [m]
   * @param {string} color
   */
  arrow(from, to, color) {
    const [px, py] = this.camera.toPage(...from), [qx, qy] = this.camera.toPage(...to);
    const length = Math.hypot(qx - px, qy - py);
    if (!(length > 3)) return;
    const {ctx} = this, size = Math.min(HEAD, length / 2) / length;
    const dx = (qx - px) * size, dy = (qy - py) * size;
    ctx.strokeStyle = ctx.fillStyle = color;
    ctx.lineWidth = 2;
    ctx.beginPath();
    ctx.moveTo(px, py);
    ctx.lineTo(qx - dx / 2, qy - dy / 2);
    ctx.stroke();
    ctx.beginPath();
    ctx.moveTo(qx, qy);
    ctx.lineTo(qx - dx - dy / 2, qy - dy + dx / 2);
    ctx.lineTo(qx - dx + dy / 2, qy - dy - dx / 2);
    ctx.fill();
  }

  /**
   * @param {number} row of a body that is chosen or pointed at
   * @param {string} color
   * @param {Point} by how far from its place [m]
   */
  outline(row, color, by = [0, 0]) {
    const {ctx, camera, world} = this, body = world.scene.bodies[row];
    this.#toBody(world.frame, row, by);
    ctx.strokeStyle = color;
    ctx.lineWidth = (body.shape.kind === 'chain' ? body.shape.thickness : 0) + 3 / camera.scale;
    ctx.stroke(this.#look(body).path);
    this.#toPixels();
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
