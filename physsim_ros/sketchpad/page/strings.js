// SPDX-License-Identifier: Apache-2.0
/**
 * Texts in the language of the reader: `t('Open it')`. The English text is the key of its translation, in
 * `languages/<language>.json`, which only pages in that language load.
 *
 * A text has its values in braces, by name; a number among them has the decimal sign of the language, which is that
 * of the browser, until somebody chooses another one in the help; the page is then loaded again.
 *
 * Texts of the server have its template as their key, also in English, where the page says some of them otherwise.
 */

/** @import {Text} from './types.js' */

/** Names of the languages in themselves. @type {Record<string, string>} */
export const LANGUAGES = {en: 'English', de: 'Deutsch'};
const KEY = 'physsim-language';

/** The language of the page (BCP 47). */
export const language = [localStorage.getItem(KEY), ...navigator.languages.map((each) => each.split('-')[0])]
  .find((each) => each && each in LANGUAGES) ?? 'en';

/**
 * Translations by English text, by template of the server, and by the code of a refusal, where `{message}` is the server's own one.
 * @type {{texts: Record<string, string>, server: Record<string, string>, refusals: Record<string, string>}}
 */
const table = await fetch(`/page/languages/${language}.json`).then((response) => response.json())
  .catch(() => ({texts: {}, server: {}, refusals: {}}));

const PLACE = /\{(\w+)[^{}]*\}/g; // of a value, with its format where the server writes it
const SIGN = (1.5).toLocaleString(language)[1];

/** @param {string} number with a decimal point, which is given the sign of the language, and a hyphen that is its minus */
export function localized(number) {
  return number.replaceAll('.', SIGN).replaceAll('-', '−');
}

/**
 * @param {string} text in English, with the names of its values in braces
 * @param {Record<string, string | number>} values
 * @returns {string} in the language of the page
 */
export function t(text, values = {}) {
  return filled(table.texts[text] ?? text, values);
}

/** @param {string} template or word of the server */
export function server(template) {
  return table.server[template] ?? template;
}

/**
 * @param {Text} text of the server
 * @param {(value: string, place: string) => string} word for a value that is neither text nor number, by the name in its
 *   braces: with a capital, it begins a sentence
 * @returns {string} what the page says instead
 */
export function said([template, values], word = (value) => value) {
  return server(template).replace(PLACE, (braces, place) => {
    const name = place[0].toLowerCase() + place.slice(1), value = values[name];
    if (value === undefined) return braces;
    // A number has its format in the template, or is a time; a name that looks like one stays as it is.
    if (name === 'time' || template.includes(`{${name}:`)) return String(value).replace(/\d\.\d/g, localized);
    if (typeof value === 'string') return word(value, place);
    return name === place ? said(value, word) : capital(said(value, word));
  });
}

/**
 * @param {string} code of a refusal
 * @param {string} message of the server, translated if its template is
 * @param {string} template
 * @returns {string} what the refusal says: the sentence of its code, with the message, or in its place where that is translated
 */
export function refusalText(code, message, template) {
  const sentence = table.refusals[code] ?? '{message}';
  return template in table.server && !sentence.includes('{message}') ? message : filled(sentence, {message});
}

/** @param {string} chosen one of the languages */
export function chooseLanguage(chosen) {
  localStorage.setItem(KEY, chosen);
  location.reload();
}

/**
 * @param {string} text with the names of values in braces
 * @param {Record<string, string | number>} values
 */
export function filled(text, values) {
  return text.replace(PLACE, (braces, name) => {
    const value = values[name] ?? braces;
    return typeof value === 'number' ? localized(String(value)) : value;
  });
}

/** @param {string} text */
export function capital(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

const ATTRIBUTES = ['aria-label', 'title', 'placeholder', 'alt'];

/** Translate what the HTML of the page says. */
function translateDocument() {
  document.documentElement.lang = language;
  document.title = t(document.title);
  for (const element of document.body.querySelectorAll('*')) {
    for (const name of ATTRIBUTES) {
      const text = element.getAttribute(name);
      if (text) element.setAttribute(name, t(text));
    }
    const {firstChild} = element;
    if (!element.children.length && firstChild) firstChild.nodeValue = t(firstChild.nodeValue ?? '');
  }
}

translateDocument();
