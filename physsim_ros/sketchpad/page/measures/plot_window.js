// SPDX-License-Identifier: Apache-2.0
/** A plot that the last row can read: chosen axes, several bodies, readings under the pointer, a predicted curve. */

import {choice, createElement, elementOf, fold, foldButton, iconButton, inRow, soon, textButton, toggling} from '../dom.js';
import {drawChart, EVERY} from './chart.js';
import {differenceOf, meanDistance, rangeOf, roomFor, sumOf, valueAt} from './curves.js';
import {QUANTITIES, quantityText, unitOf} from './quantities.js';
import {copyTable} from './table.js';
import {threeDigits} from '../rounding.js';
import {isRoomy} from '../view/room.js';
import {watchTheme} from '../view/theme.js';
import {t} from '../strings.js';
import {distance} from '../vectors.js';

/** @import {Palette, Parts, Point, Sample} from '../types.js' */
/** @import {Curve, Scales} from './chart.js' */

const SIZE = 18, NARROW_SIZE = 14; // px: of the font, and on a telephone
const NARROW = 560; // px
/** Colours of the bodies, one after the other. @type {(keyof Palette)[]} */
const COLORS = ['accent', 'force', 'friction', 'weight', 'joint', 'air'];

/** @typedef {Parts<'connection' | 'lessons' | 'notes' | 'records' | 'room' | 'selection' | 'view' | 'words' | 'world'>} PlotParts */

