// SPDX-License-Identifier: Apache-2.0
/**
 * Pointers on the canvas: mouse, pen and fingers. One works the tool in hand, or the handle under
 * it; two fingers move and zoom the view; once a stylus was seen it draws, and a finger moves the view. The other end of
 * a stylus erases, and its button selects. The cursor of the keyboard (cursor.js) is one more pointer.
 *
 * Laws: what a pointer works ends by that pointer alone, or by a second finger that moves the view with it; where its end is
 * not told, it ends where it was seen last. A tool that is put down in a gesture ends that first. A tool knows
 * no pointers: its gesture begins, moves, and ends or is cancelled, and this file keeps the path.
 */

import {Emitter} from '../emitter.js';
import {Tool} from '../tools/tool.js';
import {distance} from '../vectors.js';

/** @import {Point, SceneView, Touch} from '../types.js' */

const PEN_BUTTON = 2, PEN_ERASER = 32; // bits of `buttons` (Pointer Events, section 4.1.1)
const FINGER = 14, MOUSE = 2; // px of slop
const WHEEL = 0.0015, PINCH = 0.01; // of zoom, in powers of e a pixel of wheel
const WHEEL_TURN = 0.002; // rad a pixel
const STILL = 4; // px: a right button that is dragged further moves the view

/**
 * Events: press, a pointer comes down; begin, before its gesture; end, after that, with the tool, the touch, and whether it
 * was a finger; point, with the touch of a pointer that is not pressed, null where it has left; menu, with a place [px].
 */
