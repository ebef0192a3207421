// SPDX-License-Identifier: Apache-2.0
/**
 * Links: one that holds this world, and those with which the page was opened, to a world or a lesson.
 *
 * These are offered only: the link of a stranger does not replace the world of a class.
 */

import {createElement, inRow, textButton} from '../dom.js';
import {t} from '../strings.js';
import {LARGEST} from './gallery.js';

/** @import {App} from '../types.js' */

const WORLD = /^#world=(.+)/, LESSON = /[#?&]lesson=([^&]+)/;
const LONGEST = 16000; // characters

export class Links {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    app.connection.on('welcome', () => this.#offerWorld());
    // The list of lessons has come.
    app.connection.on('worlds', () => this.#offerLesson());
    addEventListener('hashchange', () => this.#offerLesson());
  }

  /** Show a link that holds the world as it is now, and copy it. */
  async copy() {
    const {dialog, gallery, notes} = this.app, world = await gallery.text();
    if (world === null) return;
    const link = `${location.origin}/#world=${await packText(world)}`;
    if (link.length > LONGEST) {
      notes.showMessage(t('This world is too large for a link: download it as a file.'), {ok: false});
      return;
    }
    const text = createElement('input', {value: link, readOnly: true, 'aria-label': t('Link')});
    dialog.show(t('A link that holds this world'), text);
    text.select();
    notes.showMessage(t('A link that holds this world'));
    await navigator.clipboard?.writeText(link).catch(() => {});
  }

  #offerWorld() {
    const packed = WORLD.exec(location.hash)?.[1];
    if (!packed || this.app.viewOnly) return;
    history.replaceState(null, '', location.pathname + location.search);
    this.app.dialog.show(t('This link contains a world'), inRow(textButton(t('Open it'), () => this.#open(packed))));
  }

  /** @param {string} packed */
  async #open(packed) {
    const {dialog, gallery, notes} = this.app, text = await unpackText(packed).catch(() => null);
    if (text !== null) {
      await gallery.upload(text);
      return;
    }
    dialog.close();
    notes.showMessage(t('This link is broken, or its world is too large.'), {ok: false});
  }

  #offerLesson() {
    const {lessons, dialog, notes, viewOnly, world} = this.app;
    const name = decodeURIComponent(LESSON.exec(location.hash || location.search)?.[1] ?? '');
    const lesson = lessons.list.find((each) => each.name === name);
    if (!name || viewOnly) return;
    history.replaceState(null, '', location.pathname);
    if (lesson && lesson.title === world.scene.lesson?.title) return;
    if (!lesson) notes.showMessage(t('There is no lesson {name} here.', {name}), {ok: false});
    else {
      dialog.show(t(lesson.title), createElement('p', {}, t(lesson.question)),
        inRow(textButton(t('Open the lesson'), () => lessons.open(lesson))));
    }
  }
}

/**
 * @param {string} text
 * @returns {Promise<string>} for a link: deflated, then base64 for addresses (RFC 4648, section 5)
 */
async function packText(text) {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream('deflate-raw'));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const binary = Array.from(bytes, (byte) => String.fromCharCode(byte)).join('');
  return btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
}

/** @param {string} packed */
async function unpackText(packed) {
  const binary = atob(packed.replaceAll('-', '+').replaceAll('_', '/'));
  const bytes = Uint8Array.from(binary, (character) => character.charCodeAt(0));
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw')).getReader();
  const parts = [];
  for (let size = 0; ;) {
    const {value, done} = await reader.read();
    if (done) return new Blob(parts).text();
    size += value.length;
    if (size > LARGEST) throw new RangeError('the world of this link is too large');
    parts.push(value);
  }
}
