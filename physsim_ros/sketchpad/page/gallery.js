// SPDX-License-Identifier: Apache-2.0
/** Worlds: a gallery to open from, saving by name, files, a link that holds the world, a picture. */

import {createElement, download, elementOf, icon, iconButton, textButton} from './dom.js';

/** @import {App} from './types.js' */

const LONGEST_LINK = 16000; // characters
const LARGEST = 1 << 20; // bytes; no larger world is unpacked from a link

export class Gallery {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.dialog = elementOf('dialog', HTMLDialogElement);
    /** @type {{name: string, title: string, picture: string, shipped: boolean}[]} */
    this.worlds = [];
    this.dialog.addEventListener('click', (event) => {
      if (event.target === this.dialog) this.dialog.close();
    });
    app.connection.on('worlds', ({worlds}) => { this.worlds = worlds; });
    app.connection.on('welcome', () => this.#offerLink());
  }

  /**
   * @param {string} title
   * @param {Node[]} content
   */
  show(title, ...content) {
    this.dialog.setAttribute('aria-label', title);
    this.dialog.replaceChildren(createElement('header', {}, createElement('h2', {textContent: title}),
      iconButton('Close', 'close', () => this.dialog.close(), '')),
    ...content);
    if (!this.dialog.open) this.dialog.showModal();
    this.dialog.scrollTop = 0;
  }

  showWorlds() {
    const cards = this.worlds.map(({name, title, picture}) => createElement('button',
      {type: 'button', className: 'card', onclick: () => this.#open(name)},
      picture ? createElement('img', {src: picture, alt: '', loading: 'lazy'}) : createElement('span', {className: 'blank'}, icon('pen')),
      createElement('strong', {textContent: name.replaceAll('_', ' ')}),
      createElement('small', {textContent: title === name ? 'Yours' : title})));
    const file = createElement('input', {type: 'file', accept: '.yaml,.yml',
      onchange: async () => file.files?.[0] && this.#upload(await file.files[0].text())});
    this.show('Worlds', createElement('div', {className: 'row'},
      textButton('Empty world', () => {
        this.app.time.callService('clear');
        this.dialog.close();
      }),
      createElement('label', {className: 'file'}, 'Open a file', file)), createElement('div', {className: 'cards'}, ...cards));
  }

  showSave() {
    const name = createElement('input', {value: 'my-world', required: true, maxLength: 64, autocomplete: 'off',
      'aria-label': 'Name of the world'});
    const form = createElement('form', {className: 'row', onsubmit: (/** @type {Event} */ event) => {
      event.preventDefault();
      this.app.connection.send('save', {name: name.value});
      this.dialog.close();
    }}, name, createElement('button', {textContent: 'Save world'}));
    this.show('Save', form, createElement('div', {className: 'row'},
      textButton('Download file', () => this.#download()),
      textButton('Copy link', () => this.#copyLink()),
      textButton('Picture (PNG)', () => this.app.view.canvas.toBlob((png) => png && download('world.png', png)))));
    name.select();
  }

  /** @param {string} name */
  async #open(name) {
    this.dialog.close();
    if ((await this.app.connection.ask('open', {name})).ok) this.app.frameNext();
  }

  /** @param {string} text of a world file */
  async #upload(text) {
    this.dialog.close();
    const {ok, message} = await fetch('/world', {method: 'POST', body: text, headers: {'Content-Type': 'application/yaml'}})
      .then((response) => response.json().catch(() => ({ok: false, message: response.statusText})),
        () => ({ok: false, message: 'Not done: the server is gone'}));
    this.app.notes.showMessage(this.app.words.tell({message}), {ok});
    if (ok) this.app.frameNext();
  }

  /** @returns {Promise<?string>} the world as a file; null where it is refused, as too large */
  async #text() {
    return (await this.app.connection.ask('share')).values.yaml ?? null;
  }

  async #download() {
    const text = await this.#text();
    if (text !== null) download('world.yaml', new Blob([text]));
  }

  async #copyLink() {
    const world = await this.#text();
    if (world === null) return;
    const link = `${location.origin}/#world=${await packText(world)}`;
    if (link.length > LONGEST_LINK) {
      this.app.notes.showMessage('This world is too large for a link: download it as a file.', {ok: false});
      return;
    }
    const text = createElement('input', {value: link, readOnly: true, 'aria-label': 'Link'});
    this.show('A link that holds this world', text);
    text.select();
    await navigator.clipboard?.writeText(link).catch(() => {});
  }

  /** A link only offers its world: whoever sends it does not decide what a class sees. */
  #offerLink() {
    const packed = /^#world=(.+)/.exec(location.hash)?.[1];
    if (!packed || this.app.viewOnly) return;
    history.replaceState(null, '', location.pathname + location.search);
    this.show('This link holds a world', createElement('div', {className: 'row'},
      textButton('Open it', () => this.#openLink(packed))));
  }

  /** @param {string} packed */
  async #openLink(packed) {
    const text = await unpackText(packed).catch(() => null);
    if (text !== null) return this.#upload(text);
    this.dialog.close();
    this.app.notes.showMessage('This link is broken, or its world is too large.', {ok: false});
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
