// SPDX-License-Identifier: Apache-2.0
/** Tables of what was recorded of bodies (CSV): all quantities, the bodies one below the other. */

import {csvOf, downloadTable} from '../csv.js';
import {QUANTITIES} from './quantities.js';
import {digits} from '../rounding.js';
import {t} from '../strings.js';

/** @import {Parts} from '../types.js' */

/** @typedef {Parts<'notes' | 'records' | 'world'>} TableParts */

const NOTHING = 1e-9; // in its unit: rounding of what is 0

/**
 * @param {TableParts} parts
 * @param {string[]} names of bodies
 * @returns {string[][]} rows, with the head first
 */
function tableOf({world, records}, names) {
  const columns = Object.values(QUANTITIES);
  const rows = names.flatMap((name) => {
    const body = world.body(name);
    return body ? records.samples(name).map((sample) => [...columns.map(({of}) => cellOf(of(sample, body, world.scene.gravity))), name]) : [];
  });
  return [[...columns.map(({label}) => label), t('Body')], ...rows];
}

/**
 * @param {TableParts} parts
 * @param {string[]} names of bodies
 */
export function saveTable(parts, names) {
  downloadTable(names[0].replaceAll('/', '-'), tableOf(parts, names));
}

/**
 * @param {TableParts} parts
 * @param {string[]} names of bodies
 */
export async function copyTable(parts, names) {
  try {
    await navigator.clipboard.writeText(csvOf(tableOf(parts, names)));
    parts.notes.showMessage(t('Table copied'));
  } catch {
    // Browsers give the clipboard to pages of this machine or with TLS only.
    saveTable(parts, names);
  }
}

/** @param {number} value as spreadsheets read it, whose minus is a hyphen */
function cellOf(value) {
  return Number.isNaN(value) ? '' : digits(Math.abs(value) < NOTHING ? 0 : value, 6).replaceAll('−', '-');
}
