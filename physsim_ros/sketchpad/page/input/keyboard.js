// SPDX-License-Identifier: Apache-2.0
/** The keys of the page, which `?` shows. */

import {TOOLS} from '../tools/tools.js';
import {ARROWS} from '../ui/toolbar.js';

/** @import {Parts} from '../types.js' */

const TURN = Math.PI / 12; // rad a press of R
const ZOOM = 1.25;
const TEXTS = 'textarea, select, input:not([type=range], [type=checkbox], [type=color], [type=file])'; // receive all keys
const PRESSED = 'a, button, summary, input:not([type=range])'; // Space, Enter and arrow keys are theirs
const MOVES_RANGE = /^(Arrow|Page|Home|End)/;
const TAP = 300; // ms: a shorter press of the space bar plays or pauses

export class Keyboard {
  /** @param {Parts<'camera' | 'cursor' | 'dialog' | 'driving' | 'panel' | 'people' | 'plotting' | 'pointers' | 'readings' | 'room' | 'selection' | 'settings' | 'stopwatch' | 'time' | 'toolbar' | 'view' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.since = 0;
    /** @type {?EventTarget} of the last press of a pointer */
    this.pressed = null;
    document.addEventListener('keydown', (event) => this.#down(event));
    document.addEventListener('keyup', (event) => this.#up(event));
    document.addEventListener('pointerdown', ({target}) => { this.pressed = target; }, true);
    // Before the click, which may open a dialog that gives the focus back where it was.
    document.addEventListener('pointerup', () => this.#takeBack(), true);
    parts.view.canvas.addEventListener('blur', () => parts.view.canvas.classList.remove('reached'));
    parts.view.canvas.addEventListener('blur', () => parts.driving.liftAll());
    addEventListener('blur', () => { parts.pointers.space = false; });
    const callService = (/** @type {string} */ name) => () => parts.time.callService(name);
    /** @type {Record<string, () => unknown>} */
    this.keys = {
      '?': () => parts.settings.showHelp(), f: () => parts.pointers.down.size || parts.room.frameAll(), '+': () => this.#zoom(ZOOM), '-': () => this.#zoom(1 / ZOOM),
      r: () => parts.pointers.tool.turn(TURN), R: () => parts.pointers.tool.turn(-TURN),
      n: () => this.#next(1), N: () => this.#next(-1),
      Delete: () => parts.selection.deleteSelected(), Backspace: () => parts.selection.deleteSelected(), Escape: () => this.#drop(),
      j: callService('rewind'), J: callService('fast_rewind'), k: callService('pause'), l: callService('play'),
      L: callService('fast_forward'),
      '.': callService('step'), ',': callService('step_back'), 0: callService('reset'), 7: () => parts.stopwatch.press(), 6: () => parts.stopwatch.lap(), 5: () => parts.toolbar.showFew(!parts.toolbar.few && Boolean(parts.world.scene.lesson)),
    };
    for (const {id, key} of TOOLS.flat()) this.keys[key] = () => parts.toolbar.selectTool(id);
  }

  /** Focus the canvas after a click on a control; text fields and dialogs keep the focus. */
  #takeBack() {
    const {pressed, parts: {view: {canvas}, dialog}} = this;
    if (!(pressed instanceof Element) || dialog.isOpen || pressed === canvas) return;
    if (pressed.closest('button, a, label, input') && !pressed.closest(TEXTS)) canvas.focus({preventScroll: true});
  }

  /** @param {KeyboardEvent} event */
  #down(event) {
    const {parts} = this, {key, target} = event;
    // The canvas has a frame only when Tab has reached it.
    parts.view.canvas.classList.toggle('reached', key === 'Tab');
    if (target instanceof Element && target.matches(TEXTS)) {
      if (key === 'Escape' && !parts.dialog.isOpen) parts.view.canvas.focus({preventScroll: true});
      return;
    }
    if (parts.dialog.isOpen || parts.people.viewOnly || event.altKey) return;
    if (target instanceof HTMLInputElement && target.type === 'range' && MOVES_RANGE.test(key)) return;
    if (event.ctrlKey || event.metaKey ? this.#edit(event) : this.#work(event)) event.preventDefault();
  }

  /**
   * @param {KeyboardEvent} event with Ctrl
   * @returns {boolean} whether it has a meaning here
   */
  #edit({key, shiftKey, target}) {
    const {camera, selection, time, view} = this.parts;
    // A text that somebody has selected on the page is copied by the browser.
    if (target !== view.canvas && key === 'c' && String(getSelection())) return false;
    const undo = () => time.callService('undo'), redo = () => time.callService('redo');
    const edit = {z: shiftKey ? redo : undo, Z: redo, y: redo,
      c: () => selection.keep(false), x: () => selection.keep(true), d: () => selection.duplicate(), a: () => selection.selectAll(),
      v: () => selection.paste(selection.pointed && camera.toWorld(...selection.pointed.page))}[key];
    edit?.();
    return edit !== undefined;
  }

  /**
   * @param {KeyboardEvent} event
   * @returns {boolean} whether it has a meaning here
   */
  #work({key, code, shiftKey, repeat, timeStamp, target}) {
    const {camera, cursor, driving, pointers, settings, view} = this.parts;
    if (key === 'ContextMenu' || key === 'F10' && shiftKey) {
      pointers.emit('menu', cursor.shown ? cursor.touch.page : [camera.width / 2, camera.height / 2]);
      return true;
    }
    const control = target instanceof Element ? target : null, isPressed = control?.matches(PRESSED);
    if (key === ' ' && !isPressed) {
      if (!repeat) this.since = timeStamp;
      pointers.space = true;
    } else if (key === 'Enter' && !isPressed) {
      if (cursor.shown || !pointers.tool.finish()) cursor.press();
    } else if (key in ARROWS && !isPressed) {
      cursor.move(...ARROWS[key], shiftKey);
    } else if (target === view.canvas && driving.press(code)) {
      // Tools that have these keys have them again when no robot is selected.
    } else if (key in this.keys && (key.length > 1 || settings.letters && !control?.closest('aside, section'))) {
      this.keys[key]();
    } else return false;
    return true;
  }

  /** @param {KeyboardEvent} event */
  #up({key, code, timeStamp}) {
    const {parts} = this;
    parts.driving.lift(code);
    if (key !== ' ' || !parts.pointers.space) return;
    parts.pointers.space = false;
    if (timeStamp - this.since < TAP && !parts.pointers.down.size) parts.time.toggle();
  }

  /** @param {number} factor */
  #zoom(factor) {
    const {camera, pointers} = this.parts;
    // A stroke would leap to where the pointer is then.
    if (!pointers.down.size) camera.zoom(camera.width / 2, camera.height / 2, factor);
  }

  /** @param {number} by */
  #next(by) {
    const {parts} = this, {bodies} = parts.world.scene;
    if (!bodies.length) return;
    const row = bodies.findIndex(({name}) => parts.selection.names.has(name));
    const next = (row + by + bodies.length + (row < 0 && by < 0 ? 1 : 0)) % bodies.length;
    parts.selection.select([bodies[next].name]);
    // There Enter works the tool.
    parts.cursor.put(parts.camera.toPage(...parts.world.centerOf(next)));
  }

  #drop() {
    const {parts} = this;
    if (parts.plotting.close()) return;
    parts.pointers.cancelAll();
    parts.readings.dismiss();
    parts.cursor.hide();
    parts.panel.close();
  }
}
