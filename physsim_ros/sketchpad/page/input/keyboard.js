// SPDX-License-Identifier: Apache-2.0
/** The keys of the page, which `?` shows. */

import {TOOLS} from '../tools/tools.js';
import {ARROWS} from '../ui/toolbar.js';

/** @import {App} from '../types.js' */

const TURN = Math.PI / 12; // rad a press of R
const ZOOM = 1.25;
const TEXTS = 'textarea, input:not([type=range], [type=checkbox], [type=color], [type=file])'; // receive all keys
const MOVES_RANGE = /^(Arrow|Page|Home|End)/;
const TAP = 300; // ms: a shorter press of the space bar plays or pauses

export class Keyboard {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.since = 0;
    /** @type {?EventTarget} of the last press of a pointer */
    this.pressed = null;
    document.addEventListener('keydown', (event) => this.#down(event));
    document.addEventListener('keyup', (event) => this.#up(event));
    document.addEventListener('pointerdown', ({target}) => { this.pressed = target; }, true);
    // Before the click, which may open a dialog that gives the focus back where it was.
    document.addEventListener('pointerup', () => this.#takeBack(), true);
    app.view.canvas.addEventListener('blur', () => app.view.canvas.classList.remove('reached'));
    app.view.canvas.addEventListener('blur', () => app.driving.liftAll());
    addEventListener('blur', () => { app.gestures.space = false; });
    const callService = (/** @type {string} */ name) => () => app.time.callService(name);
    /** @type {Record<string, () => void>} */
    this.keys = {
      '?': () => app.showHelp(), f: () => app.room.frameAll(), '+': () => this.#zoom(ZOOM), '-': () => this.#zoom(1 / ZOOM),
      r: () => app.gestures.tool.turn?.(TURN), R: () => app.gestures.tool.turn?.(-TURN),
      n: () => this.#next(1), N: () => this.#next(-1),
      Delete: () => app.selection.deleteSelected(), Backspace: () => app.selection.deleteSelected(), Escape: () => this.#drop(),
      j: callService('rewind'), J: callService('fast_rewind'), k: callService('pause'), l: callService('play'),
      L: callService('fast_forward'),
      '.': callService('step'), ',': callService('step_back'), 0: callService('reset'), 7: () => app.stopwatch.press(), 6: () => app.stopwatch.lap(), 5: () => app.toolbar.showFew(!app.toolbar.few && Boolean(app.world.scene.lesson)),
    };
    for (const {id, key} of TOOLS.flat()) this.keys[key] = () => app.toolbar.selectTool(id);
  }

  /** Focus the canvas after a click on a control; text fields and dialogs keep the focus. */
  #takeBack() {
    const {pressed, app: {view: {canvas}, dialog}} = this;
    if (!(pressed instanceof Element) || dialog.isOpen || pressed === canvas) return;
    if (pressed.closest('button, a, label, input') && !pressed.closest(TEXTS)) canvas.focus({preventScroll: true});
  }

  /** @param {KeyboardEvent} event */
  #down(event) {
    const {app} = this, {key, target} = event;
    // The canvas has a frame only when Tab has reached it.
    app.view.canvas.classList.toggle('reached', key === 'Tab');
    if (target instanceof Element && target.matches(TEXTS)) {
      if (key === 'Escape' && !app.dialog.isOpen) app.view.canvas.focus({preventScroll: true});
      return;
    }
    if (app.dialog.isOpen || app.viewOnly || event.altKey) return;
    if (target instanceof HTMLInputElement && target.type === 'range' && MOVES_RANGE.test(key)) return;
    if (event.ctrlKey || event.metaKey) {
      const undo = key === 'z' && !event.shiftKey, redo = key === 'y' || key.toLowerCase() === 'z';
      if (undo || redo) app.time.callService(undo ? 'undo' : 'redo');
      const edit = {c: () => app.selection.keep(false), x: () => app.selection.keep(true), d: () => app.selection.duplicate(), a: () => app.selection.selectAll(),
        v: () => app.selection.paste(app.selection.hoveredAt ? app.camera.toWorld(...app.selection.hoveredAt) : null)}[key];
      edit?.();
      if (undo || redo || edit) event.preventDefault();
      return;
    }
    if (/^ContextMenu$/.test(key) || key === 'F10' && event.shiftKey) {
      app.menu.open(app.cursor.shown ? app.cursor.touch.page : [app.camera.width / 2, app.camera.height / 2]);
      event.preventDefault();
      return;
    }
    const button = target instanceof HTMLButtonElement || target instanceof HTMLAnchorElement ||
      target instanceof HTMLInputElement && target.type !== 'range';
    if (key === ' ' && !button) {
      if (!event.repeat) this.since = event.timeStamp;
      app.gestures.space = true;
    } else if (key === 'Enter' && !button) {
      if (app.cursor.shown || !app.gestures.tool.finish?.()) app.cursor.press();
    } else if (key in ARROWS && !button) {
      app.cursor.move(...ARROWS[key], event.shiftKey);
    } else if (target === app.view.canvas && app.driving.press(event.code)) {
      // Tools that have these keys have them again when no robot is selected.
    } else if (key in this.keys) {
      this.keys[key]();
    } else return;
    event.preventDefault();
  }

  /** @param {KeyboardEvent} event */
  #up({key, code, timeStamp}) {
    const {app} = this;
    app.driving.lift(code);
    if (key !== ' ' || !app.gestures.space) return;
    app.gestures.space = false;
    if (timeStamp - this.since < TAP && !app.gestures.down.size) app.time.toggle();
  }

  /** @param {number} factor */
  #zoom(factor) {
    const {camera} = this.app;
    camera.zoom(camera.width / 2, camera.height / 2, factor);
  }

  /** @param {number} by */
  #next(by) {
    const {app} = this, {bodies} = app.world.scene;
    if (!bodies.length) return;
    const row = bodies.findIndex(({name}) => app.selection.names.has(name));
    const next = (row + by + bodies.length + (row < 0 && by < 0 ? 1 : 0)) % bodies.length;
    app.selection.select([bodies[next].name]);
    // There Enter works the tool.
    app.cursor.put(app.camera.toPage(...app.world.place(next, bodies[next].centroid)));
  }

  #drop() {
    const {app} = this, {plotWindow} = app;
    if (plotWindow?.isOpen) return plotWindow.close();
    app.gestures.cancelAll();
    app.readings.dismiss();
    app.cursor.hide();
    app.panel.close();
  }
}
