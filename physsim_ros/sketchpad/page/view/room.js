// SPDX-License-Identifier: Apache-2.0
/**
 * Where the world lies on the page: in the rectangle in which it is largest and which no panel covers. The
 * legend of arrows, the plot and notes without a place are docked to the edges of that rectangle.
 *
 * The world is framed there when a panel opens, closes or changes its size, unless somebody has moved the view; not in
 * the midst of a gesture, but at its end. What was drawn meanwhile, and is in sight, stays in sight.
 */

import {elementOf} from '../dom.js';
import {unionOf} from './body_path.js';

/** @import {App, Bounds} from '../types.js' */

/** @typedef {{left: number, top: number, right: number, bottom: number}} Box [px] */

const GAP = 24, SMALL_GAP = 12; // px between the edges of the room and the world, and on a small page
const LOW = 500, WIDE = 1000; // px: a page that is lower or less wide has no room for panels in full
const LABELS = 10; // px more, for the heights at the left
const DOCKED = 8; // px between the room and what is docked in it
/** Least and greatest size of the plot, beside the world and below it [px]. */
const PLOT = {width: [260, 640], height: [200, 420]};

export class Room {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.framed = false;
    this.bounds = ''; // of the world that was framed; a world with other bounds is framed again
    /** @type {Bounds} that was framed */
    this.extent = [0, 0, 0, 0];
    this.late = false; // whether the world is framed when the gesture ends
    app.view.overlays.push(() => {
      if (this.late && !this.#isInGesture) this.fit();
    });
    const bar = elementOf('bar'), top = elementOf('top');
    const sizes = new ResizeObserver(() => {
      document.documentElement.style.setProperty('--bar', `${bar.offsetHeight}px`);
      document.documentElement.style.setProperty('--top', `${top.offsetHeight}px`);
      this.fit();
    });
    for (const each of [bar, top, elementOf('lesson'), elementOf('card'), app.view.canvas]) sizes.observe(each, {box: 'border-box'});
    app.connection.on('frame', () => {
      const {frame, scene} = app.world, others = String(scene.bounds) !== this.bounds;
      if (frame.epoch === scene.epoch && (!this.framed || others && app.camera.fitted)) this.frame();
    });
  }

  /** @returns {boolean} whether a panel in full leaves room for the world */
  get isRoomy() {
    return innerWidth >= WIDE && innerHeight >= LOW;
  }

  get #isInGesture() {
    const {pointers, tool} = this.app;
    return pointers?.down.size > 0 || tool.open === true;
  }

  /** Frame the bounds of the world, and every body: it may have been dragged beyond them. */
  frameAll() {
    const {world} = this.app;
    this.frame(unionOf([world.extent(), world.bodiesExtent()]));
  }

  /**
   * Frame a part of the world.
   * @param {Bounds} extent
   */
  frame(extent = this.app.world.extent()) {
    const {app} = this;
    this.extent = extent;
    this.framed = app.camera.fitted = true;
    this.bounds = String(app.world.scene.bounds);
    this.#arrange();
  }

  /** Frame the world that comes next, in which nothing is selected. */
  frameNext() {
    this.framed = false;
    this.app.cursor.hide();
    this.app.selection.select([]);
  }

  /** Fit what was framed, and what is in sight, into the room. */
  fit() {
    const {camera, view, world} = this.app, {left, top, right, bottom} = view.insets;
    if (camera.fitted && this.framed) {
      const [xmin, ymax] = camera.toWorld(left, top), [xmax, ymin] = camera.toWorld(camera.width - right, camera.height - bottom);
      this.extent = unionOf([this.extent, world.boundsWithin([xmin, ymin, xmax, ymax])]);
    }
    this.#arrange();
  }

  /** Fit what is to be framed into the room, and dock legend and plot there. */
  #arrange() {
    const {camera, view} = this.app, [xmin, ymin, xmax, ymax] = this.extent;
    const gap = this.isRoomy ? GAP : SMALL_GAP;
    /** How large the world is in a room [px/m]. */
    const scaleIn = (/** @type {Box} */ {left, top, right, bottom}) => Math.min(
      (right - left - 2 * gap - LABELS) / (xmax - xmin || 1), (bottom - top - 2 * gap) / (ymax - ymin || 1));
    const plot = elementOf('plot'), page = {left: 0, top: 0, right: camera.width, bottom: camera.height};
    const room = largestRoom(page, this.#covered(), plot.hidden ? scaleIn : (each) => Math.max(...besidePlot(each).map(scaleIn)));
    if (!plot.hidden) dockPlot(plot, room, scaleIn);
    dockLegend(room);
    for (const [name, pixels] of Object.entries({ceiling: room.top, middle: (room.left + room.right) / 2, room: room.right - room.left})) {
      document.documentElement.style.setProperty(`--${name}`, `${pixels}px`);
    }
    view.insets = {left: room.left, top: room.top, right: camera.width - room.right, bottom: camera.height - room.bottom};
    view.dirty = true;
    this.late = camera.fitted && this.#isInGesture;
    if (camera.fitted && !this.late) {
      const {left, top, right, bottom} = view.insets;
      camera.fit(this.extent, {left: left + gap + LABELS, top: top + gap, right: right + gap, bottom: bottom + gap});
    }
  }

  /** @returns {Box[]} what panels and bars cover */
  #covered() {
    const {camera, viewOnly} = this.app, shown = viewOnly ? ['bar', 'lesson'] : ['top', 'tools', 'bar', 'lesson', 'panel', 'card'];
    return shown.map((id) => elementOf(id)).filter(({hidden}) => !hidden).map((element) => {
      const {left, top, right, bottom} = element.getBoundingClientRect();
      // Bars reach to their edges of the page. So does a panel that folds while time runs: the view stays.
      if (element.id === 'top') return {left, top: 0, right: camera.width, bottom};
      if (element.id === 'bar' && !viewOnly) return {left: 0, top, right: camera.width, bottom: camera.height};
      if (element.id === 'tools' && bottom - top > right - left) return {left: 0, top: 0, right, bottom: camera.height};
      if (element.id === 'panel' && this.isRoomy) return {left, top, right: camera.width, bottom: camera.height};
      return {left, top, right, bottom};
    });
  }
}

