// SPDX-License-Identifier: Apache-2.0
/**
 * The runs of a class in one picture: of each world the way of a body, and where it is now, in the colour of its pupil.
 *
 * The same world does the same to the bit, so that what differs is what pupils have changed.
 */

import {Camera} from '../view/camera.js';
import {colorOf} from './classroom.js';
import {choice, createElement} from '../dom.js';
import {SceneView} from '../view/scene_view.js';
import {t} from '../strings.js';

/** @import {Connection, Point, WorldState} from '../types.js' */
/** @import {Dialog} from './dialog.js' */

/** @typedef {{person: string, connection: Connection, world: WorldState}} Run of a pupil; person: '' where the seat is free */

const GAP = 24, PERIOD = 1000; // px around the world; ms between two looks at the ways
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
    this.framed = ''; // epoch of the scene that was framed, and size of the picture then [px]
    /** @type {Map<Run, Point[]>} */
    this.ways = new Map();
    this.canvas = createElement('canvas', {role: 'img', 'aria-label': TITLE, className: 'together'});
    this.camera = new Camera();
    this.view = new SceneView(this.canvas, runs[0].world, this.camera);
    this.view.overlays.push(() => this.#draw());
    for (const run of runs) {
      run.connection.on('body', ({name, x, y}) => {
        if (name === this.name) this.ways.set(run, x.map((/** @type {number} */ each, /** @type {number} */ i) => [each, y[i]]));
        this.view.dirty = true;
      });
    }
  }

  show() {
    const names = this.runs[0].world.scene.bodies.filter(({anchored, kinematic}) => !anchored && !kinematic).map(({name}) => name);
    if (!names.includes(this.name)) this.name = names[0] ?? '';
    const people = this.runs.map(({person}, i) => {
      const item = createElement('li', {hidden: !person}, person);
      item.style.color = colorOf(i);
      return item;
    });
    this.dialog.show(TITLE, choice(t('Body'), names.map((name) => [name, name]), this.name, (name) => {
      this.name = name;
      this.ways.clear();
      this.#ask();
    }), this.canvas, createElement('ul', {className: 'row'}, ...people));
    this.#ask();
    const timer = setInterval(() => this.canvas.checkVisibility() ? this.#ask() : clearInterval(timer), PERIOD);
  }

  /** Ask for the ways of the body: they have become longer, or others. */
  #ask() {
    if (this.name) for (const {connection} of this.runs) connection.send('watch', {name: this.name});
  }

  #draw() {
    const {view, camera, runs: [{world: {scene: {epoch}, count}}]} = this, {ctx} = view;
    const shown = `${epoch} ${camera.width} ${camera.height}`;
    if (count && this.framed !== shown) {
      this.framed = shown;
      camera.fit(this.runs[0].world.extent(), {left: GAP, top: GAP, right: GAP, bottom: GAP});
      view.dirty = true;
    }
    this.runs.forEach((run, i) => {
      const {world, person} = run, row = world.row(this.name), way = this.ways.get(run);
      if (!person || row < 0) return;
      if (way) view.line(way, colorOf(i), DASHES[i % DASHES.length]);
      ctx.save();
      view.bodies.setTransform(world.frame, row);
      ctx.strokeStyle = colorOf(i);
      ctx.lineWidth = 3 / camera.scale;
      ctx.stroke(view.bodies.appearance(world.scene.bodies[row]).path);
      ctx.restore();
    });
  }
}
