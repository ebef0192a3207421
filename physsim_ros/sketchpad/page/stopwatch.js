// SPDX-License-Identifier: Apache-2.0
/** The stopwatch that gates start and stop, and the counter of collisions: within the step, as the server tells touches. */

import {createElement, inRow, textButton} from './dom.js';

/** @import {App} from './types.js' */
/** @import {Content} from './panel.js' */

/** @typedef {{name: string, other: string, time: number}} Touched a body that was followed, by another one */

const LISTED = 200; // bodies that can be chosen
const MOST = 10000; // touches that are kept
const SAME = 1e-9; // s

export class Stopwatch {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.start = this.stop = this.counted = ''; // names of bodies
    /** @type {Touched[]} in the order of time */
    this.touches = [];
    this.shown = 0; // time [s]
    this.following = false;
    this.time = createElement('output', {className: 'reading', 'aria-label': 'Stopwatch'});
    this.details = createElement('p');
    this.count = createElement('output', {className: 'reading', 'aria-label': 'Number of collisions'});
    app.connection.on('touches', ({touches}) => this.#add(touches));
    app.connection.on('frame', ({ghost, time}) => ghost || this.#goTo(time));
    app.connection.on('open', () => this.#follow());
    app.connection.on('world', () => {
      this.start = this.stop = this.counted = '';
      this.#follow();
      this.#clear();
    });
  }

  /** @returns {Content} of the panel */
  content() {
    queueMicrotask(() => this.#update());
    return {title: 'Measure', rest: [
      createElement('p', {textContent: 'Ruler and protractor are among the tools. A gate lets other bodies through: tap a body and tick Gate.'}),
      createElement('h3', {textContent: 'Stopwatch'}),
      this.#chooser('start', 'Starts when touched', 'at 0 s'),
      this.#chooser('stop', 'Stops when touched', 'never'),
      this.time, this.details,
      createElement('h3', {textContent: 'Collisions'}),
      this.#chooser('counted', 'Collisions of', 'no body'),
      this.count, inRow(textButton('Count from here', () => this.#clear()))]};
  }

  /**
   * @param {'start' | 'stop' | 'counted'} role
   * @param {string} label
   * @param {string} none
   */
  #chooser(role, label, none) {
    const {bodies} = this.app.world.scene, gates = bodies.filter(({sensor}) => sensor);
    const names = [...gates, ...bodies.filter(({sensor}) => !sensor)].slice(0, LISTED).map(({name}) => name);
    const input = createElement('select', {'aria-label': label, onchange: () => {
      this[role] = input.value;
      this.#follow();
    }}, createElement('option', {value: '', textContent: none}), ...names.map((name) =>
      createElement('option', {value: name, textContent: name})));
    input.value = this[role];
    return createElement('label', {}, label, input);
  }

  #follow() {
    const names = [...new Set([this.start, this.stop, this.counted])].filter((name) => name);
    if (names.length || this.following) this.app.connection.send('follow', {names});
    this.following = names.length > 0;
    this.#update();
  }

  /** @param {[string, string, number][]} touches */
  #add(touches) {
    for (const [name, other, time] of touches) {
      // A replay tells the same ones again.
      const known = this.touches.some((each) => each.name === name && each.other === other && Math.abs(each.time - time) < SAME);
      if (!known) this.touches.push({name, other, time});
    }
    this.touches.sort((one, other) => one.time - other.time);
    this.touches.splice(0, this.touches.length - MOST);
    this.#update();
  }

  /** @param {number} time [s] that is shown */
  #goTo(time) {
    // What lies ahead has not happened any more: it may go otherwise.
    if (time < this.shown) this.touches = this.touches.filter((each) => each.time <= time + SAME);
    this.shown = time;
    this.#update();
  }

  #clear() {
    this.touches = [];
    this.#update();
  }

  #update() {
    const {start, stop} = this.#run(), begin = this.start ? start?.time : 0;
    const end = stop?.time ?? (this.stop ? this.shown : undefined);
    this.time.textContent = begin === undefined || end === undefined ? '–' : `${(end - begin).toFixed(4)} s`;
    this.time.classList.toggle('running', begin !== undefined && this.stop !== '' && !stop);
    this.details.textContent = [start && `started at ${start.time.toFixed(4)} s by ${start.other || 'a wall'}`,
      stop && `stopped at ${stop.time.toFixed(4)} s by ${stop.other || 'a wall'}`].filter(Boolean).join(', ');
    this.count.textContent = this.counted ? String(this.touches.filter(({name}) => name === this.counted).length) : '–';
  }

  /** @returns {{start?: Touched, stop?: Touched}} the last run from gate to gate of one body, else the first that goes on */
  #run() {
    const stopOf = (/** @type {Touched | undefined} */ start) => this.touches.find(({name, other, time}) =>
      name === this.stop && (!start || other === start.other && time > start.time + SAME));
    if (!this.start) return {stop: stopOf(undefined)};
    const runs = this.touches.filter(({name}) => name === this.start).map((start) => ({start, stop: stopOf(start)}));
    return runs.findLast(({stop}) => stop) ?? runs[0] ?? {};
  }
}
