// SPDX-License-Identifier: Apache-2.0
/**
 * Predictions: the path that a body is expected to take, drawn before time runs. Its own path is drawn beside it in each
 * run, with how far the prediction is off, and how much of it the body has gone.
 */

import {distanceTo} from '../view/body_path.js';
import {Tool} from './tool.js';
import {threeDigits} from '../rounding.js';
import {t} from '../strings.js';
import {distance} from '../vectors.js';

/** @import {Parts, Point, Sample, SceneView, Touch} from '../types.js' */

/** @typedef {Parts<'connection' | 'notes' | 'records' | 'view' | 'world'>} Needed */

const SHARES = 100; // of a prediction, at whose ends it is compared: percents

/** @extends {Tool<Needed>} */
export class Prediction extends Tool {
  /** @param {Needed} parts */
  constructor(parts) {
    super(parts);
    this.name = ''; // of the body whose way is drawn
    /** @type {Map<string, {since: number, way: Point[]}>} by body; since: time at which it was drawn [s] */
    this.ways = new Map();
    parts.view.overlays.push((view) => this.#drawAll(view));
    parts.connection.on('world', () => {
      this.ways.clear();
      this.#record();
    });
  }

  /** @param {Touch} touch */
  begin(touch) {
    const {world, notes} = this.parts;
    this.name = world.nameAt(touch);
    if (!this.name) notes.showMessage(t('Begin at the body whose way you draw'), {ok: false});
  }

  end() {
    const {name, path, parts: {world}} = this, row = world.row(name);
    if (row < 0) return;
    // Its way begins at its centre of mass, as the one that it goes.
    const centre = world.centerOf(row);
    if (this.isTap) this.ways.delete(name);
    else this.ways.set(name, {since: world.frame.time, way: [centre, ...path.slice(1).map(({at}) => at)]});
    this.#record();
  }

  #record() {
    this.parts.records.want(this, [...this.ways.keys()]);
  }

  /** @param {SceneView} view */
  draw(view) {
    if (this.name && this.path.length) view.line(this.path.map(({at}) => at), view.palette.momentum, [8, 6]);
  }

  /** @param {SceneView} view */
  #drawAll(view) {
    const {world, records} = this.parts, {camera, palette} = view;
    for (const [name, {since, way}] of this.ways) {
      if (world.row(name) < 0) continue;
      view.line(way, palette.momentum, [8, 6]);
      const [x, y] = camera.toPage(...way[way.length - 1]);
      const gone = records.past(name).filter(({time}) => time > since);
      view.line(gone.map((each) => [each.x, each.y]), palette.accent);
      const places = evenly(gone, lengthOf(way) / SHARES);
      const off = places.reduce((sum, place) => sum + distanceTo(way, place), 0) / places.length;
      const text = t('off by {length} m on average, for {share} % of the line',
        {length: threeDigits(off), share: places.length - 1});
      view.write(gone.length ? text : t('predicted'), [x + 10, y], palette.momentum);
    }
  }
}

/**
 * @param {Sample[]} samples
 * @param {number} step [m]
 * @returns {Point[]} places that far apart, for the length of a prediction
 */
function evenly(samples, step) {
  /** @type {Point[]} */
  const places = [];
  let next = 0; // of the places, from the sample before [m]
  samples.forEach(({x, y}, i) => {
    const last = samples[i - 1] ?? {x, y}, length = distance([last.x, last.y], [x, y]);
    for (; next <= length && places.length <= SHARES; next += step) {
      const share = length && next / length;
      places.push([last.x + share * (x - last.x), last.y + share * (y - last.y)]);
    }
    next -= length;
  });
  return places;
}

/** @param {Point[]} way */
function lengthOf(way) {
  return way.slice(1).reduce((sum, point, i) => sum + distance(point, way[i]), 0);
}
