// SPDX-License-Identifier: Apache-2.0
/** The pen: a freehand stroke, sent when the pen is lifted; a tap selects the body under it. */

/** @import {App, SceneView, Touch} from '../types.js' */

const TAP = 5; // px: no farther, and no longer than TAP_TIME, is a tap
const TAP_TIME = 0.4; // s
const MOST_SAMPLES = 4000;

export class Pen {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {Touch[]} */
    this.samples = [];
  }

  /** @param {Touch} touch */
  down(touch) {
    this.samples = [touch];
  }

  /** @param {Touch} touch */
  move(touch) {
    if (this.samples.length && this.samples.length < MOST_SAMPLES) this.samples.push(touch);
  }

  /** @param {Touch} touch */
  up(touch) {
    const samples = this.samples, {app} = this;
    this.samples = [];
    const [x, y] = samples[0]?.page ?? touch.page;
    const reach = Math.max(...samples.map(({page}) => Math.hypot(page[0] - x, page[1] - y)), 0);
    if (reach <= TAP && touch.time - (samples[0]?.time ?? 0) < TAP_TIME) {
      app.selection.selectAt(touch);
      return;
    }
    const id = app.connection.send('stroke', {points: samples.map(({at, time}) => [...at, time])});
    app.readings.addStroke(id, samples.map(({at}) => at));
  }

  cancel() {
    this.samples = [];
  }

  /** @param {SceneView} view */
  draw(view) {
    if (this.samples.length) view.line(this.samples.map(({at}) => at), view.palette.accent);
  }
}
