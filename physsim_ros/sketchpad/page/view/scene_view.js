// SPDX-License-Identifier: Apache-2.0
/** The canvas: grid, bodies, ghost, joints, arrows, and on top what the tool in hand draws. */

import {BodyView} from './body_view.js';
import {drawGrid, drawRulers} from './grid_view.js';
import {JointView} from './joint_view.js';
import {drawLabels} from './label_view.js';
import {drawNumbers} from './number_view.js';
import {drawScan} from './scan_view.js';
import {readPalette, watchTheme} from './theme.js';

/** @import {Body, Bounds, Camera, Frame, Point, WorldState} from '../types.js' */
/** @import {Box} from './clearance.js' */
/** @import {Numbered} from './number_view.js' */

const HEAD = 9, RIM = 1.5; // px: head of an arrow, and the rim of paper around it
const ASIDE = 14; // px from a pointer to what is written beside it
const DASHED = 9; // px: half of the size from which on the outline of a ghost is dashed

export class SceneView {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {WorldState} world
   * @param {Camera} camera
   */
  constructor(canvas, world, camera) {
    this.canvas = canvas;
    this.world = world;
    this.camera = camera;
    this.ctx = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d', {alpha: false}));
    this.palette = readPalette();
    this.bodies = new BodyView(this);
    this.joints = new JointView(this);
    /** @type {((view: SceneView) => void)[]} */
    this.overlays = [];
    /** @type {Numbered[]} that are written when all arrows are drawn */
    this.numbers = [];
    /** Boxes of what is written, of the legend and the panel; no number is put there. @type {Box[]} */
    this.covered = [];
    this.insets = {left: 0, top: 0, right: 0, bottom: 0}; // covered by bars [px]
    this.ratio = 1; // pixels of the screen to one of the page
    this.framed = ''; // what was framed last, and the size of the picture then [px]
    this.request = 0; // of the frame of the page in which the world is drawn; 0 where nobody has asked for one
    new ResizeObserver(() => this.#resize()).observe(canvas);
    watchTheme(() => this.#repaint());
    addEventListener('beforeprint', () => this.draw());
    world.connection.on('any', () => this.redraw());
    this.#resize();
  }

  /** Have the world drawn in the next frame of the page, once, however often that is asked for. */
  redraw() {
    this.request ||= requestAnimationFrame(() => {
      this.request = 0;
      // A picture that is not shown has no width.
      if (this.camera.width) this.draw();
    });
  }

  #repaint() {
    this.palette = readPalette();
    this.bodies.repaint();
    this.redraw();
  }

  #resize() {
    this.ratio = devicePixelRatio;
    this.camera.width = this.canvas.clientWidth;
    this.camera.height = this.canvas.clientHeight;
    // A canvas of no size, which is not shown, makes no pattern.
    this.canvas.width = Math.max(Math.round(this.camera.width * this.ratio), 1);
    this.canvas.height = Math.max(Math.round(this.camera.height * this.ratio), 1);
    this.redraw();
  }

  /**
   * Fit a box into a picture that has no bars: a small one, of a dialog or a card.
   * @param {Bounds} box
   * @param {number} gap around it [px]
   * @param {string} key of what is shown: until it changes, or the size of the picture, the view stays
   */
  frame(box, gap, key) {
    const {camera, world} = this, framed = `${key} ${camera.width} ${camera.height}`;
    if (framed === this.framed || !world.count || !box.every(Number.isFinite)) return;
    this.framed = framed;
    camera.fit(box, {left: gap, top: gap, right: gap, bottom: gap});
    this.redraw();
  }

  /** Draw the world as it is now. */
  draw() {
    const {ctx, camera, palette, world} = this;
    this.numbers = [];
    this.covered = [];
    this.#toPixels();
    ctx.fillStyle = palette.paper;
    ctx.fillRect(0, 0, camera.width, camera.height);
    drawGrid(this);
    this.#drawBounds();
    if (world.frame.scan) drawScan(this, world.frame.scan);
    for (let row = 0; row < world.count; row++) this.bodies.draw(world.frame, row, world.scene.bodies[row]);
    if (world.ghost) this.#drawGhost(world.ghost, world.ghostScene.bodies);
    this.#toPixels();
    if (world.count) this.joints.draw();
    drawRulers(this);
    drawLabels(this);
    this.#drawHands();
    for (const overlay of this.overlays) overlay(this);
    drawNumbers(this);
  }

  #toPixels() {
    this.ctx.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
  }

  /** @returns {Path2D} around the world, or around the page where the world has no bounds */
  boundsPath() {
    const {camera, world: {scene: {bounds}}} = this, path = new Path2D();
    if (bounds.length) path.rect(...camera.toPage(bounds[0], bounds[3]), (bounds[2] - bounds[0]) * camera.scale, (bounds[3] - bounds[1]) * camera.scale);
    else path.rect(0, 0, camera.width, camera.height);
    return path;
  }

  #drawBounds() {
    const {ctx, palette} = this;
    if (!this.world.scene.bounds.length) return;
    ctx.strokeStyle = palette.ink;
    ctx.lineWidth = 2;
    ctx.stroke(this.boundsPath());
  }

  /**
   * Dashed outlines over the bodies, so that they are seen where both courses agree, too; in the colour of
   * the ring on the time line that goes back to their course.
   * @param {Frame} frame
   * @param {Body[]} bodies
   */
  #drawGhost(frame, bodies) {
    const {ctx, camera, palette} = this, pixel = 1 / camera.scale;
    bodies.forEach((body, row) => {
      if (body.anchored || row >= frame.x.length) return;
      const appearance = this.bodies.appearance(body);
      if (!this.bodies.isOnPage(frame, row, appearance)) return;
      this.bodies.setTransform(frame, row);
      const small = appearance.radius * camera.scale < DASHED;
      ctx.setLineDash(small ? [] : [5 * pixel, 5 * pixel]);
      if (!small) {
        ctx.strokeStyle = palette.paper;
        ctx.lineWidth = 3.5 * pixel;
        ctx.stroke(appearance.path);
      }
      ctx.strokeStyle = palette.force;
      ctx.lineWidth = (small ? 1.2 : 1.8) * pixel;
      ctx.stroke(appearance.path);
    });
    ctx.setLineDash([]);
    this.#toPixels();
  }

  #drawHands() {
    const {palette, world} = this, {hands} = world.frame;
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

  /**
   * @param {string} name of a body that is selected or pointed at; nothing is drawn where it is gone
   * @param {string} color
   * @param {Point} by displacement [m]
   * @param {{turn: number, scale: number}} about  its centre of mass [rad], and its size
   */
  outline(name, color, by = [0, 0], {turn, scale} = {turn: 0, scale: 1}) {
    const {ctx, camera, world} = this, row = world.row(name);
    if (row < 0) return;
    const body = world.scene.bodies[row];
    this.bodies.setTransform(world.frame, row, by);
    const [x, y] = body.centroid;
    ctx.translate(x, y);
    ctx.rotate(turn);
    ctx.scale(scale, scale);
    ctx.translate(-x, -y);
    ctx.strokeStyle = color;
    ctx.lineWidth = (body.shape.kind === 'chain' ? body.shape.thickness : 0) + 3 / camera.scale / scale;
    ctx.stroke(this.bodies.appearance(body).path);
    this.#toPixels();
  }
}
