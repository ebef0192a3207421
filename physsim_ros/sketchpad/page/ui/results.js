// SPDX-License-Identifier: Apache-2.0
/** The results of lessons, as the server keeps them: a table of people by lessons, and the same as a file. */

import {choice, createElement, inRow, textButton} from '../dom.js';
import {downloadTable} from '../csv.js';
import {digits, numberOf, roundUp} from '../rounding.js';
import {language, localized, t} from '../strings.js';
import {personWord} from '../people.js';

/** @import {Result} from '../types.js' */
/** @import {Dialog} from './dialog.js' */

/** @typedef {{number: number, title: string}} Listed lesson */

const BINS = 8, FENCE = 1.5; // of the histogram; quartiles apart

/**
 * @param {Dialog} dialog
 * @param {Listed[]} lessons in their order
 * @param {() => void} forget all results
 */
export async function showResults(dialog, lessons, forget) {
  const title = t('Results'), {results} = await fetch('/results').then((response) => response.json(), () => ({results: null}));
  if (!results) {
    dialog.show(title, createElement('p', {}, t('Not done: the server is not reachable')));
    return;
  }
  const table = new ResultTable(results, lessons);
  const remove = () => {
    if (!confirm(t('Forget all results?'))) return;
    forget();
    dialog.close();
  };
  dialog.show(title, ...results.length ? [createElement('div', {className: 'results'}, table.element()), ...table.histograms(),
    inRow(textButton(t('Save table (CSV)'), () => downloadTable('results', table.rows())),
      textButton(t('Forget all results'), remove, 'danger'))] :
    [createElement('p', {}, t('Nobody has answered a lesson yet.'))]);
}

class ResultTable {
  /**
   * @param {Result[]} results
   * @param {Listed[]} lessons
   */
  constructor(results, lessons) {
    /** @type {Map<string, Map<string, Result>>} by person and lesson */
    this.people = new Map();
    for (const result of results) {
      if (!this.people.has(result.person)) this.people.set(result.person, new Map());
      const before = this.people.get(result.person)?.get(result.lesson);
      // Of a person who has been in several worlds.
      if (!before?.right) this.people.get(result.person)?.set(result.lesson, result);
    }
    this.names = [...this.people.keys()].sort((one, other) => one.localeCompare(other, language));
    const place = (/** @type {string} */ title) => {
      const at = lessons.findIndex((each) => each.title === title);
      return at < 0 ? lessons.length : at;
    };
    this.titles = [...new Set(results.map(({lesson}) => lesson))].sort((one, other) => place(one) - place(other));
    /** @type {(title: string) => string} */
    this.heading = (title) => {
      const lesson = lessons.find((each) => each.title === title);
      return lesson ? `${lesson.number}. ${t(title)}` : title;
    };
  }

  /** @returns {HTMLElement} */
  element() {
    const {names, titles, people} = this;
    const head = createElement('tr', {}, createElement('th', {}, t('Name')), ...titles.map((title) => createElement('th', {scope: 'col'}, this.heading(title))));
    const rows = names.map((name) => createElement('tr', {}, createElement('th', {scope: 'row'}, personWord(name)),
      ...titles.map((title) => cellOf(people.get(name)?.get(title)))));
    const right = createElement('tr', {}, createElement('th', {scope: 'row'}, t('right')), ...titles.map((title) => {
      const all = names.map((name) => people.get(name)?.get(title)).filter((each) => each !== undefined);
      return createElement('td', {}, t('{count} of {all}', {count: all.filter((each) => each.right).length, all: all.length}));
    }));
    return createElement('table', {}, createElement('thead', {}, head), createElement('tbody', {}, ...rows), createElement('tfoot', {}, right));
  }

  /** @returns {HTMLElement[]} how often which figure was answered, of the lesson that is chosen */
  histograms() {
    const bars = createElement('ul', {className: 'histogram'});
    const show = (/** @type {string} */ title) => bars.replaceChildren(...histogramOf([...this.people.values()].flatMap((lessons) => lessons.get(title) ?? [])));
    show(this.titles[0]);
    return [inRow(choice(t('Answers to'), this.titles.map((title) => [title, this.heading(title)]), this.titles[0], show)), bars];
  }

  /** @returns {string[][]} of a file, with the columns of each lesson beside each other */
  rows() {
    const {names, titles, people} = this;
    const head = titles.flatMap((title) => [t('answer'), t('right'), t('tries'), t('time')].map((column) => `${this.heading(title)}: ${column}`));
    const rows = names.map((name) => [personWord(name), ...titles.flatMap((title) => {
      const result = people.get(name)?.get(title);
      return result ? [answerText(result.answer), result.right ? '1' : '0', String(result.tries), dateOf(result)] : ['', '', '', ''];
    })]);
    return [[t('Name'), ...head], ...rows];
  }
}

/**
 * @param {Result[]} results of a lesson
 * @returns {HTMLElement[]} a bar of each range of figures; what lies far out (Tukey's fences) counts to the last one of its side
 */
function histogramOf(results) {
  const answers = results.map(({answer, right}) => ({figure: numberOf(answer), right})).filter(({figure}) => Number.isFinite(figure));
  const sorted = answers.map(({figure}) => figure).sort((a, b) => a - b), quartile = (/** @type {number} */ share) => sorted[Math.floor(share * (sorted.length - 1))];
  if (!sorted.length) return [];
  const [lower, upper] = [quartile(0.25), quartile(0.75)], fence = FENCE * (upper - lower || Math.abs(upper) || 1);
  const least = Math.max(sorted[0], lower - fence), most = Math.min(sorted[sorted.length - 1], upper + fence);
  const step = roundUp((most - least) / BINS || 1);
  // 9.7 / 0.1 is 96.99999999999999, and counts from 9.7.
  const binOf = (/** @type {number} */ figure) => Math.floor(Number((figure / step).toPrecision(12)));
  const first = binOf(least), last = binOf(most);
  return Array.from({length: last - first + 1}, (_, i) => {
    const there = answers.filter(({figure}) => Math.min(Math.max(binOf(figure), first), last) === first + i);
    const bars = [true, false].map((isRight) => {
      const bar = createElement('i', {className: isRight ? 'right' : ''});
      bar.style.width = `${100 * there.filter(({right}) => right === isRight).length / answers.length}%`;
      return bar;
    });
    const [from, to] = [first + i, first + i + 1].map((bin) => digits(bin * step, 4));
    const range = there.some(({figure}) => binOf(figure) > last) ? `≥ ${from}` : there.some(({figure}) => binOf(figure) < first) ? `< ${to}` : `${from} … ${to}`;
    return createElement('li', {}, range, createElement('span', {}, ...bars), String(there.length || ''));
  });
}

/**
 * @param {string} text that somebody has typed
 * @returns {string} the number as the reader of this page writes it; the text where it is none
 */
export function answerText(text) {
  return Number.isNaN(numberOf(text)) ? text : localized(text.trim().replace(',', '.'));
}

/** @param {Result | undefined} result */
function cellOf(result) {
  if (!result) return createElement('td', {}, '');
  const {answer, right, tries} = result;
  return createElement('td', {className: right ? 'right' : '', title: t('{date}, tries: {count}', {date: dateOf(result), count: tries})},
    `${answerText(answer)} ${right ? '✓' : '✗'}${tries > 1 ? ` (${tries})` : ''}`);
}

/** @param {Result} result */
function dateOf({at}) {
  return new Date(at * 1000).toLocaleString(language, {dateStyle: 'short', timeStyle: 'short'});
}
