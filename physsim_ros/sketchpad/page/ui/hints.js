// SPDX-License-Identifier: Apache-2.0
/**
 * Hints: one line of help, how the tool in hand is used, and for somebody new the way from a first body to a changed
 * past. What was done twice does not come again in this browser.
 */

import {elementOf} from '../dom.js';
import {t} from '../strings.js';

/** @import {Parts, WorldState} from '../types.js' */

/** Id, text, icon of the button that is pointed at, and when it is true. @type {[string, string, string, ((world: WorldState) => boolean)?][]} */
const STEPS = [
  ['draw', t('Draw a circle, a box, a line: it comes to life.'), ''],
  ['play', t('Time is paused: press Play.'), 'play', ({paused}) => paused],
  ['throw', t('A small circle over two bodies is an axle. Or take the hand and throw one.'), 'hand'],
  ['rewind', t('Nothing is lost: rewind, or drag the time line.'), 'rewind', ({timeline: {oldest, now}}) => oldest < now],
  ['change', t('This is the past. Draw or move something here, and the future changes.'), '', ({timeline: {newest, now}}) => now < newest],
  ['ghost', t('Dashed: what happened before. The ring on the time line returns there.'), 'play', ({timeline}) => Boolean(timeline.courses?.length)],
];
const STEP = 'physsim-hints', USED = 'physsim-tools'; // keys
const KNOWN = 2; // times that a tool was used after its hint, which is not shown any more
const TOOL_SHOWN = 5000, LAST_SHOWN = 12000; // ms: how a tool is used, the last step

export class Hints {
  /** @param {Parts<'connection' | 'notes' | 'pointers' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.line = elementOf('hint');
    this.step = Number(localStorage.getItem(STEP) ?? 0);
    /** @type {Record<string, number>} how often tools were used after their hints */
    this.used = JSON.parse(localStorage.getItem(USED) ?? '{}');
    this.tool = ''; // whose hint was shown last, until it is used
    this.timer = 0;
    this.shown = ''; // id of the step whose text is shown
    const {connection} = parts;
    connection.on('reading', ({built}) => built && this.completeStep('draw'));
    connection.on('answer', ({request, ok, topic, subject}) => {
      if (request && ok && topic === 'clicked_point' && subject) this.completeStep('draw');
    });
    // Only what this page does counts as a step.
    connection.on('sent', ({type, name, time}) => {
      if (type === 'speed' || name === 'play' && this.#isDone('draw')) this.completeStep('play');
      if (type === 'seek' && time < parts.world.frame.time || name === 'rewind') this.completeStep('rewind');
    });
    connection.on('timeline', ({courses = []}) => {
      if (courses.length && this.#isDone('rewind')) this.completeStep('change');
      if (this.shown !== 'tool' && this.#step()?.[0] !== this.shown) this.#showStep();
    });
    connection.on('scene', () => this.shown === 'tool' || this.#showStep());
    parts.pointers.on('end', ({tool}) => tool === parts.pointers.tool && this.#noteUse());
    this.#showStep();
  }

  /** @param {string} id of the step that was done; those before are known then too */
  completeStep(id) {
    if (this.#isDone(id)) return;
    this.step = indexOf(id) + 1;
    localStorage.setItem(STEP, String(this.step));
    this.#showStep();
  }

  /** @param {string} id of a step */
  #isDone(id) {
    return indexOf(id) < this.step;
  }

  /** @returns {typeof STEPS[0] | undefined} the next one that is true now */
  #step() {
    // A lesson has its own hints.
    if (this.parts.world.scene.lesson) return undefined;
    const step = STEPS[this.step], holds = !step?.[3] || step[3](this.parts.world);
    // In a world that plays, the step `play` is left out.
    return holds ? step : step[0] === 'play' ? STEPS[this.step + 1] : undefined;
  }

  /**
   * Tell how the tool in hand is used, until somebody has done so twice.
   * @param {string} id of the tool
   * @param {string} text
   */
  showTool(id, text) {
    this.tool = id;
    if ((this.used[id] ?? 0) >= KNOWN) return;
    this.parts.notes.hide();
    this.#show(text);
    this.shown = 'tool';
    this.timer = setTimeout(() => this.#showStep(), TOOL_SHOWN);
  }

  /** Note that the tool in hand was used. */
  #noteUse() {
    if (!this.tool) return;
    this.used[this.tool] = (this.used[this.tool] ?? 0) + 1;
    this.tool = '';
    localStorage.setItem(USED, JSON.stringify(this.used));
  }

  #showStep() {
    const [id, text, button] = this.#step() ?? ['', '', ''];
    this.#show(text);
    this.shown = id;
    for (const each of document.querySelectorAll('.next')) each.classList.remove('next');
    if (button) document.querySelector(`button[data-icon=${button}]`)?.classList.add('next');
    if (id === 'ghost') this.timer = setTimeout(() => this.completeStep('ghost'), LAST_SHOWN);
  }

  /** @param {string} text '' hides the line */
  #show(text) {
    clearTimeout(this.timer);
    if (text) this.line.textContent = text;
    this.line.classList.toggle('faded', !text);
  }
}

/** @param {string} id of a step */
function indexOf(id) {
  return STEPS.findIndex(([each]) => each === id);
}
