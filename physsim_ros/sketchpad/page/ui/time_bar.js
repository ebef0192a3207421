// SPDX-License-Identifier: Apache-2.0
/** Time: the buttons, the slider over the history, with the courses that were left, the clock. */

import {createElement, elementOf, iconButton} from '../dom.js';
import {fixed} from '../rounding.js';
import {localized, server, t} from '../strings.js';

/** @import {Parts} from '../types.js' */

/** Name, service, key, and what else it says. @type {[string, string, string, string?][]} */
export const TIME = [
  [t('Fast rewind'), 'fast_rewind', 'Shift+J'], [t('Rewind'), 'rewind', 'J'], [t('Pause'), 'pause', 'K'],
  [t('Play'), 'play', 'L'], [t('Fast forward'), 'fast_forward', 'Shift+L'],
  [t('Step back'), 'step_back', ',', t('one frame back')], [t('Step'), 'step', '.', t('one frame forward')],
];
/** @type {typeof TIME} */
export const EDIT = [[t('Undo'), 'undo', 'Ctrl+Z'], [t('Redo'), 'redo', 'Ctrl+Y'], [t('Reset'), 'reset', '0', t('back to the beginning')]];
const SPEEDS = [1, 0.5, 0.25, 0.1];
const BESIDE = 24; // px: least distance of rings
const WATCHED = 1500; // ms over which the pace is measured
const EXPLAINED = 3000; // ms for which the world is slow before that is explained
const SLOW = 0.9; // share of the speed asked for below which the pace is told

export class TimeBar {
  /** @param {Parts<'connection' | 'notes' | 'people' | 'pointers' | 'view' | 'words' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.slider = elementOf('slider', HTMLInputElement);
    this.clock = elementOf('clock');
    this.marks = elementOf('marks');
    /** @type {Map<string, HTMLElement>} of courses that were left, by id and name */
    this.rings = new Map();
    this.speed = elementOf('speed', HTMLButtonElement);
    /** @type {Map<string, HTMLButtonElement>} */
    this.buttons = new Map();
    for (const [id, group] of /** @type {const} */ ([['time', TIME], ['edit', EDIT]])) {
      for (const [name, service, key, more = ''] of group) {
        const button = iconButton(name, service, () => this.callService(service), `${name}${more && ': '}${more} (${key})`);
        this.buttons.set(service, button);
        elementOf(id).append(button);
      }
    }
    this.shown = ''; // speed
    /** @type {[number, number, number][]} wall time [ms], simulation time [s] and speed of the last frames */
    this.paces = [];
    this.slowSince = 0; // [ms]; 0 where it is not
    this.explained = false; // whether that was told in this world
    this.rate = 1; // of playing, as this page has chosen it
    this.busy = false; // a seek is on its way
    this.asked = 0; // speeds that are on their way
    /** @type {?number} */
    this.wanted = null;
    this.slider.addEventListener('input', () => this.#slide());
    this.speed.addEventListener('click', () => this.#changeSpeed());
    for (const type of ['timeline', 'class']) parts.connection.on(type, () => this.#showTimeline());
    parts.connection.on('frame', () => this.#measurePace());
    parts.connection.on('world', () => { this.explained = false; });
    parts.connection.on('open', () => { [this.busy, this.wanted, this.asked] = [false, null, 0]; });
    parts.view.overlays.push(() => this.#showTime());
    // A world that runs back would go back beyond a change at once.
    parts.pointers.on('begin', () => parts.world.frame.speed < 0 && this.callService('pause'));
  }

  /** @param {string} service */
  callService(service) {
    if (service === 'step_back') return this.#stepBack();
    if (service === 'step' && !this.parts.world.paused) this.callService('pause');
    if (service === 'play' && this.rate !== 1) this.parts.connection.send('speed', {speed: this.rate});
    // Where several people draw, each undoes what is its own.
    else if (service === 'undo' && this.parts.people.isShared) this.parts.connection.send('take_back');
    else this.parts.connection.send('service', {name: service});
  }

  /** Pause, and go to the frame before the one that is shown. */
  #stepBack() {
    const {frame, rate, timeline, paused} = this.parts.world;
    if (!paused) this.callService('pause');
    this.wanted = Math.max(Math.round((this.wanted ?? frame.time) * rate - 1) / rate, timeline.oldest);
    this.#seek();
  }

  toggle() {
    this.callService(this.parts.world.paused ? 'play' : 'pause');
  }

  #slide() {
    // In a paused world too: a request to play may be on its way.
    if (!this.busy) this.callService('pause');
    const {rate} = this.parts.world, {value, min, max} = this.slider;
    // The server keeps whole frames, which are shown at once.
    this.wanted = Math.min(Math.max(Math.round(Number(value) * rate) / rate, Number(min)), Number(max));
    this.#seek();
  }

  async #seek() {
    if (this.busy || this.wanted === null) return;
    this.busy = true;
    const time = this.wanted;
    this.wanted = null;
    await this.parts.connection.ask('seek', {time});
    this.busy = false;
    this.#seek();
  }

  async #changeSpeed() {
    // While a speed is asked for, that of the last frame is another one.
    const {speed} = this.parts.world.frame, now = speed > 0 && !this.asked ? speed : this.rate;
    this.rate = SPEEDS[(SPEEDS.indexOf(now) + 1) % SPEEDS.length];
    if (!(speed > 0)) {
      this.#showSpeed(this.rate);
      return;
    }
    this.asked++;
    await this.parts.connection.ask('speed', {speed: this.rate});
    this.asked--;
  }

