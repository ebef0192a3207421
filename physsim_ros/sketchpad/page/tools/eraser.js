// SPDX-License-Identifier: Apache-2.0
/** The eraser, the other end of a stylus: what it passes over is outlined, and deleted when it is lifted. */

import {Tool} from './tool.js';
import {distance} from '../vectors.js';

/** @import {Parts, SceneView, Touch} from '../types.js' */

const STEP = 3; // px between the places at which it looks for bodies
const NEAR = 6; // px: a joint that near to it is meant

/** @extends {Tool<Parts<'camera' | 'connection' | 'world'>>} */
export class Eraser extends Tool {
  /** @type {Set<string>} bodies that it has passed over */
  bodies = new Set();
  /** @type {Set<string>} */
  joints = new Set();

  /** @param {Touch} touch */
  begin(touch) {
    this.bodies.clear();
    this.joints.clear();
    this.#meet(touch);
  }

  /** @param {Touch} touch */
  move(touch) {
    const before = this.path[this.path.length - 2];
    const steps = Math.ceil(distance(before.page, touch.page) / STEP), [x, y] = before.at, [toX, toY] = touch.at;
    for (let step = 1; step <= steps; step++) {
      this.#meet({...touch, at: [x + (toX - x) * step / steps, y + (toY - y) * step / steps]});
    }
  }

  end() {
    const {connection} = this.parts;
    if (this.bodies.size) connection.send('delete', {names: [...this.bodies]});
    // A joint goes with its body.
    else for (const name of this.joints) connection.send('unjoin', {name});
  }

  /** @param {Touch} touch where it is */
  #meet(touch) {
    const {world, camera} = this.parts, body = world.nameAt(touch), joint = world.jointAt(touch.at, touch.slop + NEAR / camera.scale, body !== '');
    if (joint) this.joints.add(joint);
    else if (body) this.bodies.add(body);
  }

  /** @param {SceneView} view */
  draw(view) {
    const {warn} = view.palette;
    if (!this.path.length) return;
    view.line(this.path.map(({at}) => at), warn, [2, 6]);
    for (const name of this.bodies) view.outline(name, warn);
  }
}
