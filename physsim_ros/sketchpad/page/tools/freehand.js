// SPDX-License-Identifier: Apache-2.0
/** Tools that are drawn with: the pen, whose strokes become bodies, and the lasso, whose loops select them. */

import {Tool} from './tool.js';
import {inside, unionOf} from '../view/body_path.js';
import {threeDigits} from '../rounding.js';

/** @import {Parts, Point, SceneView, Touch} from '../types.js' */

const TAP_TIME = 0.4; // s: a longer press of the pen is no tap
const MOST_SAMPLES = 4000; // of a stroke that is sent

/** A freehand stroke, sent when the pen is lifted; a tap selects the body under it. @extends {Tool<Parts<'connection' | 'readings' | 'selection'>>} */
export class Pen extends Tool {
  kept = 1; // one in so many samples: a long stroke is thinned out evenly
  count = 0; // of samples after the first

  begin() {
    this.kept = 1;
    this.count = 0;
  }

  move() {
    // The newest sample is always there.
    if (this.count++ % this.kept) this.path.splice(-2, 1);
    if (this.path.length <= MOST_SAMPLES) return;
    this.path.splice(0, Infinity, ...this.path.filter((_, i) => i % 2 === 0));
    this.kept *= 2;
  }

  /** @param {Touch} touch */
  end(touch) {
    const {parts, path} = this;
    if (this.isTap && touch.time - path[0].time < TAP_TIME) {
      parts.selection.selectAt(touch);
      return;
    }
    const id = parts.connection.send('stroke', {points: path.map(({at, time}) => [...at, time])});
    parts.readings.addStroke(id, path.map(({at}) => at));
  }

  /** @param {SceneView} view */
  draw(view) {
    if (!this.last) return;
    view.line(this.path.map(({at}) => at), view.palette.accent);
    const [left, low, right, high] = unionOf(this.path.map(({at: [x, y]}) => [x, y, x, y]));
    view.writeBeside(`${threeDigits(right - left)} × ${threeDigits(high - low)} m`, this.last);
  }
}

/** A loop selects the bodies in it; the selected bodies are moved by dragging one. @extends {Tool<Parts<'connection' | 'selection' | 'world'>>} */
export class Lasso extends Tool {
  carrying = false;

  /** @param {Touch} touch */
  begin(touch) {
    this.carrying = this.parts.selection.names.has(this.parts.world.nameAt(touch));
  }

  /** @param {Touch} touch */
  end(touch) {
    const {parts, path} = this;
    if (this.isTap) parts.selection.selectAt(touch);
    else if (this.carrying) parts.connection.send(path[0].copies ? 'copy_machine' : 'move_bodies', {names: [...parts.selection.names], by: offset(path)});
    else {
      const {world} = parts, loop = path.map(({at}) => at);
      parts.selection.select(world.scene.bodies.filter((_, row) => row < world.count &&
        inside(loop, world.centerOf(row))).map(({name}) => name));
    }
  }

  /** @param {SceneView} view */
  draw(view) {
    if (!this.path.length) return;
    if (!this.carrying) view.line(this.path.map(({at}) => at), view.palette.accent, [6, 6]);
    else for (const name of this.parts.selection.names) view.outline(name, view.palette.accent, offset(this.path));
  }
}

/**
 * @param {Touch[]} path
 * @returns {Point} from its first to its last point [m]
 */
function offset(path) {
  const [x, y] = path[0].at, [endX, endY] = path[path.length - 1].at;
  return [endX - x, endY - y];
}
