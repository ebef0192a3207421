// SPDX-License-Identifier: Apache-2.0
/**
 * The tools of clicks (parameter `tool` of the node), by clicking or by dragging: centre to rim, edge to
 * edge, corner to corner; a tilted rectangle by the ends of a side and then its distance. The unfinished shape
 * follows the pointer.
 */

import {Tool} from './tool.js';
import {degrees, threeDigits} from '../rounding.js';
import {t} from '../strings.js';
import {distance, isTap, onGrid, polar} from '../vectors.js';

/** @import {ClickUse, Parts, Point, SceneView, Touch} from '../types.js' */

/** @typedef {Parts<'camera' | 'connection' | 'world'>} Needed */

const DRAG = 6; // px: a rectangle that is less high or wide is a side
const MARK = 4; // px: radius of a point that was clicked
const CLOSE = 12; // px around the first corner of a polygon
const NEWTONS = 10; // N: of an arrow of 1 m, as in `drawing/tools.py`
const STEP = Math.PI / 12; // rad between the directions of angled lines

/** @extends {Tool<Needed>} */
export class ClickTool extends Tool {
  /**
   * @param {Needed} parts
   * @param {string} id of the tool
   * @param {ClickUse} use
   */
  constructor(parts, id, use) {
    super(parts);
    this.id = id;
    this.use = use;
    this.clicks = use.clicks;
    this.aims = use.aims;
    this.atServer = true;
    /** @type {Touch[]} that were clicked */
    this.points = [];
    /** Where the pointer is, pressed or not. @type {?Touch} */
    this.pointed = null;
    this.begun = false; // whether the first point was clicked where the pointer was pressed
    /** @type {string[]} of this gesture, or of the last one */
    this.requests = [];
    parts.connection.on('answer', ({request, ok}) => {
      if (ok || !request || !this.requests.includes(request)) return;
      // To the server, what was clicked meanwhile begins another gesture.
      if (request !== this.requests.at(-1)) parts.connection.send('drop');
      this.points = [];
    });
  }

  get open() {
    return this.points.length > 0;
  }

  /** @param {Touch} touch */
  begin(touch) {
    this.pointed = touch;
    this.begun = !this.open && this.clicks > 1;
    if (this.begun) this.#click(touch);
  }

  /** @param {Touch} touch */
  move(touch) {
    this.pointed = touch;
  }

  /** @param {Touch} touch */
  point(touch) {
    this.pointed = this.snap(touch);
  }

  /** @param {Touch} touch */
  end(touch) {
    // Its first click was refused.
    if (this.begun && !this.open) return;
    if (this.#isUpright(touch)) this.#click({...touch, at: [touch.at[0], this.points[0].at[1]]});
    if (!this.begun || !isTap(this.path[0], touch)) this.#click(touch);
  }

  cancel() {
    if (this.open) this.parts.connection.send('drop');
    this.points = [];
  }

  /**
   * Close an open polygon, or end a rope.
   * @returns {boolean} whether there was one
   */
  finish() {
    const end = this.#end;
    if (end) this.#click(end);
    return end !== null;
  }

  /** @returns {?Touch} of a polygon its first point, of a rope its newest one: clicked again, it ends the gesture; null where that is too short */
  get #end() {
    const isPolygon = this.id === 'polygon';
    return this.clicks === Infinity && this.points.length > (isPolygon ? 2 : 1) ? this.points.at(isPolygon ? 0 : -1) ?? null : null;
  }

  /**
   * @param {Touch} touch
   * @returns {Touch} on the grid, where the key is held and no body is meant
   */
  snap(touch) {
    if (!touch.grid || this.aims) return touch;
    const {grid} = touch, [first] = this.points;
    let at = onGrid(touch.at, grid);
    if (first && this.points.length === 1 && this.use.angled) {
      const dx = touch.at[0] - first.at[0], dy = touch.at[1] - first.at[1];
      if (this.#isUpright(touch)) {
        // A square.
        const side = Math.round(Math.max(Math.abs(dx), Math.abs(dy)) / grid) * grid;
        at = [first.at[0] + Math.sign(dx) * side, first.at[1] + Math.sign(dy) * side];
      } else {
        const length = Math.round(Math.hypot(dx, dy) / grid) * grid, angle = Math.round(Math.atan2(dy, dx) / STEP) * STEP;
        const [across, up] = polar(length, angle);
        at = [first.at[0] + across, first.at[1] + up];
      }
    }
    return {...touch, at, page: this.parts.camera.toPage(...at)};
  }

