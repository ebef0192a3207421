// SPDX-License-Identifier: Apache-2.0
/** Short forms to make and find elements of the page. */

import {digits, numberOf} from './rounding.js';
import {chooseLanguage, language, LANGUAGES, localized, t} from './strings.js';

/**
 * @template {keyof HTMLElementTagNameMap} T
 * @param {T} tag
 * @param {Record<string, any>} properties of the element; aria-… and other names with a dash are attributes
 * @param {(Node | string)[]} children
 * @returns {HTMLElementTagNameMap[T]}
 */
export function createElement(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes('-')) element.setAttribute(name, String(value));
    else Object.assign(element, {[name]: value});
  }
  element.append(...children);
  return element;
}

/** @param {string} id of a symbol in icons.svg */
export function icon(id) {
  return createGraphic('svg', {'aria-hidden': 'true'}, createGraphic('use', {href: `/page/icons.svg#${id}`}));
}

/**
 * @param {string} tag of SVG
 * @param {Record<string, string>} attributes
 * @param {Node[]} children
 */
export function createGraphic(tag, attributes, ...children) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/**
 * @param {string} name that it is asked for by
 * @param {string} id of its icon
 * @param {() => void} onclick
 * @param {string} title
 */
export function iconButton(name, id, onclick, title = name) {
  return createElement('button', {type: 'button', 'aria-label': name, 'data-icon': id, title, onclick}, icon(id),
    createElement('span', {className: 'word', 'aria-hidden': true, textContent: name}));
}

/**
 * A button that folds a section of the page to its first lines, and unfolds it.
 * @param {HTMLElement} section
 * @param {string} label
 * @param {(folded: boolean) => void} change called when it is pressed
 * @param {string} textContent beside its arrow
 */
export function foldButton(section, label, change, textContent = '') {
  const button = createElement('button', {type: 'button', className: 'fold', 'aria-label': label, title: textContent ? '' : label, textContent, onclick: () => {
    fold(section, button, !section.classList.contains('folded'));
    change(section.classList.contains('folded'));
  }});
  return button;
}

/**
 * @param {HTMLElement} section
 * @param {HTMLElement} button of `foldButton`
 * @param {boolean} folded
 */
export function fold(section, button, folded) {
  section.classList.toggle('folded', folded);
  button.setAttribute('aria-expanded', String(!folded));
}

/**
 * @param {string} label
 * @param {() => void} onclick
 * @param {string} className
 */
export function textButton(label, onclick, className = '') {
  return createElement('button', {type: 'button', textContent: label, onclick, className});
}

/**
 * A text of several lines, as bodies have it: Enter ends it, Shift and Enter break a line, Escape restores it.
 * @param {Record<string, any>} properties
 */
export function textField(properties) {
  const fit = () => { field.rows = field.value.split('\n').length; };
  const field = createElement('textarea', {maxLength: 200, oninput: fit, ...properties});
  const before = field.value;
  fit();
  field.onkeydown = (event) => {
    if (event.key === 'Escape') field.value = before;
    if (event.key !== 'Enter' || event.shiftKey || event.isComposing) return;
    event.preventDefault();
    field.blur();
  };
  return field;
}

/** @param {HTMLTextAreaElement} field, into which text with tabs may be pasted */
export function textOf(field) {
  return field.value.replaceAll('\t', ' ');
}

/**
 * A field for a number, with a decimal point or comma. What is none becomes again what it was, and so does a field
 * that must not be empty (`required`). The keys `decimal` of a telephone (`inputMode`) have no minus.
 * @param {?number} value null is an empty field
 * @param {(value: ?number) => void} change gets null for a field that was emptied
 * @param {Record<string, any>} properties
 */
export function numberField(value, change, properties = {}) {
  let before = value === null ? '' : digits(value, 5);
  const input = createElement('input', {className: 'number', autocomplete: 'off', value: before, ...properties,
    onfocus: () => { before = input.value; },
    onchange: () => {
      const typed = input.value.trim() === '' ? null : numberOf(input.value);
      if (Number.isNaN(typed) || typed === null && input.required) {
        input.value = before;
        input.dispatchEvent(new Event('input'));
        return;
      }
      before = input.value;
      change(typed);
    }});
  return input;
}

/**
 * @param {string} label
 * @param {number} min
 * @param {number} max
 * @param {number} step
 * @param {number} value
 * @param {(value: number) => void} change when it is let go
 */
