// SPDX-License-Identifier: Apache-2.0
/**
 * The stopwatch that gates start and stop, and the counter of collisions: within the step, as the server tells
 * touches, also those before a gate was chosen; and a stopwatch by hand, in the time of the world, with laps.
 */

import {choiceField, createElement, inRow, showText, textButton} from '../dom.js';
import {fixed} from '../rounding.js';
import {t} from '../strings.js';

/** @import {Parts} from '../types.js' */
/** @import {Content} from '../panels/panel.js' */

/** @typedef {{name: string, other: string, time: number}} Touched a body that was followed, by another one */

const MOST = 10000; // touches that are kept
const SAME = 1e-9; // s
const MOST_LAPS = 8; // that are shown

export class Stopwatch {
  /** @param {Parts<'connection' | 'notes' | 'words'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.start = this.stop = this.counted = ''; // names of bodies
    /** @type {Touched[]} in the order of time */
    this.touches = [];
    this.shown = 0; // time [s]
    this.following = false;
    this.since = -1; // [s] from which on collisions are counted
    /** @type {?number} when the one by hand was started [s] */
    this.began = null;
    /** @type {?number} when it was stopped [s] */
    this.ended = null;
    /** @type {number[]} times of laps [s] */
    this.laps = [];
    this.byHand = createElement('output', {className: 'reading', 'aria-label': t('Stopwatch by hand')});
    this.lapList = createElement('p');
    this.time = createElement('output', {className: 'reading', 'aria-label': t('Stopwatch')});
    this.details = createElement('p');
    this.count = createElement('output', {className: 'reading', 'aria-label': t('Number of collisions')});
    parts.connection.on('touches', ({touches}) => this.#add(touches));
    parts.connection.on('frame', ({time}) => this.#goTo(time));
    parts.connection.on('open', () => this.#follow());
    parts.connection.on('line', ({since}) => {
      this.touches = this.touches.filter(({time}) => time < since);
      if (this.following) this.#follow();
    });
    parts.connection.on('world', () => {
      this.start = this.stop = this.counted = '';
      [this.began, this.ended, this.laps] = [null, null, []];
      this.#follow();
      this.touches = [];
      this.since = -1;
    });
  }

  /** @returns {Content} of the panel */
  content() {
    return {title: t('Measure'), live: () => this.#show(), rest: [
      createElement('p', {}, t('Ruler and protractor are among the tools. A gate lets other bodies through: tap a body and tick Gate.')),
      createElement('h3', {}, t('Stopwatch')),
      this.#chooser('start', t('Starts when touched'), t('at 0 s')),
      this.#chooser('stop', t('Stops when touched'), t('never')),
      this.time, this.details,
      createElement('h3', {}, t('By hand')),
      this.byHand, this.lapList,
      inRow(textButton(t('Start or stop (7)'), () => this.press()), textButton(t('Lap (6)'), () => this.lap())),
      createElement('h3', {}, t('Collisions')),
      this.#chooser('counted', t('Collisions of'), t('no body')),
      this.count, inRow(textButton(t('Count from here'), () => {
        this.since = this.shown;
      }))]};
  }

  /**
   * @param {'start' | 'stop' | 'counted'} role
   * @param {string} label
   * @param {string} none
   */
  #chooser(role, label, none) {
    return choiceField(label, this.parts.words.choices(none), this[role], (name) => {
      this[role] = name;
      this.#follow();
    });
  }

  #follow() {
    const names = [...new Set([this.start, this.stop, this.counted])].filter((name) => name);
    if (names.length || this.following) this.parts.connection.send('follow', {names});
    this.following = names.length > 0;
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
  }

  /** @param {number} time [s] that is shown */
  #goTo(time) {
    // What lies ahead has not happened any more: it may go otherwise.
    if (time < this.shown) {
      this.touches = this.touches.filter((each) => each.time <= time + SAME);
      this.since = Math.min(this.since, time);
    }
    this.shown = time;
  }

  /** Start the stopwatch by hand, stop it, or begin anew. */
  press() {
    if (this.began !== null && this.ended === null) this.ended = this.shown;
    else [this.began, this.ended, this.laps] = [this.shown, null, []];
    this.parts.notes.showMessage(t('Stopwatch {time}', {time: this.#handText()}));
  }

  /** Note a lap of the stopwatch by hand: of a swing it is the period. */
  lap() {
    if (this.began === null || this.ended !== null) return;
    this.laps.push(this.shown);
    this.parts.notes.showMessage(t('Lap {time}', {time: this.#lapTexts().at(-1) ?? ''}));
  }

  #lapTexts() {
    return this.laps.map((time, i) => `${fixed(time - (i ? this.laps[i - 1] : this.began ?? 0), 3)} s`);
  }

  /** @returns {string} the time of the stopwatch by hand */
  #handText() {
    return this.began === null ? '–' : `${fixed((this.ended ?? this.shown) - this.began, 3)} s`;
  }

  #show() {
    const {start, stop} = this.#run(), begin = this.start ? start?.time : 0;
    const end = stop?.time ?? (this.stop ? this.shown : undefined);
    showText(this.time, begin === undefined || end === undefined ? '–' : `${fixed(end - begin, 4)} s`);
    showText(this.byHand, this.#handText());
    showText(this.lapList, this.#lapTexts().slice(-MOST_LAPS).join(', '));
    this.time.classList.toggle('running', begin !== undefined && this.stop !== '' && !stop);
    const values = (/** @type {Touched} */ {time, other}) => ({time: fixed(time, 4), name: other ? this.parts.words.item(other) : t('a wall')});
    showText(this.details, [start && t('started at {time} s by {name}', values(start)),
      stop && t('stopped at {time} s by {name}', values(stop))].filter(Boolean).join(', '));
    const collisions = this.touches.filter(({name, time}) => name === this.counted && time > this.since).length;
    showText(this.count, this.counted ? String(collisions) : '–');
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