  /**
   * @param {Touch} touch
   * @returns {boolean} whether a rectangle is drawn from corner to corner
   */
  #isUpright({page: [px, py]}) {
    const [x, y] = this.start?.page ?? [px, py];
    return this.id === 'rectangle' && this.points.length === 1 && this.path.length > 0 && Math.min(Math.abs(px - x), Math.abs(py - y)) > DRAG;
  }

  /** @param {Touch} touch */
  #click(touch) {
    const {parts: {camera, connection}, points} = this;
    const end = this.#end && distance(touch.page, camera.toPage(...this.#end.at)) < CLOSE ? this.#end : null;
    if (!this.open) this.requests = [];
    const request = connection.send('click', {tool: this.id, point: end && this.id === 'polygon' ? end.at : this.#meant(end ?? touch)});
    this.requests.push(request);
    this.points = request && !end && points.length + 1 < this.clicks ? [...points, touch] : [];
  }

  /**
   * @param {Touch} touch
   * @returns {Point} of a tool for bodies, in the body that a finger beside it means [m]
   */
  #meant({at, slop}) {
    const {world} = this.parts, ofBody = this.aims && !this.points.length || this.use.joins;
    const row = ofBody ? world.bodyAt(at, slop) : -1;
    return row < 0 ? at : world.place(row, world.gripOn(row, at));
  }

  /** @param {SceneView} view */
  draw(view) {
    if (!this.open || !this.pointed) return;
    const color = view.palette.accent, points = [...this.points.map(({at}) => at), this.pointed.at];
    if (this.#isUpright(this.pointed)) points.splice(1, 0, [points[1][0], points[0][1]]);
    const [p, q, r] = points;
    const length = distance(p, q);
    if (this.id === 'circle') view.ring(p, length * view.camera.scale, color);
    else if (this.id === 'circle_diameter') {
      view.ring([(p[0] + q[0]) / 2, (p[1] + q[1]) / 2], length / 2 * view.camera.scale, color);
    } else if (this.id === 'rectangle' && r && length > 0) {
      const ux = (q[0] - p[0]) / length, uy = (q[1] - p[1]) / length;
      const height = ux * (r[1] - p[1]) - uy * (r[0] - p[0]), dx = -uy * height, dy = ux * height;
      view.line([p, q, [q[0] + dx, q[1] + dy], [p[0] + dx, p[1] + dy], p], color);
    } else if (this.use.arrow) view.arrow(view.camera.toPage(...p), view.camera.toPage(...q), color);
    else view.line(points, color);
    // A finger that is lifted leaves nothing else.
    for (const {at} of this.points) view.ring(at, MARK, color);
    if (this.id === 'polygon') view.ring(p, CLOSE, color);
    view.writeBeside(this.#sizeText(points), this.pointed);
  }

  /**
   * @param {Point[]} points [m]
   * @returns {string} what the gesture measures up to now
   */
  #sizeText(points) {
    const [p, q, r] = points, [a, b] = points.slice(-2);
    const side = distance(p, q), length = distance(a, b);
    if (!length) return '';
    const angle = degrees(Math.atan2(b[1] - a[1], b[0] - a[0]), 0);
    switch (this.id) {
      case 'circle': return t('radius {length} m', {length: threeDigits(length)});
      case 'circle_diameter': return t('diameter {length} m', {length: threeDigits(length)});
      case 'velocity': return `${threeDigits(length)} m/s, ${angle}`;
      case 'force': return `${threeDigits(NEWTONS * length)} N, ${angle}`;
      case 'gravity': return angle;
      case 'rectangle': if (r && side) {
        const across = Math.abs((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])) / side;
        return `${threeDigits(side)} × ${threeDigits(across)} m`;
      }
      // falls through: one side of a rectangle is a line
      default: return `${threeDigits(length)} m, ${angle}`;
    }
  }
}
