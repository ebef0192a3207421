// SPDX-License-Identifier: Apache-2.0
/** Worlds: a gallery to open from, saving by name, files, a picture. */

import {ownName} from './classroom.js';
import {createElement, download, fieldForm, inRow, textButton} from '../dom.js';
import {language, t} from '../strings.js';
import {capital} from '../words.js';

/** @import {App} from '../types.js' */

const NAME = '[^\\/\\\\.]*[^\\/\\\\.\\s][^\\/\\\\.]*'; // of a world
const EMPTY = 'format: 1\ngravity: [0, -9.81]\ndamping: 0\nbounds: [-10, 0, 10, 9]\ndensity: 1\nfriction: 0.5\nelasticity: 0.5\nbodies: []\n';
const WORLDS = t('Worlds'); // title
const UNSAVED = 30000; // ms for which the unsaved world is offered beside the world; then it is in the list
export const LARGEST = 1 << 20; // bytes of a world

export class Gallery {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {{name: string, title: string, picture: string, shipped: boolean}[]} */
    this.worlds = [];
    app.connection.on('worlds', ({worlds}) => {
      this.worlds = worlds;
      // The picture of a world comes after the world.
      app.dialog.renew(WORLDS, () => this.showWorlds());
    });
    this.offered = 0; // [s since 1970] the unsaved world that was offered
    this.unsaved = ''; // date of the unsaved world, and who drew it, until it is opened or discarded
    this.dismiss = () => {};
    this.name = ''; // of the own world that is open
    app.connection.on('welcome', ({unsaved, unsaved_by: by, teacher}) => this.#offerUnsaved(unsaved, by, teacher));
  }

  /** Show the list, and again as the files are now: a lesson may have been written since. */
  openWorlds() {
    this.showWorlds();
    this.app.connection.send('list');
  }

