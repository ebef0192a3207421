// SPDX-License-Identifier: Apache-2.0
/** The dialog of the people in this world: names; and what a teacher may do: freeze, lock, clear, show results and the address. */

import {colorOf, LOOKS_IN, TITLE} from './classroom.js';
import {createElement, fieldForm, inRow, textButton} from '../dom.js';
import {NAME, ownName, personWord, TEACHER} from '../people.js';
import {showResults} from './results.js';
import {t} from '../strings.js';

/** @import {Classmate, Parts} from '../types.js' */

/** @typedef {Parts<'connection' | 'dialog' | 'lessons' | 'people' | 'selection'>} Needed */

const LONGEST = 24; // characters

/** @param {Needed} parts */
export function showPeople(parts) {
  const {connection, dialog, people: {state: {people}, teacher, viewOnly}} = parts;
  const input = createElement('input', {value: ownName(), placeholder: t('Your name'), required: true,
    maxLength: LONGEST, autocomplete: 'nickname', 'aria-label': t('Your name')});
  const form = fieldForm(input, t('Use this name'), (name) => {
    localStorage.setItem(NAME, name);
    connection.send('person', {name});
    dialog.close();
  });
  dialog.show(TITLE, ...viewOnly ? [] : [form],
    createElement('ul', {className: 'people'}, ...people.map((person) => itemOf(parts, person))), ...teacher ? powers(parts) : []);
}

/**
 * @param {Needed} parts
 * @param {Classmate} person
 * @returns {HTMLElement} who it is, and for a teacher the last answer, and what can be done
 */
function itemOf({connection, people: {page: here, teacher}}, {page, name, color, role, answered, raised}) {
  const shown = personWord(name), you = page === here ? ` (${t('you')})` : '', dot = createElement('i', {'aria-hidden': 'true'});
  const teaches = role === 'teach' && name !== TEACHER ? `, ${t('teacher')}` : '';
  dot.style.background = colorOf(color);
  return createElement('li', {}, dot, `${shown}${you}${teaches}`,
    ...raised ? [createElement('strong', {}, t('hand raised')),
      ...teacher ? [textButton(t('Lower the hand'), () => connection.send('lower_hand', {page}))] : []] : [],
    ...teacher && answered ? [createElement('span', {}, `${answered.answer} ${answered.right ? '✓' : '✗'}`)] : [],
    ...teacher ? [textButton(t('Delete what {name} drew', {name: shown}), () => connection.send('clear_of', {person: name}), 'danger')] : []);
}

/**
 * @param {Needed} parts
 * @returns {Node[]} what a teacher may do
 */
function powers({connection, dialog, lessons, selection, people: {state: {frozen, locked}}}) {
  const chosen = [...selection.names], lockThem = (/** @type {string[]} */ names) => () => connection.send('lock', {names});
  const freeze = textButton(frozen ? t('Let them draw again') : t('Freeze all pupils'), () => connection.send('freeze', {frozen: !frozen}));
  const lock = chosen.length ?
    textButton(t('Lock what is selected ({count})', {count: chosen.length}), lockThem([...new Set([...locked, ...chosen])])) :
    textButton(t('Lock all bodies'), lockThem(['*']));
  return [createElement('h3', {}, t('Teacher')), sayForm((text) => connection.send('say', {text})),
    inRow(freeze, lock, ...locked.length ? [textButton(t('Unlock all'), lockThem([]))] : []),
    ...locked.length ? [createElement('p', {}, t('Locked: {names}', {names: locked.join(', ')}))] : [],
    inRow(textButton(t('Results'), () => showResults(dialog, lessons.list, () => connection.send('forget_results')))),
    // Pupils of a class come by its own page.
    ...sessionStorage.getItem(LOOKS_IN) !== null ? [] : [createElement('h3', {}, t('Pupils come here')),
      createElement('img', {src: '/qr.svg', alt: t('QR code of the address of pupils'), className: 'code'})]];
}

/**
 * @param {(text: string) => void} say
 * @param {string} label to whom
 */
export function sayForm(say, label = t('Message to all')) {
  const input = createElement('input', {required: true, maxLength: 200, autocomplete: 'off', placeholder: label, 'aria-label': label});
  return fieldForm(input, t('Send'), (text) => {
    say(text);
    input.value = '';
  });
}
