// SPDX-License-Identifier: Apache-2.0
/** The canvas: grid, bodies, ghost, joints, arrows, and on top what the tool in hand draws. */

import {BodyView} from './body_view.js';
import {CanvasPainter} from './canvas_painter.js';
import {drawGrid, drawRulers} from './grid_view.js';
import {JointView} from './joint_view.js';
import {drawLabels} from './label_view.js';
import {drawNumbers} from './number_view.js';
import {drawScan} from './scan_view.js';
import {readPalette, watchTheme} from './theme.js';

/** @import {Body, Bounds, Camera, Frame, Point, WorldState} from '../types.js' */
/** @import {Numbered} from './number_view.js' */

const DASHED = 9; // px: half of the size from which on the outline of a ghost is dashed

export class SceneView extends CanvasPainter {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {WorldState} world
   * @param {Camera} camera
   */
  constructor(canvas, world, camera) {
    super(canvas, camera);
    this.world = world;
    this.bodies = new BodyView(this);
    this.joints = new JointView(this);
    /** @type {((view: SceneView) => void)[]} */
    this.overlays = [];
    /** @type {Numbered[]} that are written when all arrows are drawn */
    this.numbers = [];
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
