// SPDX-License-Identifier: Apache-2.0
/** The hand pulls a body and throws it, places and turns it in a paused world, drags a copy, and moves the view. */

import {Tool} from './tool.js';
import {placed} from '../measures/quantities.js';
import {isTap, onGrid} from '../vectors.js';

/** @import {Parts, Point, SceneView, Touch} from '../types.js' */

const CATCH = 120; // ms after which a body that is pressed is caught

/** @extends {Tool<Parts<'camera' | 'connection' | 'frames' | 'hints' | 'selection' | 'world'>>} */
export class Hand extends Tool {
  atServer = true;
  /** @type {'' | 'pressed' | 'holding' | 'carrying' | 'copying' | 'panning'} */
  state = '';
  name = ''; // of the body
  /** In the frame of the body [m]. @type {Point} */
  grip = [0, 0];
  /** From its origin to where it was grabbed [m]. @type {Point} */
  offset = [0, 0];
  yaw = 0;
  turned = false;
  moved = false;
  timer = 0;
  request = 0; // of a frame of the page

  /** @returns {boolean} whether wheel, R and a second finger turn the body */
  get turns() {
    return this.state === 'holding' && this.parts.world.paused;
  }

  /** @param {Touch} touch */
  begin(touch) {
    const {world} = this.parts, row = world.bodyAt(touch.at, touch.slop);
    this.moved = false;
    if (row < 0) this.state = 'panning';
    else {
      this.name = world.scene.bodies[row].name;
      this.grip = world.gripOn(row, touch.at);
      this.yaw = world.frame.yaw[row];
      this.offset = [touch.at[0] - world.frame.x[row], touch.at[1] - world.frame.y[row]];
      this.turned = false;
      this.state = touch.copies ? 'copying' : world.scene.bodies[row].anchored ? 'carrying' : 'pressed';
      if (this.state === 'pressed') this.timer = setTimeout(() => this.#grab(), CATCH);
    }
  }

  /** @param {Touch} touch */
  move(touch) {
    const {path} = this, far = !isTap(path[0], touch);
    this.moved ||= far;
    if (this.state === 'pressed' && far) this.#grab();
    if (this.state === 'panning' && this.moved) {
      const [x, y] = path[path.length - 2].page;
      this.parts.camera.pan(touch.page[0] - x, touch.page[1] - y);
    }
    if (this.state === 'holding') this.#sendSoon();
  }

  /** @param {Touch} touch */
  end(touch) {
    const {state, start, parts} = this;
    clearTimeout(this.timer);
    this.state = '';
    if (state === 'holding') {
      this.#sendMove();
      parts.connection.send('let_go');
      parts.frames.want(this, {});
      if (this.moved) parts.hints.completeStep('throw');
    }
    if (!this.moved) parts.selection.selectAt(touch);
    else if (start && (state === 'carrying' || state === 'copying')) {
      parts.connection.send(state === 'copying' ? 'copy_machine' : 'move_bodies', {names: [this.name], by: this.#carried(start, touch)});
    }
  }

  cancel() {
    clearTimeout(this.timer);
    if (this.state === 'holding') this.parts.connection.send('let_go');
    this.parts.frames.want(this, {});
    this.state = '';
  }

  /** @param {number} angle [rad] */
  turn(angle) {
    this.yaw += angle;
    this.turned = this.moved = true;
    this.#sendSoon();
  }

  #grab() {
    clearTimeout(this.timer);
    const {world, connection} = this.parts, row = world.row(this.name);
    if (this.state !== 'pressed' || row < 0) return;
    this.state = 'holding';
    // The body has moved since it was pressed.
    connection.send('grab', {point: world.place(row, this.grip)});
    // It tells how fast the body is.
    this.parts.frames.want(this, {velocities: true});
  }

  /** Send where the hand is once a frame of the page. */
  #sendSoon() {
    this.request ||= requestAnimationFrame(() => {
      this.request = 0;
      if (this.state === 'holding') this.#sendMove();
    });
  }

  #sendMove() {
    const yaw = this.turned && this.parts.world.paused ? {yaw: this.yaw} : {};
    if (this.last) this.parts.connection.send('move', {point: this.#target(this.last), ...yaw});
  }

  /**
   * @param {Touch} touch
   * @returns {Point} where the body is drawn to: its origin on the grid, while the key is held [m]
   */
  #target({at: [x, y], grid}) {
    const [dx, dy] = this.offset, [atX, atY] = onGrid([x - dx, y - dy], grid);
    return [atX + dx, atY + dy];
  }

  /**
   * @param {Touch} start
   * @param {Touch} touch
   * @returns {Point} by which a body is carried [m]
   */
  #carried({at: [x, y]}, touch) {
    const [atX, atY] = this.#target(touch);
    return [atX - x, atY - y];
  }

  /** @param {SceneView} view */
  draw(view) {
    const {world} = this.parts, row = world.row(this.name);
    if (row < 0 || !this.start || !this.last || !['carrying', 'copying', 'holding'].includes(this.state)) return;
    /** @type {Point} */
    let by = [0, 0];
    if (this.state !== 'holding') {
      by = this.#carried(this.start, this.last);
      view.outline(this.name, view.palette.accent, by);
    }
    view.writeBeside(placed(world, row, by), this.last);
  }
}