  showWorlds() {
    const own = this.worlds.filter(({shipped}) => !shipped), shipped = this.worlds.filter((each) => each.shipped);
    const cards = (/** @type {typeof own} */ worlds) =>
      createElement('div', {className: 'cards'}, ...worlds.map((world) => this.#card(world)));
    const file = createElement('input', {type: 'file', accept: '.yaml,.yml',
      onchange: async () => file.files?.[0] && this.upload(await file.files[0].text())});
    this.app.dialog.show(WORLDS, inRow(textButton(t('Empty room'), () => this.upload(EMPTY)),
      createElement('label', {className: 'file'}, t('Open a file'), file),
      ...this.unsaved ? [textButton(t('Unsaved world of {date}', {date: this.unsaved}), () => this.#openUnsaved())] : []),
    ...own.length ? [createElement('h3', {}, t('Yours')), cards(own)] : [],
    ...this.app.lessons.section(), createElement('h3', {}, t('To explore, simplest first')), cards(shipped));
  }

  /** @param {typeof this.worlds[0]} world */
  #card({name, title, picture, shipped}) {
    const heading = shipped ? t(capital(name.replaceAll('_', ' '))) : name;
    const open = () => this.follow(this.app.connection.openWorld(name), heading, shipped ? '' : name);
    const card = createElement('button', {type: 'button', className: 'card', onclick: open},
      createElement('img', {src: picture, alt: '', loading: 'lazy'}),
      createElement('strong', {}, heading),
      // A title that only repeats the name tells nothing.
      ...shipped && t(title) !== heading ? [createElement('small', {}, t(title))] : []);
    if (shipped) return card;
    return createElement('div', {className: 'own'}, card, inRow(
      textButton(t('Rename'), () => this.app.dialog.show(t('Rename {name}', {name}), this.#nameForm(t('New name'), name, t('Rename'), (to) => this.#rename(name, to)))),
      textButton(t('Delete'), () => this.#delete(name), 'danger')));
  }

  /**
   * @param {string} name
   * @param {string} to
   */
  async #rename(name, to) {
    if (!(await this.app.connection.ask('rename', {name, to})).ok) return;
    this.app.notes.offer(t('Renamed to {name}', {name: to}), t('Undo'), () => this.app.connection.send('rename', {name: to, to: name}));
  }

  /** @param {string} name */
  async #delete(name) {
    this.app.dialog.close();
    if (!(await this.app.connection.ask('remove', {name})).ok) return;
    this.app.notes.offer(t('{name} is deleted', {name}), t('Undo'), () => this.app.connection.send('put_back', {name}));
  }

  /**
   * @param {string} title
   * @param {string} value
   * @param {string} label of the button
   * @param {(name: string) => void} done
   * @returns {HTMLFormElement} that asks for the name of a world
   */
  #nameForm(title, value, label, done) {
    const name = createElement('input', {value, required: true, maxLength: 64, autocomplete: 'off', 'aria-label': title,
      pattern: NAME, title: t('Letters, digits, spaces, - and _; without / and .')});
    queueMicrotask(() => name.select());
    return fieldForm(name, label, (text) => {
      this.app.dialog.close();
      done(text);
    });
  }

  /**
   * @param {string} name
   * @returns {string} that name, with a number where it is taken
   */
  #freeName(name) {
    const taken = new Set(this.worlds.map((each) => each.name)), stem = name.replace(/ \d+$/, '');
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
    this.app.dialog.close();
    const {ok, code} = await this.app.connection.ask('save', {name, replace});
    if (ok) {
      this.name = name;
      this.#sendPicture(name);
      if (replace) this.app.notes.offer(t('{name} is replaced', {name}), t('Undo'), () => this.app.connection.send('put_back', {name}));
      return;
    }
    if (code !== 'exists') return;
    const free = this.#freeName(name), own = this.worlds.some((each) => each.name === name && !each.shipped);
    const choices = [textButton(t('Save as {name}', {name: free}), () => this.#save(free))];
    if (own) choices.push(textButton(t('Replace {name}', {name}), () => this.#save(name, true), 'danger'));
    this.app.dialog.show(own ? t('There is a world {name} already', {name}) : t('{name} is a world that ships with physsim', {name}), inRow(...choices));
  }

  /** @param {string} name of the world that is shown */
  #sendPicture(name) {
    const {view: {canvas, insets, ratio}} = this.app, width = canvas.width - (insets.left + insets.right) * ratio;
    const height = canvas.height - (insets.top + insets.bottom) * ratio;
    const small = createElement('canvas', {width: 480, height: 200}), scale = Math.min(480 / width, 200 / height);
    const ctx = small.getContext('2d');
    if (!ctx || !(scale > 0)) return;
    ctx.fillStyle = this.app.view.palette.paper;
    ctx.fillRect(0, 0, 480, 200);
    ctx.drawImage(canvas, insets.left * ratio, insets.top * ratio, width, height,
      240 - width * scale / 2, 100 - height * scale / 2, width * scale, height * scale);
    small.toBlob((body) => body && fetch(`/picture/${encodeURIComponent(name)}`, {method: 'POST', body}));
  }

  /**
   * @param {number} saved when a world was kept that nobody has saved [s since 1970]; 0 is none
   * @param {string[]} by names of those who drew it
   * @param {boolean} teacher whether this page is a teacher's
   */
  #offerUnsaved(saved, by, teacher) {
    if (!saved || this.app.viewOnly || this.offered === saved) return;
    this.offered = saved;
    const date = new Date(saved * 1000).toLocaleString(language, {dateStyle: 'medium', timeStyle: 'short'});
    this.unsaved = by.length ? `${date} (${by.join(', ')})` : date;
    // A world is discarded by those who drew it.
    const discards = teacher || !by.length || by.includes(ownName());
    this.dismiss = this.app.notes.dock([t('The world of {date} was not saved.', {date: this.unsaved}),
      textButton(t('Open it'), () => this.#openUnsaved()), ...discards ? [textButton(t('Discard it'), () => this.#forgetUnsaved())] : []],
    UNSAVED);
  }

  async #openUnsaved() {
    const text = await fetch('/unsaved').then((response) => response.ok ? response.text() : null, () => null);
    const {unsaved} = this;
    if (text === null || !await this.upload(text)) return;
    await this.#forgetUnsaved();
    this.app.notes.showMessage(t('Opened the world of {date}', {date: unsaved}));
  }

  #forgetUnsaved() {
    this.dismiss();
    this.unsaved = '';
    return this.app.connection.ask('forget');
  }

  showSave() {
    const name = this.name || this.#freeName(t('my world'));
    this.app.dialog.show(t('Save'), this.#nameForm(t('Name of the world'), name, t('Save world'), (given) => this.#save(given)), inRow(
      textButton(t('Download file'), () => this.#download()),
      textButton(t('Copy link'), () => this.app.links.copy()),
      textButton(t('Link to this moment'), () => this.app.links.copyMoment()),
      textButton(t('Picture (PNG)'), () => this.app.view.canvas.toBlob((png) => png && download('world.png', png)))));
  }

  /**
   * Show the world that is being opened, as soon as it is.
   * @param {Promise<boolean>} opening whether it is open
   * @param {string} heading
   * @param {string} name of an own world, under which it is saved again
   */
  async follow(opening, heading, name = '') {
    this.app.dialog.close();
    if (!(await opening)) return;
    this.dismiss();
    this.app.room.frameNext();
    this.app.notes.showMessage(t('Opened {name}', {name: heading}));
    this.name = name;
  }

  /**
   * @param {string} text of a world file
   * @returns {Promise<boolean>} whether it is open
   */
  async upload(text) {
    this.app.dialog.close();
    if (new Blob([text]).size > LARGEST) {
      this.app.notes.showMessage(t('This file is too large: a world has at most 1 MiB here.'), {ok: false});
      return false;
    }
    const {ok, message, code} = await fetch('/world', {method: 'POST', body: text, headers: {'Content-Type': 'application/yaml'}})
      .then((response) => response.json().catch(() => ({ok: false, code: '', message: t('The server refused this file')})),
        () => ({ok: false, code: '', message: t('Not done: the server is not reachable')}));
    if (ok) {
      this.name = '';
      this.dismiss();
      this.app.room.frameNext();
    }
    this.app.notes.showMessage(this.app.words.tell({message, code, ok}), {ok});
    return ok;
  }

  /** @returns {Promise<?string>} the world as a file; null where it is refused, as too large */
  async text() {
    return (await this.app.connection.ask('share')).values.yaml ?? null;
  }

  async #download() {
    const text = await this.text();
    if (text !== null) download('world.yaml', new Blob([text]));
  }
}
