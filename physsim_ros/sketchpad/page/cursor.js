// SPDX-License-Identifier: Apache-2.0
/** The cursor on the canvas, for those who work by keys: arrow keys move it, Enter presses and lifts the tool. */

/** @import {App, Point, SceneView, Touch} from './types.js' */

const STEP = 16, FINE = 2; // px

export class Cursor {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.x = this.y = -1; // px
    this.shown = false;
    this.pressed = false;
    app.view.overlays.push((view) => this.#draw(view));
  }

  /** @returns {Touch} */
  get touch() {
    const {camera} = this.app;
    return {at: camera.toWorld(this.x, this.y), page: [this.x, this.y],
      time: performance.now() / 1000, slop: 6 / camera.scale, grid: 0, copies: false};
  }

  /** @param {Point} page where it is put [px] */
  put([x, y]) {
    [this.x, this.y] = [x, y];
    this.move(0, 0, false);
  }

  hide() {
    this.shown = false;
    if (this.pressed) this.app.tool.cancel();
    this.pressed = false;
  }

  /**
   * @param {number} dx -1, 0 or 1
   * @param {number} dy
   * @param {boolean} fine
   */
  move(dx, dy, fine) {
    const {camera, view} = this.app, step = fine ? FINE : STEP;
    if (!this.shown && this.x < 0) [this.x, this.y] = [camera.width / 2, camera.height / 2];
    this.shown = true;
    this.x = Math.min(Math.max(this.x + dx * step, 0), camera.width);
    this.y = Math.min(Math.max(this.y + dy * step, 0), camera.height);
    this.app.tool.move(this.touch);
    this.app.selection.hover(this.touch);
    view.dirty = true;
  }

  /** Press the tool, or lift it; a tool of clicks clicks. */
  press() {
    const {app} = this;
    if (!this.shown) {
      this.move(0, 0, false);
      return;
    }
    app.time.endRewind();
    if (!this.pressed) app.tool.down(this.touch);
    if (this.pressed || app.tool.clicks) app.tool.up(this.touch);
    this.pressed = !this.pressed && !app.tool.clicks;
    app.view.dirty = true;
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
