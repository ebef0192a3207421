// SPDX-License-Identifier: Apache-2.0
/**
 * Links with which the page was opened, to a world (link_dialog.js makes them), a lesson or a moment.
 *
 * Laws: they are offered only, since the link of a stranger does not replace the world of a class. A moment is the same
 * to the bit for everybody who goes to it.
 */

import {createElement, inRow, textButton} from '../dom.js';
import {t} from '../strings.js';
import {LARGEST} from './files.js';

/** @import {Parts} from '../types.js' */

const WORLD = /^#world=(.+)/;

export class Links {
  /** @param {Parts<'connection' | 'dialog' | 'files' | 'lessons' | 'notes' | 'people' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    parts.connection.on('welcome', () => this.#offerWorld());
    /** @type {?number} the moment to go to when time has come there [s] */
    this.wanted = null;
    // The list of lessons has come.
    parts.connection.on('worlds', () => this.#offerPlace());
    parts.connection.on('frame', () => this.#stopAt());
  }

  #offerWorld() {
    const packed = WORLD.exec(location.hash)?.[1];
    if (!packed || this.parts.people.viewOnly) return;
    history.replaceState(null, '', location.pathname + location.search);
    this.parts.dialog.show(t('This link contains a world'), inRow(textButton(t('Open it'), () => this.#open(packed))));
  }

  /** @param {string} packed */
  async #open(packed) {
    const {dialog, files, notes} = this.parts, text = await unpackText(packed).catch(() => null);
    if (text !== null) {
      await files.upload(text);
      return;
    }
    dialog.close();
    notes.showMessage(t('This link is broken, or its world is too large.'), {ok: false});
  }

  /** Offer the lesson, and the moment, that the address names. */
  #offerPlace() {
    const {lessons, dialog, notes, people: {viewOnly}, world} = this.parts, address = new URLSearchParams(location.hash.slice(1) || location.search);
    const name = address.get('lesson') ?? '', moment = Number(address.get('t') || NaN), hasMoment = moment >= 0;
    const lesson = lessons.list.find((each) => each.name === name);
    if (!name && !hasMoment || viewOnly) return;
    history.replaceState(null, '', location.pathname);
    if (name && !lesson) notes.showMessage(t('There is no lesson {name} here.', {name}), {ok: false});
    else if (lesson && lesson.title !== world.scene.lesson?.title) {
      dialog.show(t(lesson.title), createElement('p', {}, t(lesson.question)),
        inRow(textButton(t('Open the lesson'), async () => {
          await lessons.open(lesson);
          // Its timeline is to come.
          if (hasMoment) this.#playTo(moment);
        })));
    } else if (hasMoment) dialog.show(t('This link leads to a moment: {time} s', {time: moment}), inRow(textButton(t('Go there'), () => {
      dialog.close();
      this.#goTo(moment);
    })));
  }

  /** @param {number} time [s] where time has not been yet, the world is played until then */
  #goTo(time) {
    const {world, connection} = this.parts;
    if (time > world.timeline.newest) {
      this.#playTo(time);
      return;
    }
    connection.send('service', {name: 'pause'});
    connection.send('seek', {time});
  }

  /** @param {number} time [s] */
  #playTo(time) {
    this.wanted = time;
    this.parts.connection.send('service', {name: 'play'});
  }

  #stopAt() {
    if (this.wanted === null || this.parts.world.frame.time < this.wanted) return;
    const wanted = this.wanted;
    this.wanted = null;
    this.parts.connection.send('service', {name: 'pause'});
    // It has gone on meanwhile.
    this.parts.connection.send('seek', {time: wanted});
  }
}

/** @param {string} packed */
async function unpackText(packed) {
  const binary = atob(packed.replaceAll('-', '+').replaceAll('_', '/'));
  const bytes = Uint8Array.from(binary, (character) => character.charCodeAt(0));
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw')).getReader();
  const chunks = [];
  for (let size = 0; ;) {
    const {value, done} = await reader.read();
    if (done) return new Blob(chunks).text();
    size += value.length;
    if (size > LARGEST) throw new RangeError('the world of this link is too large');
    chunks.push(value);
  }
}
