// SPDX-License-Identifier: Apache-2.0
/** The notice that the server does not answer, with what the page does when it is lost, is back, or is another version. */

import {elementOf} from '../dom.js';
import {t} from '../strings.js';

/** @import {Parts} from '../types.js' */

const SILENT = t('The server does not answer. This page comes back with it, and sends what you draw.');

export class ServerNotice {
  /** @param {Parts<'connection' | 'dialog' | 'notes' | 'people' | 'pointers'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.element = elementOf('gone');
    this.away = false; // without a socket
    let known = ''; // version of the server
    const {connection, notes} = parts;
    connection.on('welcome', ({version}) => {
      // These scripts come from another version of the server.
      if (version !== (known ||= version)) location.reload();
    });
    for (const type of ['open', 'heard']) connection.on(type, () => this.#hide());
    connection.on('silent', () => this.#show(SILENT));
    connection.on('again', ({sent, lost}) => {
      // Beside the answers to what is sent again.
      if (lost) notes.dock([t('Connected again. Of what you did meanwhile, {count} may be lost.', {count: lost})]);
      else if (sent) notes.showMessage(t('Connected again. What you did meanwhile is sent now.'));
    });
    connection.on('leave', () => this.#leave());
    connection.on('closed', ({status, opened}) => this.#close(status, opened));
  }

  /** @param {string} text */
  #show(text) {
    this.element.hidden = false;
    this.element.textContent = text;
  }

  #hide() {
    this.away = false;
    if (!this.element.hidden) this.parts.notes.showMessage(t('Connected again'));
    this.element.hidden = true;
  }

  #leave() {
    const {connection, dialog, people, pointers} = this.parts;
    if (people.teacher || people.viewOnly) return;
    pointers.cancelAll();
    connection.leave();
    dialog.close();
    for (const each of document.querySelectorAll('body > *')) each.toggleAttribute('inert', each !== this.element);
    this.#show(t('Your teacher has freed this seat. To come back, open the address of the class.'));
  }

  /**
   * @param {number} status of the answer to the request after that; 0 where there was none
   * @param {boolean} opened whether the socket was open before
   */
  #close(status, opened) {
    const {pointers} = this.parts;
    // The server forgets the gestures that it knows of; a stroke is drawn to its end.
    if (!this.away && pointers.tool.atServer) pointers.cancelAll();
    this.away = true;
    this.#show(status === 401 || status === 403 ? t('Wrong token: open the address that the node printed.') :
      !status ? SILENT : opened ? t('Connecting again …') : t('The server refused this page; trying again …'));
  }
}
