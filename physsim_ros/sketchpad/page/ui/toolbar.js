// SPDX-License-Identifier: Apache-2.0
/**
 * The bars of buttons: the tools at the left; above, worlds and how the world is shown. Tab reaches a bar once, and
 * arrow keys move within it (WAI-ARIA, pattern *Toolbar*).
 */

import {createElement, elementOf, iconButton, showText, toggling} from '../dom.js';
import {switchTheme} from '../view/theme.js';
import {t} from '../strings.js';
import {TOOLS} from '../tools/tools.js';

/** @import {Gallery, GalleryParts} from './gallery.js' */
/** @import {Parts, Tool, ToolParts} from '../types.js' */

const FEW = ['hand', 'ruler', 'protractor', 'predict', 'note']; // tools that a lesson needs

export class Toolbar {
  /** @param {ToolParts & Parts<'pointers' | 'room'>} parts */
  constructor(parts) {
    this.parts = parts;
    /** @type {Map<string, {tool: Tool, button: HTMLButtonElement, hint: string}>} by id */
    this.tools = new Map();
    this.bar = elementOf('tools');
    this.few = false; // those alone are shown
    for (const group of TOOLS) {
      const box = createElement('div', {role: 'group'});
      for (const {id, name, keyName, hint, make} of group) {
        const button = iconButton(name, id, () => this.selectTool(id), `${name} (${keyName}): ${hint}`);
        this.tools.set(id, {tool: make(parts), button, hint: `${name}: ${hint}.`});
        box.append(button);
      }
      this.bar.append(box);
    }
    this.more = iconButton(t('All tools'), 'pen', () => this.showFew(false), t('All tools (5): to draw and to join'));
    this.bar.lastElementChild?.append(iconButton(t('Measure'), 'measure', () => parts.selection.show('measure'), t('Stopwatch with gates, counter of collisions')), this.more);
    this.#select('pen');
    this.showFew(false);
    parts.connection.on('world', () => this.#suit());
    parts.connection.on('scene', ({lesson}) => Boolean(lesson) === Boolean(this.lesson) || this.#suit());
  }

  /** Show the tools that the world needs: those of a lesson, or all. */
  #suit() {
    const {lesson} = this.parts.world.scene;
    this.lesson = lesson;
    this.showFew(Boolean(lesson));
    this.#select(lesson ? 'hand' : 'pen');
  }

  /** @param {boolean} few whether the tools of a lesson alone are shown */
  showFew(few) {
    this.few = few;
    this.bar.classList.toggle('few', few);
    this.more.hidden = !few;
    for (const [id, {button}] of this.tools) button.hidden = few && !FEW.includes(id);
    for (const group of this.bar.children) if (group instanceof HTMLElement) group.hidden = [...group.children].every((each) => each instanceof HTMLElement && each.hidden);
    this.parts.room.fit();
  }

  /**
   * Select a tool, and say how it is used.
   * @param {string} id
   */
  selectTool(id) {
    if (this.tools.get(id)?.button.hidden) this.showFew(false);
    this.#select(id);
    this.parts.hints.showTool(id, this.tools.get(id)?.hint ?? '');
  }

  /** @param {string} id */
  #select(id) {
    const selected = this.tools.get(id);
    if (!selected) return;
    this.parts.pointers.take(selected.tool);
    this.parts.view.canvas.dataset.tool = id;
    for (const [each, {button}] of this.tools) button.setAttribute('aria-pressed', String(each === id));
  }
}