  #measurePace() {
    const {time, speed} = this.parts.world.frame, now = performance.now();
    const last = this.paces.at(-1);
    if (last && (last[2] !== speed || time < last[1] || now - last[0] > WATCHED)) this.paces = [];
    this.paces.push([now, time, speed]);
    while (this.paces.length > 2 && now - this.paces[1][0] > WATCHED) this.paces.shift();
  }

  /** @returns {number} seconds of simulation a second, where that is known and less than asked for; else 0 */
  get #slowPace() {
    const [first] = this.paces, last = this.paces[this.paces.length - 1];
    if (!(last?.[2] > 0) || last[0] - first[0] < WATCHED / 2) return 0;
    const pace = (last[1] - first[1]) / (last[0] - first[0]) * 1000;
    return pace < SLOW * last[2] ? pace : 0;
  }

  /** @param {number} speed */
  #showSpeed(speed) {
    const pace = this.#slowPace, text = `${localized(String(Number((pace || speed).toFixed(2))))}×`;
    const reason = pace ? t('Slower than {speed}×: the machine of the world has not the time', {speed}) : '';
    this.#explain(reason);
    if (text === this.shown) return;
    this.shown = text;
    this.speed.textContent = text;
    this.speed.classList.toggle('slow', pace > 0);
    this.speed.setAttribute('aria-label', pace ? t('Speed {pace}, slower than {speed}×', {pace: text, speed}) : t('Speed {pace}', {pace: text}));
    this.speed.title = reason || t('Speed of playing');
  }

  /**
   * Tell why the speed is red, once for a world that stays slow.
   * @param {string} reason '' where it is not slow
   */
  #explain(reason) {
    const now = performance.now();
    this.slowSince = reason ? this.slowSince || now : 0;
    if (!reason || this.explained || now - this.slowSince < EXPLAINED) return;
    this.explained = true;
    this.parts.notes.dock([reason]);
  }

  #showTime() {
    const {frame, timeline} = this.parts.world;
    this.clock.textContent = `${fixed(frame.time, 2)} s`;
    if (!this.slider.matches(':active') && this.wanted === null && !this.busy) {
      this.slider.max = String(Math.max(timeline.newest, frame.time));
      this.slider.min = String(Math.min(timeline.oldest, frame.time));
      this.slider.value = String(frame.time);
    }
    const {speed} = frame;
    const on = speed === 0 ? 'pause' : speed > 1 ? 'fast_forward' : speed > 0 ? 'play' :
      speed < -1 ? 'fast_rewind' : 'rewind';
    this.#showSpeed(speed || this.rate);
    for (const [, service] of TIME.slice(0, 5)) {
      this.buttons.get(service)?.setAttribute('aria-pressed', String(service === on));
    }
  }

  /**
   * @param {string} service
   * @param {string} title '' where there is nothing to do
   * @param {string} otherwise what is told then
   */
  #showEdit(service, title, otherwise) {
    const button = this.buttons.get(service);
    button?.classList.toggle('idle', !title);
    if (button) button.title = title || otherwise;
  }

  #showTimeline() {
    const {undo_text: undo, redo_text: redo, oldest, newest, state, courses = []} = this.parts.world.timeline;
    // What is undone is one's own, and that is not known here.
    const {words, people} = this.parts, undone = people.isShared ? t('Undo what you did last') : words.say(undo);
    this.#showEdit('undo', undone, t('Nothing to undo'));
    this.#showEdit('redo', words.say(redo), t('Nothing to redo'));
    this.clock.classList.toggle('past', state === 'in the past');
    this.clock.title = server(state);
    const before = this.rings;
    let place = '';
    this.rings = new Map([...courses].sort((one, other) => one.from - other.from).map(({id, from}) => {
      const name = t('Go back to how it went before, from {time}\u00a0s', {time: fixed(from, 1)}), key = `${id} ${name}`;
      // While time runs it is the same element: one that was made anew could not be pressed.
      const ring = before.get(key) ?? this.marks.appendChild(createElement('button', {type: 'button', 'aria-label': name, title: name,
        onclick: () => this.parts.connection.send('course', {course: id})}));
      const at = `${100 * (from - oldest) / (newest - oldest || 1)}%`;
      // No ring covers another, where courses part at one moment.
      place = place ? `max(${at}, ${place} + ${BESIDE}px)` : at;
      ring.style.left = place;
      return [key, ring];
    }));
    for (const [key, ring] of before) if (!this.rings.has(key)) ring.remove();
  }
}