export function range(label, min, max, step, value, change) {
  const typed = numberField(value, (now) => change(Number(now)), {
    required: true,
    inputMode: min < 0 ? 'text' : 'decimal',
    'aria-label': t('{quantity}, typed', {quantity: label}),
    oninput: () => {
      const now = numberOf(typed.value);
      input.max = String(Math.max(max, now || 0));
      input.value = String(now || 0);
    }});
  const input = createElement('input', {type: 'range', min, max: Math.max(max, value), step, value, 'aria-label': label,
    oninput: () => { typed.value = localized(input.value); },
    onchange: () => change(Number(input.value))});
  return createElement('div', {className: 'field'}, createElement('span', {}, label), typed, input);
}

/**
 * @param {string} text
 * @param {Node} field
 */
export function labelled(text, field) {
  return createElement('label', {}, text, field);
}

/**
 * @param {string} label
 * @param {boolean} checked
 * @param {(checked: boolean) => void} change
 */
export function checkField(label, checked, change) {
  const input = createElement('input', {type: 'checkbox', checked, onchange: () => change(input.checked)});
  return labelled(label, input);
}

/**
 * @param {string} label
 * @param {[value: string, text: string][]} options
 * @param {string} value that is chosen
 * @param {(value: string) => void} change
 */
export function choice(label, options, value, change) {
  const input = createElement('select', {'aria-label': label, onchange: () => change(input.value)},
    ...options.map(([each, textContent]) => createElement('option', {value: each, textContent})));
  input.value = value;
  return input;
}

/** @type {(...how: Parameters<typeof choice>) => HTMLLabelElement} a choice with its label beside it */
export function choiceField(label, ...how) {
  return labelled(label, choice(label, ...how));
}

/** @returns {HTMLElement} a choice of the language; the page is loaded again in it */
export function languageField() {
  return choiceField(t('Language'), Object.entries(LANGUAGES), language, chooseLanguage);
}

/**
 * A field with a button, in a row; Enter presses it.
 * @param {HTMLInputElement} input
 * @param {string} label of the button
 * @param {(text: string) => void} done gets what was typed, trimmed
 * @param {string} unit between them
 */
export function fieldForm(input, label, done, unit = '') {
  return createElement('form', {className: 'row', onsubmit: (/** @type {Event} */ event) => {
    event.preventDefault();
    done(input.value.trim());
  }}, input, unit, createElement('button', {}, label));
}

/**
 * Let a button show whether it is on, and change that.
 * @template {HTMLButtonElement} T
 * @param {T} button
 * @param {() => boolean} isOn
 * @param {() => void} change
 * @returns {T}
 */
export function toggling(button, isOn, change) {
  const show = () => button.setAttribute('aria-pressed', String(isOn()));
  button.onclick = () => {
    change();
    show();
  };
  show();
  return button;
}

/**
 * @param {HTMLElement} element
 * @param {string} text which it may have already: screen readers read what is new
 */
export function showText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/**
 * @param {() => void} show
 * @param {number} pause [ms]
 * @returns {() => void} has it shown soon, once for all calls of a pause
 */
export function soon(show, pause) {
  let timer = 0;
  return () => {
    timer ||= setTimeout(() => {
      timer = 0;
      show();
    }, pause);
  };
}

/**
 * Replace what is in an element: where a control of it has the focus, the one that takes its place has it then.
 * @param {HTMLElement} element
 * @param {Node[]} children
 */
export function replaceContent(element, ...children) {
  const controls = () => /** @type {HTMLElement[]} */ ([...element.querySelectorAll('button, input, select, summary, textarea')]);
  const place = controls().findIndex((each) => each === document.activeElement);
  element.replaceChildren(...children);
  controls()[place]?.focus({preventScroll: true});
}

/** @param {Node[]} children beside each other */
export function inRow(...children) {
  return createElement('div', {className: 'row'}, ...children);
}

/**
 * @template T
 * @param {Record<string, T>} presets by name
 * @param {(preset: T) => void} change
 */
export function presetButtons(presets, change) {
  const row = inRow(...Object.entries(presets).map(([name, preset]) => textButton(name, () => change(preset))));
  row.classList.add('presets');
  return row;
}

/**
 * @template {HTMLElement} [T=HTMLElement]
 * @param {string} id
 * @param {new () => T} kind
 * @returns {T}
 */
export function elementOf(id, kind = /** @type {any} */ (HTMLElement)) {
  const element = document.getElementById(id);
  if (!(element instanceof kind)) throw new TypeError(`no ${kind.name} #${id} on this page`);
  return element;
}

/**
 * @param {string} name of the file
 * @param {Blob} content
 */
export function download(name, content) {
  const href = URL.createObjectURL(content);
  createElement('a', {href, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(href), 1000);
}