/**
 * @param {Box} page
 * @param {Box[]} covered
 * @param {(room: Box) => number} scaleIn how large the world is in a room
 * @returns {Box} the free one in which it is largest
 */
function largestRoom(page, covered, scaleIn) {
  let best = page, most = 0;
  const areaOf = (/** @type {Box} */ {left, top, right, bottom}) => (right - left) * (bottom - top);
  for (const left of [page.left, ...covered.map((box) => box.right)]) {
    for (const right of [page.right, ...covered.map((box) => box.left)]) {
      for (const top of [page.top, ...covered.map((box) => box.bottom)]) {
        for (const bottom of [page.bottom, ...covered.map((box) => box.top)]) {
          const room = {left, top, right, bottom}, scale = scaleIn(room);
          if (!(scale > 0) || scale < most || scale === most && areaOf(room) <= areaOf(best)) continue;
          if (covered.some((box) => box.left < right && left < box.right && box.top < bottom && top < box.bottom)) continue;
          [best, most] = [room, scale];
        }
      }
    }
  }
  return best;
}

/**
 * @param {Box} room
 * @returns {Box[]} what a plot leaves of it: at its right edge, and at its lower edge
 */
function besidePlot(room) {
  const half = (/** @type {number} */ length, /** @type {number[]} */ [least, most]) => Math.min(Math.max(length / 2, least), most);
  return [{...room, right: room.right - half(room.right - room.left, PLOT.width)}, {...room, bottom: room.bottom - half(room.bottom - room.top, PLOT.height)}];
}

/**
 * Dock the plot at the right or at the lower edge of a room: where it leaves more to the world.
 * @param {HTMLElement} plot
 * @param {Box} room that becomes smaller
 * @param {(room: Box) => number} scaleIn
 */
function dockPlot(plot, room, scaleIn) {
  const [beside, above] = besidePlot(room), isBeside = scaleIn(beside) > scaleIn(above);
  const {left, top, right, bottom} = isBeside ? {...room, left: beside.right} : {...room, top: above.bottom};
  Object.assign(plot.style, {left: `${left + DOCKED}px`, top: `${top + DOCKED}px`,
    width: `${right - left - 2 * DOCKED}px`, height: `${bottom - top - 2 * DOCKED}px`});
  Object.assign(room, isBeside ? beside : above);
}

/** @param {Box} room at whose upper edge the legend is docked */
function dockLegend(room) {
  const legend = elementOf('legend');
  if (legend.hidden) return;
  Object.assign(legend.style, {left: `${room.left + DOCKED}px`, top: `${room.top + DOCKED}px`, maxWidth: `${room.right - room.left - 2 * DOCKED}px`});
  room.top += legend.offsetHeight + DOCKED;
}
