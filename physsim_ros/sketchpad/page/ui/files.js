// SPDX-License-Identifier: Apache-2.0
/** World files: how a world is opened, the text of the one that is shown, and the one that nobody has saved. */

import {textButton} from '../dom.js';
import {ownName} from '../people.js';
import {language, t} from '../strings.js';

/** @import {Parts} from '../types.js' */

const UNSAVED = 30000; // ms for which the unsaved world is offered beside the world; then it is in the list
export const LARGEST = 1 << 20; // bytes of a world

/** @typedef {{name: string, title: string, picture: string, shipped: boolean}} World */

export class Files {
  /** @param {Parts<'connection' | 'dialog' | 'notes' | 'people' | 'room' | 'words'>} parts */
  constructor(parts) {
    this.parts = parts;
    /** @type {World[]} that can be opened */
    this.worlds = [];
    parts.connection.on('worlds', ({worlds}) => { this.worlds = worlds; });
    this.offered = 0; // [s since 1970] the unsaved world that was offered
    this.unsaved = ''; // date of the unsaved world, and who drew it, until it is opened or discarded
    this.dismiss = () => {};
    this.name = ''; // of the own world that is open
    parts.connection.on('welcome', ({unsaved, unsaved_by: by, teacher}) => this.#offerUnsaved(unsaved, by, teacher));
  }

  /**
   * Show the world that is being opened, as soon as it is.
   * @param {Promise<boolean>} opening whether it is open
   * @param {string} heading
   * @param {{name?: string, unseen?: boolean}} how name: of an own world, under which it is saved again
   */
  async follow(opening, heading, {name = '', unseen = false} = {}) {
    this.parts.dialog.close();
    if (!(await opening)) return;
    this.dismiss();
    this.parts.room.frameNext();
    this.parts.notes.showMessage(t('Opened {name}', {name: heading}), {unseen});
    this.name = name;
  }

  /**
   * @param {string} text of a world file
   * @returns {Promise<boolean>} whether it is open
   */
  async upload(text) {
    this.parts.dialog.close();
    if (new Blob([text]).size > LARGEST) {
      this.parts.notes.showMessage(t('This file is too large: a world has at most 1 MiB here.'), {ok: false});
      return false;
    }
    const {ok, text: answer, code} = await fetch('/world', {method: 'POST', body: text, headers: {'Content-Type': 'application/yaml'}})
      .then((response) => response.json().catch(() => ({ok: false, code: '', text: [t('The server refused this file'), {}]})),
        () => ({ok: false, code: '', text: [t('Not done: the server is not reachable'), {}]}));
    const {notes, room, words} = this.parts;
    if (ok) {
      this.name = '';
      this.dismiss();
      room.frameNext();
    }
    notes.showMessage(words.sayAnswer({text: answer, code, ok}), {ok});
    return ok;
  }

  /** @returns {Promise<?string>} the world as a file; null where it is refused, as too large */
  async text() {
    return (await this.parts.connection.ask('share')).values.yaml ?? null;
  }

  /**
   * @param {number} saved when a world was kept that nobody has saved [s since 1970]; 0 is none
   * @param {string[]} by names of those who drew it
   * @param {boolean} teacher whether this page is a teacher's
   */
  #offerUnsaved(saved, by, teacher) {
    if (!saved || this.parts.people.viewOnly || this.offered === saved) return;
    this.offered = saved;
    const date = new Date(saved * 1000).toLocaleString(language, {dateStyle: 'medium', timeStyle: 'short'});
    this.unsaved = by.length ? `${date} (${by.join(', ')})` : date;
    // A world is discarded by those who drew it.
    const discards = teacher || !by.length || by.includes(ownName());
    this.dismiss = this.parts.notes.dock([t('The world of {date} was not saved.', {date: this.unsaved}),
      textButton(t('Open it'), () => this.openUnsaved()), ...discards ? [textButton(t('Discard it'), () => this.#forgetUnsaved())] : []],
    UNSAVED);
  }

  async openUnsaved() {
    const text = await fetch('/unsaved').then((response) => response.ok ? response.text() : null, () => null);
    const {unsaved} = this;
    if (text === null || !await this.upload(text)) return;
    await this.#forgetUnsaved();
    this.parts.notes.showMessage(t('Opened the world of {date}', {date: unsaved}));
  }

  #forgetUnsaved() {
    this.dismiss();
    this.unsaved = '';
    return this.parts.connection.ask('forget');
  }
}
