// SPDX-License-Identifier: Apache-2.0
/** A plot that the last row can read: chosen axes, several bodies, readings under the pointer, tables. */

import {csvOf} from '../csv.js';
import {choice, createElement, download, elementOf, foldButton, iconButton, inRow, soon, textButton, toggling} from '../dom.js';
import {drawChart, EVERY, spanOf} from './chart.js';
import {QUANTITIES, toldOf} from './quantities.js';
import {digits, threeDigits} from '../rounding.js';
import {isRoomy} from '../view/room.js';
import {t} from '../strings.js';
import {distance} from '../vectors.js';

/** @import {Palette, Parts, Sample} from '../types.js' */
/** @import {Curve, Scales} from './chart.js' */

const SIZE = 18, NARROW_SIZE = 14; // px: of the font, and on a telephone
const NARROW = 560; // px
const NOTHING = 1e-9; // in its unit: rounding of what is 0
const LONG = 3, PREDICTED = 10; // s and units that a prediction has room for
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
    /** @type {?[number, number]} pointer on the canvas [px] */
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
    const drawSoon = soon(() => this.#draw(), EVERY);
    parts.connection.on('frame', drawSoon);
    parts.connection.on('body', drawSoon);
    parts.connection.on('world', () => this.isOpen && this.close());
    new ResizeObserver(() => this.#draw()).observe(this.element);
  }

  /** @param {string[]} names of bodies */
  open(names) {
    const quantities = Object.entries(QUANTITIES).map(([key, {label}]) => /** @type {[string, string]} */ ([key, label]));
    const select = (/** @type {'x' | 'y'} */ axis, /** @type {string} */ label) => choice(label, quantities, this.axes[axis], (key) => {
      this.axes[axis] = key;
      this.predicted = [];
      this.#draw();
    });
    const rest = inRow(this.#adder(), this.#switch('sums', t('Sum'), t('Momentum or energy of all bodies of the plot together')),
      this.#switch('differs', t('Difference'), t('This run less the last one, at the same times')),
      this.#switch('predicts', t('Predict the curve'), t('Draw the curve that you expect, then play')), textButton(t('Copy table'), () => this.#copyTable()));
    rest.classList.add('rest');
    const more = foldButton(t('Bodies, sum, table'), () => {
      more.setAttribute('aria-expanded', String(!this.element.classList.toggle('folded')));
    }, '');
    more.setAttribute('aria-expanded', 'false');
    this.element.classList.add('folded');
    this.element.replaceChildren(createElement('header', {},
      inRow(select('y', t('Upwards')), createElement('span', {}, t('over')), select('x', t('To the right')), this.legend),
      more, iconButton(t('Close the plot'), 'close', () => this.close())), rest, this.reading, this.canvas);
    this.element.hidden = false;
    this.#show(names);
    const {room, selection, lessons} = this.parts;
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
      button.style.color = this.parts.view.palette[COLORS[i % COLORS.length]];
      button.title = t('Take {name} out of the plot', {name: this.parts.words.item(name)});
      return button;
    }));
    this.#draw();
  }

  #draw() {
    if (!this.isOpen) return;
    const {world, view: {palette}, records} = this.parts, {gravity} = world.scene, {x, y} = this.axes;
    /** @type {Curve[]} */
    const curves = [];
    this.names.forEach((name, i) => {
      const body = world.body(name), record = records.bodies.get(name);
      if (!body || !record) return;
      const points = (/** @type {Sample[]} */ samples) => samples.map((sample) =>
        [QUANTITIES[x].of(sample, body, gravity), QUANTITIES[y].of(sample, body, gravity)]).filter((point) => point.every(Number.isFinite));
      const color = palette[COLORS[i % COLORS.length]];
      if (this.differs && x === 'time') curves.push({points: differenceOf(points(record.samples), points(record.left)), color, width: 3});
      else curves.push({points: points(record.samples), color, width: 3},
        {points: points(record.left), color, width: 2, dash: [6, 6], alpha: 0.7});
    });
    if (this.sums && QUANTITIES[y].sums && x === 'time') curves.push({points: sumOf(curves.filter(({dash}) => !dash)), color: palette.ink, width: 4});
    const real = curves[0]?.points ?? [];
    if (this.predicts) {
      curves.push({points: this.predicted, color: palette.momentum, width: 3, dash: [8, 6]});
      // The axes have room for a curve before there is one.
      curves.push({points: roomFor(y, [...real, ...this.predicted], world.extent()), color: palette.paper, width: 0, alpha: 0});
    }
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (!width || !height) return;
    this.scales = drawChart(this.canvas, {width, height, size: width < NARROW ? NARROW_SIZE : SIZE, palette, curves,
      xLabel: QUANTITIES[x].label, yLabel: QUANTITIES[y].label, range: rangeOf(curves),
      mark: x === 'time' ? world.frame.time : undefined});
    this.#read(curves);
    if (!this.pointed && this.predicted.length && real.length > 1) this.reading.textContent = t('off by {amount}', {amount: `${threeDigits(apart(this.predicted, real))} ${QUANTITIES[y].label.replace(/.*\[|\]/g, '')}`});
  }

  /**
   * Tell the point of a curve next to the pointer.
   * @param {Curve[]} curves
   */
  #read(curves) {
    const {pointed, scales} = this;
    if (!pointed || !scales) {
      this.reading.textContent = '';
      return;
    }
    let least = Infinity, nearest = [0, 0], color = '';
    for (const curve of curves) for (const point of curve.points) {
      const far = distance([scales.x(point[0]), scales.y(point[1])], pointed);
      if (far < least) [least, nearest, color] = [far, point, curve.color];
    }
    if (!color) return;
    this.reading.textContent = `${toldOf(this.axes.x, nearest[0])} · ${toldOf(this.axes.y, nearest[1])}`;
    const ctx = /** @type {CanvasRenderingContext2D} */ (this.canvas.getContext('2d'));
    ctx.fillStyle = color;
    ctx.beginPath();
    ctx.arc(scales.x(nearest[0]), scales.y(nearest[1]), 6, 0, 2 * Math.PI);
    ctx.fill();
  }

  /**
   * @param {string[]} names of bodies
   * @returns {string} a table of all quantities (CSV), the bodies one below the other
   */
  #tableOf(names) {
    const {world, records} = this.parts, columns = Object.values(QUANTITIES);
    const rows = names.flatMap((name) => {
      const body = world.body(name);
      return body ? records.samples(name).map((sample) => [...columns.map(({of}) => cellOf(of(sample, body, world.scene.gravity))), name]) : [];
    });
    return csvOf([[...columns.map(({label}) => label), t('Body')], ...rows]);
  }

  /** @param {string[]} names of bodies */
  saveTable(names) {
    download(`${names[0].replaceAll('/', '-')}.csv`, new Blob([this.#tableOf(names)], {type: 'text/csv'}));
  }

  async #copyTable() {
    try {
      await navigator.clipboard.writeText(this.#tableOf(this.names));
      this.parts.notes.showMessage(t('Table copied'));
    } catch {
      // Browsers give the clipboard to pages of this machine or with TLS only.
      this.saveTable(this.names);
    }
  }
}

/**
 * @param {number[][]} points over time
 * @param {number[][]} others
 * @returns {number[][]} points of their difference, at the times that both have
 */
function differenceOf(points, others) {
  const before = new Map(others.map(([time, value]) => [time.toFixed(4), value]));
  return points.flatMap(([time, value]) => {
    const other = before.get(time.toFixed(4));
    return other === undefined ? [] : [[time, value - other]];
  });
}

/**
 * @param {(value: number) => number} scale
 * @param {number} pixel
 * @returns {number} value that is there
 */
function valueAt(scale, pixel) {
  return (pixel - scale(0)) / (scale(1) - scale(0));
}

/**
 * @param {string} key of the quantity upwards
 * @param {number[][]} points that are known
 * @param {number[]} extent of the world
 * @returns {number[][]} corners of the part of the plot in which a curve can be drawn
 */
function roomFor(key, points, [left, low, right, high]) {
  const [least, most] = key === 'x' ? [left, right] : key === 'y' ? [low, high] : [Math.min(0, ...points.map(([, y]) => y)), Math.max(PREDICTED, ...points.map(([, y]) => y))];
  return [[0, least], [Math.max(LONG, ...points.map(([x]) => x)), most]];
}

/**
 * @param {number[][]} predicted from left to right
 * @param {number[][]} real
 * @returns {number} mean distance of the curves upwards, where both are; NaN where that is nowhere
 */
function apart(predicted, real) {
  const distances = real.flatMap(([x, y]) => {
    const after = predicted.findIndex((point) => point[0] >= x);
    if (after < 1) return [];
    const [[px, py], [qx, qy]] = predicted.slice(after - 1);
    return [Math.abs(y - py - (qy - py) * (x - px) / (qx - px))];
  });
  return distances.reduce((sum, each) => sum + each, 0) / distances.length;
}

/**
 * @param {Curve[]} curves over time
 * @returns {number[][]} points of their sum, at the times that all of them have
 */
function sumOf(curves) {
  /** @type {Map<number, number[]>} */
  const byTime = new Map();
  for (const {points} of curves) for (const [time, value] of points) byTime.set(time, [...byTime.get(time) ?? [], value]);
  return [...byTime].filter(([, values]) => values.length === curves.length).sort(([a], [b]) => a - b)
    .map(([time, values]) => [time, values.reduce((sum, value) => sum + value, 0)]);
}

/**
 * @param {Curve[]} curves
 * @returns {number[]} least and greatest x
 */
function rangeOf(curves) {
  const [least, most] = spanOf(curves, 0);
  if (least > most) return [0, 1];
  return most - least > 1e-6 ? [least, most] : [least - 0.5, most + 0.5];
}

/** @param {number} value as spreadsheets read it, whose minus is a hyphen */
function cellOf(value) {
  return Number.isNaN(value) ? '' : digits(Math.abs(value) < NOTHING ? 0 : value, 6).replaceAll('−', '-');
}
