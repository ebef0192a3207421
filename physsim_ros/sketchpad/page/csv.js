// SPDX-License-Identifier: Apache-2.0
/**
 * Tables as text (CSV): where numbers have a comma, columns are parted by semicolons, as spreadsheets in that
 * language expect.
 *
 * Law: no cell is a formula, whatever name or answer somebody has typed (OWASP, CSV injection).
 */

import {download} from './dom.js';
import {numberOf} from './rounding.js';
import {localized} from './strings.js';

const FORMULAS = ['=', '+', '-', '−', '@', '＝', '＋', '－', '＠', '\t', '\r'], QUOTED = [',', ';', '"', '\'', '\n', '\r']; // a cell that begins with, and one that has
const SEPARATOR = localized('.') === '.' ? ',' : ';';

/**
 * Save a table as a file, in which spreadsheets read the letters of all languages by its mark of UTF-8.
 * @param {string} name of the file
 * @param {string[][]} rows
 */
export function downloadTable(name, rows) {
  download(`${name}.csv`, new Blob(['\ufeff', csvOf(rows)], {type: 'text/csv'}));
}

/** @param {string[][]} rows */
export function csvOf(rows) {
  return rows.map((row) => `${row.map(cell).join(SEPARATOR)}\n`).join('');
}

/** @param {string} text */
function cell(text) {
  const safe = FORMULAS.includes(text.charAt(0)) && Number.isNaN(numberOf(text)) ? `'${text}` : text;
  return QUOTED.some((each) => safe.includes(each)) ? `"${safe.replaceAll('"', '""')}"` : safe;
}
