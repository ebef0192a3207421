// SPDX-License-Identifier: Apache-2.0
/** The people in this world: names, colours, cursors, raised hands; whether a teacher has frozen it. */

import {createElement, elementOf, iconButton, soon, textButton} from '../dom.js';
import {NAME, ownName, personWord} from '../people.js';
import {t} from '../strings.js';

/** @import {Parts, Point, SceneView} from '../types.js' */

const PERIOD = 100; // ms between messages of the cursor
const SHOWN = 10000; // ms: a cursor that rests
export const TITLE = t('People');
const GOLDEN = 137.5; // degrees from one hue to the next: the golden angle, so that the first ones are far from each other
export const LOOKS_IN = 'physsim-class'; // whose world it is that a teacher of a class looks into, in this tab

export class Classroom {
  /** @param {Parts<'camera' | 'connection' | 'dialog' | 'lessons' | 'notes' | 'people' | 'selection' | 'view'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.raised = false; // the hand of this page
    /** @type {Map<number, {at: Point, until: number}>} */
    this.cursors = new Map();
    /** @type {?(() => void)} takes the note away that says that the world is frozen; null where there is none */
    this.thaw = null;
    const {connection, view} = parts;
    // The page of a class has asked for it.
    const given = new URLSearchParams(location.hash.slice(1)), own = given.get('name'), whose = given.get('class');
    if (own !== null) localStorage.setItem(NAME, own);
    if (whose !== null) sessionStorage.setItem(LOOKS_IN, whose);
    if ((own ?? whose) !== null) history.replaceState(null, '', location.pathname + location.search);
    connection.on('welcome', () => {
      this.#showWhose();
      const name = ownName();
      if (name && !parts.people.viewOnly) connection.send('person', {name});
      if (this.raised) this.#raise(true);
    });
    connection.on('class', () => this.#follow());
    connection.on('lower_hand', () => this.#raise(false));
    connection.on('said', ({name: who, text}) => {
      const take = parts.notes.dock([`${personWord(who)}: ${text}`, textButton('OK', () => take())], 0);
    });
    connection.on('cursors', ({cursors}) => {
      for (const [page, x, y] of cursors) this.cursors.set(page, {at: [x, y], until: performance.now() + SHOWN});
    });
    /** @type {Point} of the cursor [px] */
    let cursor = [0, 0];
    const sendSoon = soon(() => connection.send('here', {point: parts.camera.toWorld(...cursor)}), PERIOD);
    view.canvas.addEventListener('pointermove', ({clientX, clientY}) => {
      cursor = [clientX, clientY];
      if (parts.people.isShared && !parts.people.viewOnly) sendSoon();
    });
    view.overlays.push((each) => this.#draw(each));
    this.button = iconButton(TITLE, 'people', () => this.#showPeople(), t('People in this world'));
    this.button.hidden = true;
    this.hand = iconButton(t('Raise your hand'), 'raise', () => this.#raise(!this.raised), t('Raise your hand, or lower it: your teacher sees it'));
    this.hand.hidden = true;
    elementOf('looks').append(this.button, this.hand);
  }

  /** Tell a teacher of a class whose world this is. */
  #showWhose() {
    const whose = this.parts.people.teacher ? sessionStorage.getItem(LOOKS_IN) : null;
    if (whose === null) return;
    document.title = whose ? t('World of {name}', {name: whose}) : t('Free world');
    const shown = document.querySelector('.whose') ?? elementOf('files').insertAdjacentElement('afterbegin', createElement('strong', {className: 'whose'}));
    if (shown) shown.textContent = document.title;
  }

  #follow() {
    const {parts, parts: {people: {isShared, teacher, viewOnly, state}}} = this, pages = new Set(state.people.map(({page}) => page));
    for (const page of this.cursors.keys()) if (!pages.has(page)) this.cursors.delete(page);
    this.button.hidden = !isShared && !teacher;
    this.hand.hidden = teacher || viewOnly || !state.watched && state.people.every(({role}) => role !== 'teach');
    const frozen = state.frozen && !teacher && !viewOnly;
    document.body.classList.toggle('frozen', frozen);
    if (!frozen) this.thaw?.();
    this.thaw = frozen ? this.thaw ?? parts.notes.dock([t('Your teacher has frozen this world.')], 0) : null;
    parts.dialog.renew(TITLE, () => document.activeElement instanceof HTMLInputElement || this.#showPeople());
  }

  /** @param {boolean} raised */
  #raise(raised) {
    this.raised = raised;
    this.hand.setAttribute('aria-pressed', String(raised));
    this.parts.connection.send('raise_hand', {raised});
  }

  #showPeople() {
    this.parts.notes.load(import('./people_dialog.js'), ({showPeople}) => showPeople(this.parts));
  }

  /** @param {SceneView} view */
  #draw(view) {
    const {ctx} = view, {people} = this.parts, now = performance.now();
    for (const [page, {at, until}] of this.cursors) {
      const name = people.nameOf(page), person = people.state.people.find((each) => each.page === page);
      if (now > until || !name || !person) continue;
      const [x, y] = this.parts.camera.toPage(...at);
      ctx.fillStyle = colorOf(person.color);
      ctx.beginPath();
      for (const [dx, dy] of [[0, 0], [0, 15], [4, 11], [11, 11]]) ctx.lineTo(x + dx, y + dy);
      ctx.fill();
      ctx.font = '13px system-ui, sans-serif';
      ctx.beginPath();
      const shown = personWord(name);
      ctx.roundRect(x + 10, y + 12, ctx.measureText(shown).width + 12, 20, 6);
      ctx.fill();
      ctx.textAlign = 'left';
      ctx.fillStyle = '#fff';
      ctx.fillText(shown, x + 16, y + 26);
    }
  }
}

/**
 * @param {number} number of the colour of a person
 * @param {number} lightness [%]
 * @returns {string} the same hue on all pages; white is to be read on it, unless it is lighter
 */
export function colorOf(number, lightness = 34) {
  return `hsl(${210 + number * GOLDEN} 65% ${lightness}%)`;
}
