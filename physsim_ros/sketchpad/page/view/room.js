// SPDX-License-Identifier: Apache-2.0
/**
 * Where the world lies on the page: in the room that bars and panels leave (the cell `#room` of the grid of style.css).
 *
 * The world is framed there when a panel would cover what is to be seen, and when somebody closes one, unless the view
 * was moved; not in the midst of a gesture, but at its end. Where something closes by itself, the view stays: a drawing
 * goes on at the same scale. What was drawn meanwhile, and is in sight, stays in sight.
 */

import {elementOf} from '../dom.js';
import {unionOf} from './body_path.js';

/** @import {Bounds, Parts} from '../types.js' */

const BARS = '#tools, #top > .bar, #bar, #lesson, #panel, #plot'; // what may cover the world
const FLAT = 1.6; // width of what is framed to its height, from which on the plot lies below it

/** @returns {boolean} whether a panel in full leaves room for the world, as style.css has it */
export function isRoomy() {
  return Number(getComputedStyle(document.documentElement).getPropertyValue('--roomy')) === 1;
}

export class Room {
  /** @param {Parts<'camera' | 'connection' | 'cursor' | 'pointers' | 'selection' | 'view' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    this.element = elementOf('room');
    this.framed = false;
    this.world = ''; // bounds of the world that was framed, and its view; a world with others is framed again
    /** @type {Bounds} that was framed */
    this.extent = [0, 0, 0, 0];
    this.late = false; // whether the world is framed when the gesture ends
    parts.view.overlays.push(() => {
      if (this.late && !this.parts.pointers.isBusy) this.fit();
    });
    new ResizeObserver(() => this.fit()).observe(parts.view.canvas);
    new ResizeObserver(() => this.#follow()).observe(this.element);
    parts.connection.on('frame', () => {
      if (!this.framed || this.#worldNow !== this.world && parts.camera.fitted) this.frame();
    });
  }

  get #worldNow() {
    const {bounds, lesson} = this.parts.world.scene;
    return `${bounds} ${lesson?.view ?? ''}`;
  }

  /** @returns {{left: number, top: number, right: number, bottom: number}} what is covered at each edge [px] */
  get #insets() {
    const {left, top, right, bottom} = this.element.getBoundingClientRect();
    return {left, top, right: innerWidth - right, bottom: innerHeight - bottom};
  }

  /** Frame the bounds of the world, and every body: it may have been dragged beyond them. */
  frameAll() {
    const {world} = this.parts;
    this.frame(unionOf([world.extent(), ...world.boxes]));
  }

  /**
   * Frame a part of the world.
   * @param {Bounds} extent
   */
  frame(extent = this.parts.world.extent()) {
    const {parts} = this;
    this.extent = extent;
    this.framed = parts.camera.fitted = true;
    this.world = this.#worldNow;
    this.#arrange();
  }

  /** Frame the world that comes next, in which nothing is selected. */
  frameNext() {
    this.framed = false;
    this.parts.cursor.hide();
    this.parts.selection.select([]);
  }

  /** Fit what was framed, and what is in sight, into the room. */
  fit() {
    const {camera, view, world} = this.parts, {left, top, right, bottom} = view.insets;
    if (camera.fitted && this.framed) {
      const [xmin, ymax] = camera.toWorld(left, top), [xmax, ymin] = camera.toWorld(camera.width - right, camera.height - bottom);
      this.extent = unionOf([this.extent, world.boundsWithin([xmin, ymin, xmax, ymax])]);
    }
    this.#arrange();
  }

  /** Fit the world into a room that has become too small for it; one that has become larger shows more of the world. */
  #follow() {
    const {view} = this.parts, before = view.insets, now = this.#insets;
    if (now.left <= before.left && now.top <= before.top && now.right <= before.right && now.bottom <= before.bottom) view.insets = now;
    else if (this.#isCovered()) this.fit();
  }

  /** @returns {boolean} whether a bar or a panel lies on what is to be seen: what a lesson shows first, else the bodies */
  #isCovered() {
    const {camera, world} = this.parts, {lesson} = world.scene, bars = [...document.querySelectorAll(BARS)].map((bar) => bar.getBoundingClientRect());
    return (lesson?.view ? [lesson.view] : world.boxes).some(([xmin, ymin, xmax, ymax]) => {
      const [left, top] = camera.toPage(xmin, ymax), [right, low] = camera.toPage(xmax, ymin);
      return bars.some((bar) => bar.width && bar.left < right && left < bar.right && bar.top < low && top < bar.bottom);
    });
  }

  #arrange() {
    const {camera, view} = this.parts, [xmin, ymin, xmax, ymax] = this.extent;
    document.body.classList.toggle('wide', xmax - xmin > FLAT * (ymax - ymin));
    view.insets = this.#insets;
    view.redraw();
    this.late = camera.fitted && this.parts.pointers.isBusy;
    if (!camera.fitted || this.late) return;
    const {left, top, right, bottom} = view.insets, gaps = getComputedStyle(this.element);
    camera.fit(this.extent, {left: left + parseFloat(gaps.paddingLeft), top: top + parseFloat(gaps.paddingTop),
      right: right + parseFloat(gaps.paddingRight), bottom: bottom + parseFloat(gaps.paddingBottom)});
  }
}
