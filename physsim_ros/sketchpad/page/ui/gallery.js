// SPDX-License-Identifier: Apache-2.0
/** Worlds: a gallery to open from, saving by name, files, a picture. */

import {createElement, download, fieldForm, inRow, textButton} from '../dom.js';
import {t} from '../strings.js';
import {showMomentLink, showWorldLink} from './link_dialog.js';
import {headingOf} from '../words.js';

/** @import {Parts} from '../types.js' */
/** @import {World} from './files.js' */

/** @typedef {Parts<'connection' | 'dialog' | 'files' | 'lessons' | 'notes' | 'view' | 'world'>} GalleryParts */

const NAME = '[^\\/\\\\.]*[^\\/\\\\.\\s][^\\/\\\\.]*'; // of a world
const EMPTY = 'format: 1\ngravity: [0, -9.81]\ndamping: 0\nbounds: [-10, 0, 10, 9]\ndensity: 1\nfriction: 0.5\nelasticity: 0.5\nbodies: []\n';
const WORLDS = t('Worlds'); // title

export class Gallery {
  /** @param {GalleryParts} parts */
  constructor(parts) {
    this.parts = parts;
    // The picture of a world comes after the world.
    parts.connection.on('worlds', () => parts.dialog.renew(WORLDS, () => this.showWorlds()));
  }

  /** Show the list, and again as the files are now: a lesson may have been written since. */
  openWorlds() {
    this.showWorlds();
    this.parts.connection.send('list');
  }

  showWorlds() {
    const {files} = this.parts, own = files.worlds.filter(({shipped}) => !shipped), shipped = files.worlds.filter((each) => each.shipped);
    const cards = (/** @type {typeof own} */ worlds) =>
      createElement('div', {className: 'cards'}, ...worlds.map((world) => this.#card(world)));
    const file = createElement('input', {type: 'file', accept: '.yaml,.yml',
      onchange: async () => file.files?.[0] && files.upload(await file.files[0].text())});
    this.parts.dialog.show(WORLDS, inRow(textButton(t('Empty room'), () => files.upload(EMPTY)),
      createElement('label', {className: 'file'}, t('Open a file'), file),
      ...files.unsaved ? [textButton(t('Unsaved world of {date}', {date: files.unsaved}), () => files.openUnsaved())] : []),
    ...own.length ? [createElement('h3', {}, t('Yours')), cards(own)] : [],
    ...this.parts.lessons.section(), createElement('h3', {}, t('To explore, simplest first')), cards(shipped));
  }

  /** @param {World} world */
  #card(world) {
    const {name, title, picture, shipped} = world, heading = headingOf(world);
    const open = () => this.parts.files.follow(this.parts.connection.openWorld(name), heading, {name: shipped ? '' : name});
    const card = createElement('button', {type: 'button', className: 'card', onclick: open},
      createElement('img', {src: picture, alt: '', loading: 'lazy'}),
      createElement('strong', {}, heading),
      // A title that only repeats the name tells nothing.
      ...shipped && t(title) !== heading ? [createElement('small', {}, t(title))] : []);
    if (shipped) return card;
    return createElement('div', {className: 'own'}, card, inRow(
      textButton(t('Rename'), () => this.parts.dialog.show(t('Rename {name}', {name}), this.#nameForm(t('New name'), name, t('Rename'), (to) => this.#rename(name, to)))),
      textButton(t('Delete'), () => this.#delete(name), 'danger')));
  }

  /**
   * @param {string} name
   * @param {string} to
   */
  async #rename(name, to) {
    const {connection, files, notes} = this.parts;
    if (!(await connection.ask('rename', {name, to})).ok) return;
    if (files.name === name) files.name = to;
    notes.offer(t('Renamed to {name}', {name: to}), t('Undo'), () => this.#rename(to, name));
  }

  /** @param {string} name */
  async #delete(name) {
    this.parts.dialog.close();
    if (!(await this.parts.connection.ask('remove', {name})).ok) return;
    this.parts.notes.offer(t('{name} is deleted', {name}), t('Undo'), () => this.parts.connection.send('put_back', {name}));
  }

  /**
   * @param {string} title
   * @param {string} value
   * @param {string} label of the button
   * @param {(name: string) => void} done
   * @returns {HTMLFormElement} that asks for the name of a world
   */
  #nameForm(title, value, label, done) {
    const name = createElement('input', {value, required: true, autofocus: true, maxLength: 64, autocomplete: 'off', 'aria-label': title,
      pattern: NAME, title: t('Letters, digits, spaces, - and _; without / and .')});
    return fieldForm(name, label, (text) => {
      this.parts.dialog.close();
      done(text);
    });
  }

  /**
   * @param {string} name
   * @returns {string} that name, with a number where it is taken
   */
  #freeName(name) {
    const taken = new Set(this.parts.files.worlds.map((each) => each.name)), stem = name.replace(/ \d+$/, '');
    for (let number = 1; ; number++) {
      const free = number > 1 ? `${stem} ${number}` : stem;
      if (!taken.has(free)) return free;
    }
  }

  /**
   * Save, and ask once where the name is taken.
   * @param {string} name
   * @param {boolean} replace
   */
  async #save(name, replace = false) {
    this.parts.dialog.close();
    const {ok, code} = await this.parts.connection.ask('save', {name, replace});
    if (ok) {
      this.parts.files.name = name;
      this.#sendPicture(name);
      if (replace) this.parts.notes.offer(t('{name} is replaced', {name}), t('Undo'), () => this.parts.connection.send('put_back', {name}));
      return;
    }
    if (code !== 'exists') return;
    const free = this.#freeName(name), own = this.parts.files.worlds.some((each) => each.name === name && !each.shipped);
    const choices = [textButton(t('Save as {name}', {name: free}), () => this.#save(free))];
    if (own) choices.push(textButton(t('Replace {name}', {name}), () => this.#save(name, true), 'danger'));
    this.parts.dialog.show(own ? t('There is a world {name} already', {name}) : t('{name} is a world that ships with physsim', {name}), inRow(...choices));
  }

  /** @param {string} name of the world that is shown */
  #sendPicture(name) {
    const {view: {canvas, insets, ratio}} = this.parts, width = canvas.width - (insets.left + insets.right) * ratio;
    const height = canvas.height - (insets.top + insets.bottom) * ratio;
    const small = createElement('canvas', {width: 480, height: 200}), scale = Math.min(480 / width, 200 / height);
    const ctx = small.getContext('2d');
    if (!ctx || !(scale > 0)) return;
    ctx.fillStyle = this.parts.view.palette.paper;
    ctx.fillRect(0, 0, 480, 200);
    ctx.drawImage(canvas, insets.left * ratio, insets.top * ratio, width, height,
      240 - width * scale / 2, 100 - height * scale / 2, width * scale, height * scale);
    small.toBlob((body) => body && fetch(`/picture/${encodeURIComponent(name)}`, {method: 'POST', body}).catch(() => {}));
  }

  showSave() {
    const name = this.parts.files.name || this.#freeName(t('my world'));
    this.parts.dialog.show(t('Save'), this.#nameForm(t('Name of the world'), name, t('Save world'), (given) => this.#save(given)), inRow(
      textButton(t('Download file'), () => this.#download()),
      textButton(t('Copy link'), () => showWorldLink(this.parts)),
      textButton(t('Link to this moment'), () => showMomentLink(this.parts)),
      textButton(t('Picture (PNG)'), () => this.parts.view.canvas.toBlob((png) => png && download('world.png', png)))));
  }

  async #download() {
    const text = await this.parts.files.text();
    if (text !== null) download('world.yaml', new Blob([text]));
  }
}
