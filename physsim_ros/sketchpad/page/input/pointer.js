// SPDX-License-Identifier: Apache-2.0
/**
 * Mouse, pen and fingers on the canvas. One pointer works the tool in hand; two fingers move and zoom
 * the view; once a stylus was seen it draws, and a finger moves the view.
 */

/** @import {App, Tool, Touch} from '../types.js' */

const FINGER = 14, MOUSE = 2; // px of slop
const WHEEL = 0.0015, PINCH = 0.01; // of zoom, in powers of e a pixel of wheel
const WHEEL_TURN = 0.002; // rad a pixel

export class Pointers {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {Map<number, PointerEvent>} */
    this.down = new Map();
    this.working = -1; // id of the pointer that works the tool
    /** @type {Pick<Tool, 'down' | 'move' | 'up' | 'cancel' | 'clicks'>} that it works */
    this.worked = app.tool;
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
    const {app} = this;
    app.view.canvas.setPointerCapture(event.pointerId);
    if (event.pointerType === 'pen') {
      this.stylus = true;
      this.#forget();
    } else if (this.down.get(this.working)?.pointerType === 'pen') return; // of the palm
    this.down.set(event.pointerId, event);
    app.view.canvas.focus({preventScroll: true});
    app.cursor.hide();
    app.selection.hover(null);
    const moves = event.button > 0 || this.space || app.viewOnly ||
      (this.stylus && event.pointerType === 'touch');
    if (this.down.size === 1 && !moves) {
      this.working = event.pointerId;
      this.press(this.#touch(event));
    } else if (this.down.size > 1 && this.working >= 0 && !app.tool.turns) {
      this.worked.cancel?.();
      this.working = -1;
    }
  }

  /** @param {Touch} touch where the tool in hand, or a handle that is there, is pressed */
  press(touch) {
    const {app} = this;
    app.time.endRewind();
    this.worked = app.handles.isAt(touch) ? app.handles : app.tool;
    this.worked.down?.(touch);
  }

  /** @param {Touch} touch where it is lifted */
  lift(touch) {
    this.worked.up(touch);
    if (this.worked === this.app.tool) this.app.hints.noteUse();
  }

  /** @param {Touch} touch where nothing is pressed */
  point(touch) {
    this.app.selection.hover(touch);
    this.app.handles.point(touch);
  }

  /** Forget what fingers do. */
  #forget() {
    if (this.working >= 0) this.worked.cancel?.();
    this.working = -1;
    this.down.clear();
  }

  /** @param {PointerEvent} event */
  #move(event) {
    const {app} = this, before = this.down.get(event.pointerId);
    if (!before && event.pointerType === 'touch') return;
    if (event.pointerId === this.working) {
      const parts = event.getCoalescedEvents?.() ?? [];
      for (const part of parts.length ? parts : [event]) this.worked.move?.(this.#touch(part));
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
    if (event.pointerId !== this.working) return;
    this.working = -1;
    this.lift(this.#touch(event));
    this.app.handles.point(this.#touch(event), event.pointerType === 'touch');
  }

  /** @param {PointerEvent} event */
  #cancel(event) {
    this.down.delete(event.pointerId);
    if (event.pointerId === this.working) this.worked.cancel?.();
    this.working = -1;
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