export class Pointers extends Emitter {
  /** @param {SceneView} view */
  constructor(view) {
    super();
    this.view = view;
    this.camera = view.camera;
    this.tool = new Tool({}); // of the toolbar, when that is there
    /** What is worked in place of the tool in hand, where it is under the pointer. @type {?(Tool & {isAt(touch: Touch): boolean})} */
    this.handles = null;
    /** Of a stylus. @type {{eraser: ?Tool, button: ?Tool}} */
    this.ends = {eraser: null, button: null};
    this.onlyMoves = false; // all pointers move the view
    this.space = false; // held: dragging moves the view
    this.stylus = false; // was seen
    /** @type {Map<number, PointerEvent>} */
    this.down = new Map();
    /** @type {?{pointer: number, isPen: boolean, tool: ?Tool}} the pointer whose gesture it is; tool: null where that was cancelled */
    this.working = null;
    /** @type {Point} where a button of the mouse was pressed [px] */
    this.pressed = [0, 0];
    const {canvas} = view;
    canvas.addEventListener('pointerdown', (event) => this.#press(event));
    canvas.addEventListener('pointermove', (event) => this.#drag(event));
    canvas.addEventListener('pointerup', (event) => this.#lift(event));
    canvas.addEventListener('pointercancel', ({pointerId, pointerType}) => {
      this.down.delete(pointerId);
      // A finger may be a palm. A stylus has drawn, and has left, or the device was turned.
      if (pointerType === 'pen') this.#endAtLast(pointerId);
      else this.cancel(pointerId);
    });
    canvas.addEventListener('pointerleave', ({pointerType}) => pointerType === 'touch' || this.emit('point'));
    // No pointer is on paper: what is shown beside one is not printed.
    addEventListener('beforeprint', () => {
      this.emit('point');
      view.draw();
    });
    canvas.addEventListener('wheel', (event) => this.#wheel(event), {passive: false});
    // The click after a tap would go to the panel that the tap has opened.
    canvas.addEventListener('touchend', (event) => event.cancelable && event.preventDefault());
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    view.overlays.push(() => new Set([this.tool, this.working?.tool]).forEach((tool) => tool?.draw(view)));
  }

  /** @returns {boolean} whether a gesture goes on, or clicks are to come */
  get isBusy() {
    return this.down.size > 0 || this.tool.open;
  }

  /**
   * @param {number} pointer
   * @param {Touch} at
   * @param {{tool?: Tool, isPen?: boolean}} how
   */
  begin(pointer, at, {tool = this.handles?.isAt(at) ? this.handles : this.tool, isPen = false} = {}) {
    // Of another pointer: the cursor of the keyboard, while the mouse draws.
    this.cancel();
    this.emit('begin');
    const touch = tool.snap(at);
    this.working = {pointer, isPen, tool};
    tool.path = [touch];
    tool.begin(touch);
  }

  /**
   * @param {number} pointer
   * @param {Touch} at
   */
  move(pointer, at) {
    const tool = this.working?.pointer === pointer ? this.working.tool : null;
    if (!tool) return;
    const touch = tool.snap(at);
    tool.path.push(touch);
    tool.move(touch);
  }

  /** @param {Touch} touch of a pointer that is not pressed */
  point(touch) {
    this.tool.point(touch);
    this.emit('point', touch);
  }

  /**
   * @param {number} pointer
   * @param {Touch} touch
   * @param {boolean} isFinger
   */
  end(pointer, touch, isFinger = false) {
    if (this.working?.pointer !== pointer) return;
    const {tool} = this.working, last = tool?.path.at(-1);
    // A browser that is late lifts the pointer beyond the place of the last move.
    if (last && distance(last.page, touch.page)) this.move(pointer, touch);
    this.working = null;
    if (!tool) return;
    tool.end(tool.snap(touch));
    if (tool === this.tool) tool.path = [];
    else this.#drop(tool);
    this.emit('end', {tool, touch, isFinger});
  }

  /** @param {number} pointer whose gesture ends where it was last */
  #endAtLast(pointer) {
    const last = this.working?.tool?.path.at(-1);
    if (last) this.end(pointer, last);
    else this.cancel(pointer);
  }

  /** @param {number | undefined} pointer whose gesture is dropped, unfinished */
  cancel(pointer = this.working?.pointer) {
    if (this.working?.pointer !== pointer) return;
    this.#drop(this.working?.tool);
    this.working = null;
  }

  /** Cancel what is begun, with the clicks that are made; the pointer that is down works nothing until it is lifted. */
  cancelAll() {
    this.#drop(this.working?.tool);
    if (this.working) this.working.tool = null;
    this.#drop(this.tool);
  }

  /** @param {?Tool | undefined} tool */
  #drop(tool) {
    if (!tool) return;
    tool.cancel();
    tool.path = [];
  }

  /** @param {Tool} tool that is taken in hand; what is drawn with another one is drawn to its end */
  take(tool) {
    if (this.working?.tool !== this.tool) this.#drop(this.tool);
    this.tool = tool;
  }

  /**
   * @param {PointerEvent} event
   * @returns {Touch}
   */
  #touch({clientX, clientY, pointerType, timeStamp, shiftKey, altKey}) {
    const {camera} = this;
    return {at: camera.toWorld(clientX, clientY), page: [clientX, clientY], time: timeStamp / 1000,
      slop: (pointerType === 'touch' ? FINGER : MOUSE) / camera.scale, grid: shiftKey ? camera.fineStep : 0, copies: altKey};
  }

  /** @param {PointerEvent} event */
  #press(event) {
    const {canvas} = this.view, {pointerId, pointerType, button, buttons} = event, isPen = pointerType === 'pen';
    canvas.setPointerCapture(pointerId);
    if (this.working?.isPen && this.working.pointer !== pointerId) return; // of the palm, or of another stylus
    if (isPen) {
      this.stylus = true;
      this.cancel();
      this.down.clear();
    }
    this.down.set(pointerId, event);
    this.pressed = [event.clientX, event.clientY];
    canvas.focus({preventScroll: true});
    this.emit('press');
    const moves = !isPen && button > 0 || this.space || this.onlyMoves || this.stylus && pointerType === 'touch';
    if (this.down.size === 1 && !moves) {
      const end = isPen && (buttons & PEN_ERASER ? this.ends.eraser : buttons & PEN_BUTTON ? this.ends.button : null);
      this.begin(pointerId, this.#touch(event), {isPen, ...end && {tool: end}});
    } else if (this.down.size > 1 && !this.tool.turns) this.cancel();
  }

  /** @param {PointerEvent} event */
  #drag(event) {
    const {pointerId, pointerType} = event;
    let before = this.down.get(pointerId);
    if (!before && pointerType === 'touch') return;
    // It was lifted where nobody was told, as behind a locked screen.
    if (before && !event.buttons) {
      this.down.delete(pointerId);
      this.#endAtLast(pointerId);
      before = undefined;
    }
    if (pointerId === this.working?.pointer) {
      const moves = event.getCoalescedEvents?.() ?? [];
      for (const each of moves.length ? moves : [event]) this.move(pointerId, this.#touch(each));
    } else if (before) this.#moveView(event, before);
    else this.point(this.#touch(event));
    if (this.down.has(pointerId)) this.down.set(pointerId, event);
  }

  /**
   * @param {PointerEvent} event
   * @param {PointerEvent} before
   */
  #moveView({pointerId, clientX, clientY}, before) {
    const {camera, tool} = this, other = [...this.down.values()].find((each) => each.pointerId !== pointerId);
    const dx = clientX - before.clientX, dy = clientY - before.clientY;
    if (!other) {
      camera.pan(dx, dy);
      return;
    }
    const x = other.clientX, y = other.clientY, wasX = before.clientX - x, wasY = before.clientY - y;
    if (tool.turns) tool.turn(Math.atan2(wasY, wasX) - Math.atan2(clientY - y, clientX - x));
    else {
      camera.pan(dx / 2, dy / 2);
      camera.zoom((clientX + x) / 2, (clientY + y) / 2, Math.hypot(clientX - x, clientY - y) / (Math.hypot(wasX, wasY) || 1));
    }
  }

  /** @param {PointerEvent} event */
  #lift(event) {
    const {pointerId, pointerType, button, clientX, clientY} = event, page = /** @type {Point} */ ([clientX, clientY]);
    this.down.delete(pointerId);
    this.end(pointerId, this.#touch(event), pointerType === 'touch');
    if (button === 2 && pointerType === 'mouse' && distance(this.pressed, page) < STILL) this.emit('menu', page);
  }

  /** @param {WheelEvent} event */
  #wheel(event) {
    const {camera, tool} = this;
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1);
    if (tool.turns) tool.turn(-pixels * WHEEL_TURN);
    else camera.zoom(event.clientX, event.clientY, Math.exp(-pixels * (event.ctrlKey ? PINCH : WHEEL)));
  }
}
