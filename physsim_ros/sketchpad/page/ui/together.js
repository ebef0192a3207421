// SPDX-License-Identifier: Apache-2.0
/**
 * The runs of a class in one picture: of each world the way of a body, and where it is now, in the colour of its pupil.
 *
 * The same world does the same to the bit, so that what differs is what pupils have changed.
 */

import {Camera} from '../view/camera.js';
import {colorOf} from './classroom.js';
import {choice, createElement, inRow, toggling} from '../dom.js';
import {SceneView} from '../view/scene_view.js';
import {t} from '../strings.js';
import {unionOf} from '../view/body_path.js';

/** @import {Bounds, Connection, Point, WorldState} from '../types.js' */
/** @import {Dialog} from './dialog.js' */
/** @import {Words} from '../words.js' */

/** @typedef {{person: string, connection: Connection, world: WorldState, words: Words}} Run of a pupil; person: '' where the seat is free */

const GAP = 24, PERIOD = 1000; // px around the ways; ms between two looks at them
const FAINT = 0.2, LIGHT = 72; // opacity of the others, where one run is chosen; % of the colours on dark paper
const DASHES = [[], [10, 5], [2, 5], [12, 4, 2, 4]]; // px: of lines whose colours are alike
const TITLE = t('All runs in one picture');

export class Together {
  /**
   * @param {Dialog} dialog
   * @param {Run[]} runs of all seats; the world of the first one is the background
   */
  constructor(dialog, runs) {
    this.dialog = dialog;
    this.runs = runs;
    this.name = ''; // of the body
    /** @type {?Run} that stands out */
    this.chosen = null;
    /** @type {Map<Run, Point[]>} */
    this.ways = new Map();
    this.canvas = createElement('canvas', {role: 'img', 'aria-label': TITLE, className: 'together'});
    this.camera = new Camera();
    this.view = new SceneView(this.canvas, runs[0].world, this.camera);
    this.view.overlays.push(() => this.#draw());
    for (const run of runs) {
      run.connection.on('body', ({name, x, y}) => {
        if (name === this.name) this.ways.set(run, x.map((/** @type {number} */ each, /** @type {number} */ i) => [each, y[i]]));
        this.view.redraw();
      });
    }
  }

  show() {
    const names = this.runs[0].world.scene.bodies.filter(({anchored, kinematic}) => !anchored && !kinematic).map(({name}) => name);
    if (!names.includes(this.name)) this.name = names[0] ?? '';
    const people = this.runs.map((run, i) => {
      const button = createElement('button', {type: 'button', textContent: run.person, hidden: !run.person});
      button.style.color = `light-dark(${colorOf(i)}, ${colorOf(i, LIGHT)})`;
      return toggling(button, () => this.chosen === run, () => {
        this.chosen = this.chosen === run ? null : run;
        for (const other of people) if (other !== button) other.setAttribute('aria-pressed', 'false');
        this.view.redraw();
      });
    });
    this.dialog.show(TITLE, choice(t('Body'), names.map((name) => [name, this.runs[0].words.title(name)]), this.name, (name) => {
      this.name = name;
      this.ways.clear();
      this.#ask();
    }), this.canvas, inRow(...people));
    this.#ask();
    const timer = setInterval(() => this.canvas.checkVisibility() ? this.#ask() : clearInterval(timer), PERIOD);
  }

  /** Ask for the ways of the body: they have become longer, or others. */
  #ask() {
    if (this.name) for (const {connection} of this.runs) connection.send('watch', {name: this.name});
  }

  #draw() {
    const {view, camera} = this, {ctx} = view;
    this.#frame();
    const order = this.runs.map((run, i) => ({run, i})).sort((one, other) => Number(one.run === this.chosen) - Number(other.run === this.chosen));
    for (const {run, i} of order) {
      const {world, person} = run, row = world.row(this.name), way = this.ways.get(run);
      if (!person || row < 0) continue;
      ctx.globalAlpha = !this.chosen || run === this.chosen ? 1 : FAINT;
      if (way) view.line(way, inkOf(i), DASHES[i % DASHES.length]);
      ctx.save();
      view.bodies.setTransform(world.frame, row);
      ctx.strokeStyle = inkOf(i);
      ctx.lineWidth = 3 / camera.scale;
      ctx.stroke(view.bodies.appearance(world.scene.bodies[row]).path);
      ctx.restore();
      // Where the body is now; beside the page, at its edge.
      view.numbers.push({text: person, color: inkOf(i), tip: camera.toPage(...world.centerOf(row)), along: [0, -1], named: run === this.chosen});
      ctx.globalAlpha = 1;
    }
  }

  /** Frame the ways and the bodies, as far as they stay near the world. */
  #frame() {
    const {view, runs: [{world}]} = this;
    const points = [...this.ways.values()].flat().map(([x, y]) => /** @type {Bounds} */ ([x, y, x, y]));
    const [left, low, right, high] = unionOf([...points, ...world.boxes]), [l, b, r, t] = world.extent();
    const box = /** @type {Bounds} */ ([Math.max(left, 2 * l - r), Math.max(low, 2 * b - t), Math.min(right, 2 * r - l), Math.min(high, 2 * t - b)]);
    view.frame(box, GAP, box.map((each) => each.toFixed(2)).join(' '));
  }
}

/** @param {number} number of the colour of a person, to be read on the paper of the page */
function inkOf(number) {
  return colorOf(number, document.documentElement.dataset.theme === 'dark' ? LIGHT : undefined);
}
