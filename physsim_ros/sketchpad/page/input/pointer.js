// SPDX-License-Identifier: Apache-2.0
/**
 * Mouse, pen and fingers on the canvas. One pointer works the tool in hand; two fingers move and zoom
 * the view; once a stylus was seen it draws, and a finger moves the view. The other end of a stylus erases,
 * and its button selects.
 *
 * Law: what a pointer works ends by that pointer alone, or by a second finger that moves the view with it.
 */

import {Lasso} from '../tools/freehand.js';
import {Eraser} from '../tools/eraser.js';

/** @import {App, Touch, Worked} from '../types.js' */

const PEN_BUTTON = 2, PEN_ERASER = 32; // bits of `buttons` (Pointer Events, section 4.1.1)
const FINGER = 14, MOUSE = 2; // px of slop
const WHEEL = 0.0015, PINCH = 0.01; // of zoom, in powers of e a pixel of wheel
const WHEEL_TURN = 0.002; // rad a pixel

export class Pointers {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {Map<number, PointerEvent>} */
    this.down = new Map();
    /** @type {?{id: number, isPen: boolean, worked: Worked}} the pointer that works something, and what */
    this.working = null;
    this.eraser = new Eraser(app);
    this.lasso = new Lasso(app);
    app.view.overlays.push((view) => [this.eraser, this.lasso].forEach((each) => each.draw(view)));
    this.stylus = false;
    this.space = false; // held: dragging moves the view
    const {canvas} = app.view;
    canvas.addEventListener('pointerdown', (event) => this.#down(event));
    canvas.addEventListener('pointermove', (event) => this.#move(event));
    canvas.addEventListener('pointerup', (event) => this.#up(event));
    canvas.addEventListener('pointercancel', (event) => this.#cancel(event));
    canvas.addEventListener('pointerleave', ({pointerType}) => {
      app.selection.hover(null);
      if (pointerType !== 'touch') app.handles.point(null);
    });
    canvas.addEventListener('wheel', (event) => this.#wheel(event), {passive: false});
    // The click after a tap would go to the panel that the tap has opened.
    canvas.addEventListener('touchend', (event) => event.cancelable && event.preventDefault());
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  /**
   * @param {PointerEvent} event
   * @returns {Touch}
   */
  #touch(event) {
    const {camera} = this.app, {clientX, clientY, pointerType, timeStamp} = event;
    return {at: camera.toWorld(clientX, clientY), page: [clientX, clientY], time: timeStamp / 1000,
      slop: (pointerType === 'touch' ? FINGER : MOUSE) / camera.scale, grid: event.shiftKey ? camera.fineStep : 0, copies: event.altKey};
  }

  /** @param {PointerEvent} event */
  #down(event) {
    const {app} = this, isPen = event.pointerType === 'pen';
    app.view.canvas.setPointerCapture(event.pointerId);
    if (isPen) {
      this.stylus = true;
      this.#forget();
    } else if (this.working?.isPen) return; // of the palm
    this.down.set(event.pointerId, event);
    app.view.canvas.focus({preventScroll: true});
    app.cursor.hide();
    app.selection.hover(null);
    const moves = !isPen && event.button > 0 || this.space || app.viewOnly ||
      (this.stylus && event.pointerType === 'touch');
    if (this.down.size === 1 && !moves) {
      this.working = {id: event.pointerId, isPen, worked: this.press(this.#touch(event), isPen ? this.#penTool(event) : app.tool)};
    } else if (this.down.size > 1 && this.working && !app.tool.turns) this.#drop();
  }

  /**
   * @param {PointerEvent} event of a stylus
   * @returns {Worked} what it works
   */
  #penTool({buttons}) {
    return buttons & PEN_ERASER ? this.eraser : buttons & PEN_BUTTON ? this.lasso : this.app.tool;
  }

  /**
   * @param {Touch} touch where it is pressed
   * @param {Worked} tool that is pressed there, if no handle is
   * @returns {Worked} what is pressed
   */
  press(touch, tool = this.app.tool) {
    const {app} = this;
    app.time.endRewind();
    const worked = tool === app.tool && app.handles.isAt(touch) ? app.handles : tool;
    worked.down?.(touch);
    return worked;
  }

  /**
   * @param {Worked} worked what is lifted
   * @param {Touch} touch
   */
  lift(worked, touch) {
    worked.up(touch);
    if (worked === this.app.tool) this.app.hints.noteUse();
  }

  /** @param {Touch} touch where nothing is pressed */
  point(touch) {
    this.app.selection.hover(touch);
    this.app.handles.point(touch);
  }

  /** Drop what a pointer works, unfinished. */
  #drop() {
    this.working?.worked.cancel?.();
    this.working = null;
  }

  /** Forget what fingers do. */
  #forget() {
    this.#drop();
    this.down.clear();
  }

  /** @param {PointerEvent} event */
  #move(event) {
    const {app} = this, before = this.down.get(event.pointerId);
    if (!before && event.pointerType === 'touch') return;
    if (event.pointerId === this.working?.id) {
      const parts = event.getCoalescedEvents?.() ?? [];
      for (const part of parts.length ? parts : [event]) this.working.worked.move?.(this.#touch(part));
    } else if (before) this.#moveView(event, before);
    else {
      app.tool.move?.(this.#touch(event));
      this.point(this.#touch(event));
    }
    if (before) this.down.set(event.pointerId, event);
  }

  /**
   * @param {PointerEvent} event
   * @param {PointerEvent} before
   */
  #moveView(event, before) {
    const {app} = this;
    const other = [...this.down.values()].find(({pointerId}) => pointerId !== event.pointerId);
    const dx = event.clientX - before.clientX, dy = event.clientY - before.clientY;
    if (!other) {
      app.camera.pan(dx, dy);
      return;
    }
    const x = other.clientX, y = other.clientY;
    if (app.tool.turns) {
      app.tool.turn?.(Math.atan2(before.clientY - y, before.clientX - x) -
        Math.atan2(event.clientY - y, event.clientX - x));
      return;
    }
    app.camera.pan(dx / 2, dy / 2);
    app.camera.zoom((event.clientX + x) / 2, (event.clientY + y) / 2,
      Math.hypot(event.clientX - x, event.clientY - y) /
      (Math.hypot(before.clientX - x, before.clientY - y) || 1));
  }

  /** @param {PointerEvent} event */
  #up(event) {
    this.down.delete(event.pointerId);
    if (event.pointerId !== this.working?.id) return;
    const {worked} = this.working;
    this.working = null;
    this.lift(worked, this.#touch(event));
    this.app.handles.point(this.#touch(event), event.pointerType === 'touch');
  }

  /** @param {PointerEvent} event */
  #cancel(event) {
    this.down.delete(event.pointerId);
    if (event.pointerId === this.working?.id) this.#drop();
  }

  /** @param {WheelEvent} event */
  #wheel(event) {
    const {app} = this;
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1);
    if (app.tool.turns) app.tool.turn?.(-pixels * WHEEL_TURN);
    else app.camera.zoom(event.clientX, event.clientY, Math.exp(-pixels * (event.ctrlKey ? PINCH : WHEEL)));
  }
}
