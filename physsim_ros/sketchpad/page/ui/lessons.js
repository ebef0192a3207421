// SPDX-License-Identifier: Apache-2.0
/**
 * Lessons: their list, the card of the one that is open, and the check of a measured figure.
 *
 * A lesson belongs to its world (`scene.lesson`), so that all pages of the world have its card, each in its own language:
 * the table of strings has the texts of shipped lessons.
 */

import {createElement, elementOf, fieldForm, fold, foldButton, icon, inRow, textButton} from '../dom.js';
import {numberOf} from '../rounding.js';
import {isRoomy} from '../view/room.js';
import {t} from '../strings.js';

/** @import {Lesson, Parts} from '../types.js' */

const SOLVED = 'physsim-lessons'; // titles of the lessons that were solved in this browser, as JSON

export class Lessons {
  /** @param {Parts<'connection' | 'files' | 'people' | 'room' | 'selection' | 'time' | 'words' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    /** @type {{name: string, number: number, title: string, question: string}[]} in their order */
    this.list = [];
    this.card = elementOf('lesson');
    this.more = foldButton(this.card, t('All of the lesson'), (folded) => this.#fold(folded));
    this.settled = false; // the question was read: time has run, or a body was tapped
    /** @type {string | undefined} */
    this.shown = ''; // title of the lesson of the card
    /** @type {Set<string>} */
    this.solved = new Set(JSON.parse(localStorage.getItem(SOLVED) ?? '[]'));
    parts.connection.on('scene', ({lesson}) => lesson?.title === this.shown || this.#show(lesson));
    parts.connection.on('world', () => this.#show(parts.world.scene.lesson));
    parts.connection.on('worlds', ({lessons}) => {
      const first = !this.list.length;
      this.list = lessons;
      // The card names the next lesson.
      if (first) this.#show(parts.world.scene.lesson);
    });
    // When the panel is there.
    parts.selection.on('change', () => queueMicrotask(() => parts.selection.kind && this.settle()));
    this.began = Infinity; // earliest time that was shown of the lesson [s]
    parts.connection.on('frame', () => {
      const {time} = parts.world.frame;
      if (time > this.began) this.settle();
      this.began = Math.min(this.began, time);
    });
  }

  /** @returns {Node[]} the list, with a heading; nothing where there are no lessons */
  section() {
    if (!this.list.length) return [];
    return [createElement('h3', {}, t('Lessons')),
      createElement('ol', {className: 'cards lessons'}, ...this.list.map(({name, number, title, question}) =>
        createElement('li', {}, createElement('button', {type: 'button', className: 'card', onclick: () => this.open({name, title})},
          // A file that is no lesson has no number, and no picture.
          ...number ? [createElement('img', {src: `/gallery/${encodeURIComponent(name)}.svg`, alt: '', loading: 'lazy'})] : [],
          createElement('strong', {}, number ? `${number}. ${t(title)} ` : title, ...this.solved.has(title) ? [solvedMark()] : []),
          createElement('small', {}, questionParts(t(question))[1])))))];
  }

  /** @param {{name: string, title: string}} lesson */
  open({name, title}) {
    const {connection, files} = this.parts;
    // Its card is seen.
    return files.follow(connection.openLesson(name), t(title), {unseen: true});
  }

  get isFolded() {
    return this.card.classList.contains('folded');
  }

  /** Fold the card to its question and answer, so that the experiment has the page: once, as it can be unfolded. */
  settle() {
    // A page without room shows the card or the panel: what is opened last.
    if (!this.isFolded && (!this.settled || !isRoomy() && this.parts.selection.kind)) this.#fold(true);
  }

  /** @param {boolean} folded */
  #fold(folded) {
    const {parts, card} = this;
    this.settled = true;
    fold(card, this.more, folded);
    if (!folded && !isRoomy() && parts.selection.kind) parts.selection.select([]);
    parts.room.fit();
  }

  /** @param {?Lesson | undefined} lesson whose card is made anew */
  #show(lesson) {
    const {card, parts} = this;
    this.shown = lesson?.title;
    card.hidden = !lesson;
    if (lesson) {
      const [given, asked] = questionParts(t(lesson.question));
      card.replaceChildren(createElement('header', {}, createElement('h2', {}, `${lesson.number}. ${t(lesson.title)}`), this.more),
        createElement('p', {className: 'question'}, createElement('span', {className: 'given'}, given, ' '), asked),
        ...parts.people.viewOnly ? [] : this.#work(lesson));
    }
    this.#fold(false);
    this.settled = !lesson;
    this.began = Infinity;
  }

  /**
   * Report an answer to the world, which keeps it for the teacher; where it cannot, that is told.
   * @param {{lesson: string, answer: string, right: boolean}} answer
   * @param {HTMLElement} result beside which that is told
   */
  async #report(answer, result) {
    const {ok, code, text} = await this.parts.connection.ask('answered', answer);
    const reason = this.parts.words.sayAnswer({ok, code, text});
    if (!ok) result.append(createElement('span', {className: 'danger'}, ` ${t('Your answer was not saved: {reason}', {reason})}`));
  }

  /**
   * @param {Lesson} lesson
   * @returns {Node[]} what is measured, a hint, and buttons
   */
  #work({title, hint, measure, unit, figure, within, answer}) {
    const result = createElement('p', {'aria-live': 'polite'}), shown = unit === '1' ? '' : unit;
    const input = createElement('input', {inputMode: 'decimal', required: true, autocomplete: 'off', 'aria-label': t('Your answer {unit}', {unit: shown})});
    const solution = folded(t('Answer'), t(answer));
    solution.hidden = true;
    const form = fieldForm(input, t('Check'), (typed) => {
      const value = numberOf(typed), right = Math.abs(value - figure) <= within;
      result.className = right ? 'right' : '';
      result.textContent = right ? t('Right!') : Number.isNaN(value) ? t('That is not a number.') : t('Not yet. Measure again, or look at the hint.');
      if (typed) this.#report({lesson: title, answer: typed, right}, result);
      // Who has tried may look.
      solution.hidden = false;
      solution.open = right;
      if (!right) return;
      this.#fold(false);
      // On a small page the card is scrolled.
      solution.scrollIntoView({block: 'nearest'});
      this.solved.add(title);
      localStorage.setItem(SOLVED, JSON.stringify([...this.solved]));
    }, shown);
    const place = this.list.findIndex((each) => each.title === title), next = place < 0 ? undefined : this.list[place + 1];
    const buttons = [textButton(t('Start again'), () => this.parts.time.callService('reset'))];
    if (next) buttons.push(textButton(t('Next lesson'), () => this.open(next)));
    return [
      createElement('p', {className: 'rest'}, createElement('strong', {}, t('To measure:')), ` ${t(measure)}`),
      createElement('div', {className: 'answer'}, form, result),
      createElement('div', {className: 'rest'}, folded(t('Hint'), t(hint)), solution, inRow(...buttons))];
  }
}

/**
 * @param {string} text of a question
 * @returns {string[]} what is given, and what is asked: from its first sentence with a question mark on
 */
function questionParts(text) {
  const sentences = text.split(/(?<=[.!?]) /), asked = Math.max(sentences.findIndex((each) => each.endsWith('?')), 0);
  return [sentences.slice(0, asked).join(' '), sentences.slice(asked).join(' ')];
}

/**
 * @param {string} title
 * @param {string} text that is shown when the title is pressed
 */
function folded(title, text) {
  return createElement('details', {}, createElement('summary', {}, title), createElement('p', {}, text));
}

function solvedMark() {
  return createElement('span', {role: 'img', 'aria-label': t('solved')}, icon('solved'));
}
