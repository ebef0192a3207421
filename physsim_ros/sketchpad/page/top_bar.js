// SPDX-License-Identifier: Apache-2.0
/** The bar above: worlds, how the world is shown, and the recording. */

import {createElement, elementOf, iconButton} from './dom.js';
import {showHelp} from './help.js';
import {t} from './strings.js';
import {switchTheme} from './theme.js';

/** @import {App} from './types.js' */

export class TopBar {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    const zoom = createElement('span', {className: 'zoom', 'aria-hidden': true});
    const frame = iconButton(t('Frame the world'), 'fit', () => app.room.frame(), t('Frame the world (F)'));
    frame.append(zoom);
    app.view.overlays.push(() => {
      const share = `${Math.round(100 * app.camera.scale / app.camera.whole)} %`;
      if (zoom.textContent !== share) zoom.textContent = share;
    });
    this.recording = createElement('a', {target: '_blank', rel: 'noopener', hidden: true, className: 'button',
      textContent: 'Rerun', title: t('The recording')});
    elementOf('files', HTMLElement).append(
      iconButton(t('Worlds'), 'worlds', () => app.gallery.openWorlds(), t('Worlds to open')),
      iconButton(t('Save'), 'save', () => app.gallery.showSave(), t('Save, link, picture')));
    elementOf('looks', HTMLElement).append(
      this.#toggle('velocities', t('Show velocities'), 'velocities', t('Velocities as arrows, in m/s')),
      this.#toggle('forces', t('Show forces'), 'forces', t('Forces as arrows, in newtons; on a body that you tap, all')),
      iconButton(t('Material'), 'material', () => {
        app.selection.select([]);
        app.panel.show('world');
      }, t('Material of new bodies; gravity')),
      frame,
      iconButton(t('Light or dark'), 'theme', switchTheme),
      iconButton(t('Help'), 'help', () => showHelp(app), t('Help: keys and gestures (?)')));
    elementOf('looks', HTMLElement).after(this.recording);
    app.connection.on('recording', ({rerun}) => this.#link(rerun));
    app.connection.on('welcome', ({rerun}) => this.#link(rerun));
  }

  /**
   * @param {'velocities' | 'forces'} part of frames
   * @param {string} name
   * @param {string} id of its icon
   * @param {string} title
   */
  #toggle(part, name, id, title) {
    const {app} = this;
    const button = iconButton(name, id, () => {
      const shown = app.arrows[part] = !app.arrows[part];
      button.setAttribute('aria-pressed', String(shown));
      app.arrows.showLegend();
      app.askForParts();
    }, title);
    button.setAttribute('aria-pressed', 'false');
    return button;
  }

  /** @param {string} address of Rerun's page on the machine of the world; '' where it serves none */
  #link(address) {
    const here = ['127.0.0.1', 'localhost', '[::1]'].includes(location.hostname);
    Object.assign(this.recording, {href: address, hidden: !(address && here)});
  }
}