export class PlotWindow {
  /** @param {PlotParts} parts */
  constructor(parts) {
    this.parts = parts;
    this.element = elementOf('plot');
    /** @type {string[]} of bodies */
    this.names = [];
    this.axes = {x: 'time', y: 'y'};
    this.sums = false; // the sum over the bodies is shown, too
    this.differs = false; // in place of this run and the last one, their difference is shown
    this.predicts = false; // the pointer draws the curve that is expected of the first body
    /** @type {number[][]} that was drawn, from left to right */
    this.predicted = [];
    this.canvas = createElement('canvas', {role: 'img', 'aria-label': t('Large plot')});
    this.reading = createElement('output', {}, '');
    this.legend = createElement('div', {className: 'row legend'});
    /** @type {?Scales} */
    this.scales = null;
    /** @type {?Point} pointer on the canvas [px] */
    this.pointed = null;
    this.canvas.onpointermove = ({offsetX, offsetY, buttons, pointerId}) => {
      this.pointed = [offsetX, offsetY];
      if (this.predicts && buttons) this.#predict(offsetX, offsetY, pointerId);
      this.#draw();
    };
    this.canvas.onpointerdown = ({offsetX, offsetY, pointerId}) => {
      if (this.predicts) this.#predict(offsetX, offsetY, pointerId);
    };
    this.canvas.onpointerleave = () => {
      this.pointed = null;
      this.#draw();
    };
    parts.view.overlays.push(soon(() => this.#draw(), EVERY));
    parts.connection.on('world', () => this.isOpen && this.close());
    watchTheme(() => this.#draw());
    new ResizeObserver(() => this.#draw()).observe(this.element);
  }

  /** @param {string[]} names of bodies */
  open(names) {
    const {parts} = this, {room, selection, lessons} = parts;
    const quantities = Object.entries(QUANTITIES).map(([key, {label}]) => /** @type {[string, string]} */ ([key, label]));
    const select = (/** @type {'x' | 'y'} */ axis, /** @type {string} */ label) => choice(label, quantities, this.axes[axis], (key) => {
      this.axes[axis] = key;
      this.predicted = [];
      this.#draw();
    });
    const rest = inRow(this.#adder(), this.#switch('sums', t('Sum'), t('Momentum or energy of all bodies of the plot together')),
      this.#switch('differs', t('Difference'), t('This run less the last one, at the same times')),
      this.#switch('predicts', t('Predict the curve'), t('Draw the curve that you expect, then play')), textButton(t('Copy table'), () => copyTable(parts, this.names)));
    rest.classList.add('rest');
    const more = foldButton(this.element, t('Bodies, sum, table'), () => {});
    fold(this.element, more, true);
    this.element.replaceChildren(createElement('header', {},
      inRow(select('y', t('Upwards')), createElement('span', {}, t('over')), select('x', t('To the right')), this.legend),
      more, iconButton(t('Close the plot'), 'close', () => this.close())), rest, this.reading, this.canvas);
    this.element.hidden = false;
    this.#show(names);
    lessons.settle();
    // On a small page there is no room for plot and panel.
    if (!isRoomy()) selection.select([]);
    room.fit();
  }

  get isOpen() {
    return !this.element.hidden;
  }

  close() {
    this.element.hidden = true;
    this.names = [];
    this.parts.records.want(this, []);
    this.parts.room.fit();
  }

  /**
   * @param {'sums' | 'differs' | 'predicts'} what is switched
   * @param {string} label
   * @param {string} title
   */
  #switch(what, label, title) {
    const button = toggling(textButton(label, () => {}), () => this[what], () => {
      this[what] = !this[what];
      if (!this.predicts) this.predicted = [];
      this.#draw();
    });
    button.title = title;
    return button;
  }

  /**
   * Continue the curve that is expected; where the pointer goes back, it is drawn anew from there.
   * @param {number} x [px]
   * @param {number} y [px]
   * @param {number} pointer that draws
   */
  #predict(x, y, pointer) {
    if (!this.scales) return;
    this.canvas.setPointerCapture(pointer);
    const at = [valueAt(this.scales.x, x), valueAt(this.scales.y, y)];
    this.predicted = [...this.predicted.filter((point) => point[0] < at[0]), at];
  }

  #adder() {
    const input = choice(t('Add a body'), this.parts.words.choices(t('Add a body …')), '', (added) => {
      this.#show([...this.names.filter((name) => name !== added), added]);
      input.value = '';
    });
    return input;
  }

  /** @param {string[]} names */
  #show(names) {
    this.names = names;
    this.parts.records.want(this, names);
    this.legend.replaceChildren(...names.map((name, i) => {
      const button = textButton(`${this.parts.words.item(name)} ×`, () => this.#show(names.filter((each) => each !== name)));
      button.style.color = `var(--${COLORS[i % COLORS.length]})`;
      button.title = t('Take {name} out of the plot', {name: this.parts.words.item(name)});
      return button;
    }));
    this.#draw();
  }

  #draw() {
    const {canvas: {clientWidth: width, clientHeight: height}, parts: {world, view: {palette}}, axes: {x, y}} = this;
    if (!this.isOpen || !width || !height) return;
    const curves = this.#curves(), real = curves[0]?.points ?? [];
    // The axes have room for a curve before it is drawn.
    const room = this.predicts ? roomFor(y, [...real, ...this.predicted], world.extent()) : [];
    this.scales = drawChart(this.canvas, {width, height, size: width < NARROW ? NARROW_SIZE : SIZE, palette, curves, room,
      xLabel: QUANTITIES[x].label, yLabel: QUANTITIES[y].label, range: rangeOf([...curves, {points: room}]),
      mark: x === 'time' ? world.frame.time : undefined});
    const read = this.pointed && this.#markNearest(curves, this.pointed);
    this.reading.textContent = read ? `${quantityText(x, read[0])} · ${quantityText(y, read[1])}` : this.#judge(real);
  }

  /** @returns {Curve[]} of the bodies, that of the first one first, and of what is shown beside them */
  #curves() {
    const {parts: {world, view: {palette}, records}, axes: {x, y}, predicted} = this, {gravity} = world.scene;
    /** @type {Curve[]} */
    const curves = [];
    /** @type {Curve[]} those that a sum is of */
    const summands = [];
    this.names.forEach((name, i) => {
      const body = world.body(name), record = records.bodies.get(name);
      if (!body || !record) return;
      const points = (/** @type {Sample[]} */ samples) => samples.map((sample) =>
        [QUANTITIES[x].of(sample, body, gravity), QUANTITIES[y].of(sample, body, gravity)]).filter((point) => point.every(Number.isFinite));
      const color = palette[COLORS[i % COLORS.length]];
      const now = points(record.samples), left = points(record.left), differs = this.differs && x === 'time';
      const solid = {points: differs ? differenceOf(now, left) : now, color, width: 3};
      summands.push(solid);
      curves.push(solid);
      if (!differs) curves.push({points: left, color, width: 2, dash: [6, 6], alpha: 0.7});
    });
    if (this.sums && QUANTITIES[y].sums && x === 'time') curves.push({points: sumOf(summands), color: palette.ink, width: 4});
    if (this.predicts) curves.push({points: predicted, color: palette.momentum, width: 3, dash: [8, 6]});
    return curves;
  }

  /**
   * @param {number[][]} real curve of the first body
   * @returns {string} how far the one that was predicted is off; '' where there is none
   */
  #judge(real) {
    if (!this.predicted.length || real.length < 2) return '';
    return t('off by {amount}', {amount: `${threeDigits(meanDistance(this.predicted, real))} ${unitOf(this.axes.y)}`});
  }

  /**
   * Mark the point of a curve next to the pointer.
   * @param {Curve[]} curves
   * @param {Point} pointed [px]
   * @returns {?number[]} its values; null where there is none
   */
  #markNearest(curves, pointed) {
    const {scales} = this;
    if (!scales) return null;
    let least = Infinity, nearest = [0, 0], color = '';
    for (const curve of curves) for (const point of curve.points) {
      const far = distance([scales.x(point[0]), scales.y(point[1])], pointed);
      if (far < least) [least, nearest, color] = [far, point, curve.color];
    }
    if (!color) return null;
    const ctx = /** @type {CanvasRenderingContext2D} */ (this.canvas.getContext('2d'));
    ctx.fillStyle = color;
    ctx.beginPath();
    ctx.arc(scales.x(nearest[0]), scales.y(nearest[1]), 6, 0, 2 * Math.PI);
    ctx.fill();
    return nearest;
  }
}
