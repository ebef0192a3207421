// SPDX-License-Identifier: Apache-2.0
/** Notes on the world: anchored sensors that are boxes as large as their label. */

import {elementOf, textOf, textField} from '../dom.js';
import {Tool} from './tool.js';
import {labelSize} from '../view/label_view.js';
import {t} from '../strings.js';

/** @import {Parts, Touch} from '../types.js' */

const LETTERS = 16, HALF = 140; // px: size of letters where a note is written, half the width of its field
const LOOK = {anchored: true, sensor: true, color: '#ffe680'};

/** @extends {Tool<Parts<'camera' | 'connection' | 'people' | 'view'>>} */
export class Note extends Tool {
  clicks = 1;

  /** @param {Touch} touch */
  end({at, page: [x, y]}) {
    const {parts} = this, em = LETTERS / parts.camera.scale;
    const field = textField({'aria-label': t('Note'), onblur: () => field.remove(), onchange: () => {
      const label = textOf(field).trim();
      if (label) sendNote(parts, parts.people.freeName('note'), label, at, em, LOOK);
    }});
    field.style.left = `${Math.min(Math.max(x, HALF), parts.camera.width - HALF)}px`;
    field.style.top = `${y}px`;
    elementOf('places').append(field);
    field.focus();
  }
}

/**
 * Write a note, or change what is written on it.
 * @param {Parts<'connection' | 'view'>} parts
 * @param {string} name
 * @param {string} label
 * @param {number[]} at x, y [m], and where there are three, yaw [rad]
 * @param {number} em size of letters [m]
 * @param {object} look other properties
 */
export function sendNote({view, connection}, name, label, at, em, look = {}) {
  const [wide, high] = labelSize(view.ctx, label);
  connection.send('spawn', {body: {name, label, at, box: {width: wide * em, height: high * em}, ...look}});
}
