// SPDX-License-Identifier: Apache-2.0
/** The cursor on the canvas that keys move: a pointer that Enter presses and lifts. */

/** @import {Parts, Point, SceneView, Touch} from '../types.js' */

const STEP = 16, FINE = 2; // px
const POINTER = -1; // its number among pointers

export class Cursor {
  /** @param {Parts<'camera' | 'pointers' | 'view'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.x = this.y = -1; // px
    this.shown = false;
    parts.view.overlays.push((view) => this.#draw(view));
    parts.pointers.on('press', () => this.hide());
  }

  /** @returns {Touch} */
  get touch() {
    const {camera} = this.parts;
    return {at: camera.toWorld(this.x, this.y), page: [this.x, this.y],
      time: performance.now() / 1000, slop: 6 / camera.scale, grid: 0, copies: false};
  }

  get #isPressed() {
    return this.parts.pointers.working?.pointer === POINTER;
  }

  /** @param {Point} page where it is put [px] */
  put([x, y]) {
    [this.x, this.y] = [x, y];
    this.move(0, 0, false);
  }

  hide() {
    if (this.#isPressed) this.parts.pointers.cancel();
    this.shown = false;
  }

  /**
   * @param {number} dx -1, 0 or 1
   * @param {number} dy
   * @param {boolean} fine
   */
  move(dx, dy, fine) {
    const {camera, pointers} = this.parts, step = fine ? FINE : STEP;
    if (!this.shown && this.x < 0) [this.x, this.y] = [camera.width / 2, camera.height / 2];
    this.shown = true;
    this.x = Math.min(Math.max(this.x + dx * step, 0), camera.width);
    this.y = Math.min(Math.max(this.y + dy * step, 0), camera.height);
    if (this.#isPressed) pointers.move(POINTER, this.touch);
    else pointers.point(this.touch);
  }

  /** Press the tool, or a handle, or lift it; a tool of clicks clicks. */
  press() {
    const {pointers} = this.parts, wasPressed = this.#isPressed;
    if (!this.shown) {
      this.move(0, 0, false);
      return;
    }
    if (!wasPressed) pointers.begin(POINTER, this.touch);
    if (wasPressed || pointers.working?.tool?.clicks) pointers.end(POINTER, this.touch);
  }

  /** @param {SceneView} view */
  #draw({ctx, palette}) {
    if (!this.shown) return;
    ctx.strokeStyle = palette.accent;
    ctx.lineWidth = 2;
    ctx.beginPath();
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      ctx.moveTo(this.x + 4 * dx, this.y + 4 * dy);
      ctx.lineTo(this.x + 14 * dx, this.y + 14 * dy);
    }
    ctx.stroke();
  }
}