export class TopBar {
  /** @param {GalleryParts & Parts<'arrows' | 'camera' | 'connection' | 'room' | 'selection' | 'settings' | 'view'>} parts */
  constructor(parts) {
    this.parts = parts;
    /** @type {?Gallery} null until it is asked for */
    this.gallery = null;
    const zoom = createElement('span', {className: 'zoom'});
    parts.view.overlays.push(() => showText(zoom, `${Math.round(100 * parts.camera.scale / parts.camera.whole)} %`));
    this.recording = createElement('a', {target: '_blank', rel: 'noopener', hidden: true, className: 'button',
      textContent: 'Rerun', title: t('The recording')});
    elementOf('files').append(
      iconButton(t('Worlds'), 'worlds', () => this.#openGallery((gallery) => gallery.openWorlds()), t('Worlds to open')),
      iconButton(t('Save'), 'save', () => this.#openGallery((gallery) => gallery.showSave()), t('Save, link, picture')));
    elementOf('looks').append(
      this.#toggle('velocities', t('Show velocities'), 'velocities', t('Velocities as arrows, in m/s')),
      this.#toggle('forces', t('Show forces'), 'forces', t('Forces as arrows, in newtons; on a body that you tap, all')),
      iconButton(t('Material'), 'material', () => parts.selection.show('world'), t('Material of new bodies; gravity')),
      iconButton(t('Frame the world'), 'fit', () => parts.room.frameAll(), t('Frame the world (F)')), zoom,
      iconButton(t('Light or dark'), 'theme', switchTheme),
      iconButton(t('Help'), 'help', () => parts.settings.showHelp(), t('Help: keys and gestures (?)')));
    elementOf('looks').after(this.recording);
    parts.connection.on('recording', ({rerun}) => this.#link(rerun));
    parts.connection.on('welcome', ({rerun}) => this.#link(rerun));
  }

  /** @param {(gallery: Gallery) => void} work */
  #openGallery(work) {
    const {parts} = this;
    parts.notes.load(import('./gallery.js'), ({Gallery: Worlds}) => work(this.gallery ??= new Worlds(parts)));
  }

  /**
   * @param {'velocities' | 'forces'} what is shown
   * @param {string} name
   * @param {string} id of its icon
   * @param {string} title
   */
  #toggle(what, name, id, title) {
    const {parts} = this;
    return toggling(iconButton(name, id, () => {}, title), () => parts.arrows[what], () => parts.arrows.toggle(what));
  }

  /** @param {string} address of Rerun's page on the machine of the world; '' where it serves none */
  #link(address) {
    const here = ['127.0.0.1', 'localhost', '[::1]'].includes(location.hostname);
    Object.assign(this.recording, {href: address, hidden: !(address && here)});
  }
}

/** Directions of keys on the page. @type {Record<string, [number, number]>} */
export const ARROWS = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
const ASIDE = 3; // weight of the distance across the direction of an arrow key

/**
 * @param {HTMLElement} bar whose buttons may come and go
 * @param {string} first selector of the button that Tab reaches at first
 */
export function makeToolbar(bar, first = 'button') {
  bar.setAttribute('role', 'toolbar');
  const items = () => [...bar.querySelectorAll('button')].filter((each) => each.checkVisibility());
  /** @type {Element | null} */
  let current = null;
  const rove = (/** @type {Element | null} */ to = bar.querySelector(first)) => {
    current = to;
    for (const each of bar.querySelectorAll('button')) each.tabIndex = each === to ? 0 : -1;
  };
  bar.addEventListener('focusin', ({target}) => target instanceof HTMLButtonElement && rove(target));
  bar.addEventListener('keydown', (event) => {
    const all = items(), from = all.find((each) => each === event.target), {key} = event;
    const to = key === 'Home' ? all[0] : key === 'End' ? all.at(-1) : from && key in ARROWS ? nextOf(all, from, ARROWS[key]) : undefined;
    if (!to || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    to.focus();
  });
  // The one that Tab reaches may be taken away or hidden.
  new MutationObserver(() => current?.isConnected && current.checkVisibility() ? rove(current) : rove(items()[0]))
    .observe(bar, {childList: true, subtree: true, attributeFilter: ['hidden']});
  rove();
}

/**
 * @param {HTMLButtonElement[]} all
 * @param {HTMLButtonElement} from
 * @param {[number, number]} direction
 * @returns {HTMLButtonElement | undefined} the next one in that direction; undefined where there is none
 */
function nextOf(all, from, [dx, dy]) {
  const [x, y] = centreOf(from);
  let least = Infinity, next;
  for (const each of all) {
    const [toX, toY] = centreOf(each), along = (toX - x) * dx + (toY - y) * dy;
    const far = along + ASIDE * Math.abs((toX - x) * dy - (toY - y) * dx);
    if (along > 1 && far < least) [least, next] = [far, each];
  }
  return next;
}

/** @param {Element} element */
function centreOf(element) {
  const {left, top, width, height} = element.getBoundingClientRect();
  return [left + width / 2, top + height / 2];
}
