// SPDX-License-Identifier: Apache-2.0
/**
 * Inclined planes: anchored right triangles that stand on a horizontal side. The tool draws one along its slope; the
 * panel of any body of that form has its angle and length.
 */

import {labelled, numberField} from '../dom.js';
import {Tool} from './tool.js';
import {digits} from '../rounding.js';
import {t} from '../strings.js';
import {DEGREE, isTap, onGrid, polar} from '../vectors.js';

/** @import {Body, Parts, Point, SceneView, Touch} from '../types.js' */

/** @typedef {Parts<'camera' | 'connection' | 'people' | 'selection' | 'world'>} Needed */

/**
 * @typedef {{foot: Point, side: number, angle: number, length: number}} Incline foot: lower end of the slope [m]; side: 1
 *   where it rises to the right, -1 to the left; angle [°]; length of the slope [m]
 */

const USUAL = {side: 1, angle: 30, length: 4}; // of a tap
const STEEPEST = 89, ROUGH = 15; // °: the greatest angle that is drawn, and steps while the key of the grid is held
const NEAR = 12; // px: a foot that near to a floor stands on it
const STRAIGHT = 1e-3; // share of a side by which it may be out of the level or the vertical

/** @extends {Tool<Needed>} */
export class InclineTool extends Tool {
  /** @param {Needed} parts */
  constructor(parts) {
    super(parts);
    this.fresh = ''; // name of the plane that is selected as soon as it is there
    parts.connection.on('scene', ({bodies}) => {
      if (!bodies.some((/** @type {Body} */ {name}) => name === this.fresh)) return;
      const {fresh} = this;
      this.fresh = '';
      queueMicrotask(() => parts.selection.select([fresh]));
    });
  }

  /** @param {Touch} touch */
  async end(touch) {
    const {parts} = this;
    this.fresh = parts.people.freeName('incline');
    const {ok} = await parts.connection.ask('spawn', {body: {name: this.fresh, anchored: true, ...shapeOf(this.#drawn(this.path[0], touch))}});
    if (!ok) this.fresh = '';
  }

  /**
   * @param {Touch} start
   * @param {Touch} end
   * @returns {Incline} between them, in whole degrees; it stands on a floor that is near
   */
  #drawn(start, end) {
    const {world, camera} = this.parts, incline = this.#between(start, end), {foot} = incline;
    return end.grid ? incline : {...incline, foot: [foot[0], world.floorBy(foot, NEAR / camera.scale)]};
  }

  /**
   * @param {Touch} start
   * @param {Touch} end
   * @returns {Incline}
   */
  #between(start, end) {
    const [x, y] = onGrid(start.at, start.grid);
    if (isTap(start, end)) return {foot: [x, y], ...USUAL};
    const dx = end.at[0] - x, dy = end.at[1] - y, turn = end.grid ? ROUGH : 1, step = end.grid || this.parts.camera.fineStep / 4;
    const degrees = Math.round(Math.atan2(Math.abs(dy), Math.abs(dx)) / DEGREE / turn) * turn;
    const angle = Math.min(Math.max(degrees, turn), STEEPEST), length = Math.max(Math.round(Math.hypot(dx, dy) / step), 1) * step;
    const [across, up] = polar(length, angle * DEGREE), right = dx < 0 ? -1 : 1;
    // It may be drawn down its slope, too.
    return dy < 0 ? {foot: [x + right * across, y - up], side: -right, angle, length} : {foot: [x, y], side: right, angle, length};
  }

  /** @param {SceneView} view */
  draw(view) {
    if (!this.start || !this.last) return;
    const incline = this.#drawn(this.start, this.last), {polygon: [p, q, r]} = shapeOf(incline), [x, y] = incline.foot;
    const corners = [p, q, r, p].map(([px, py]) => /** @type {Point} */ ([x + px, y + py]));
    view.line(corners, view.palette.accent);
    view.writeBeside(`${digits(incline.angle, 5)}°, ${digits(incline.length, 5)} m`, this.last);
  }
}

/**
 * @param {Parts<'connection' | 'notes' | 'world'>} parts
 * @param {Body} body
 * @param {() => void} render the panel again
 * @returns {HTMLElement[]} fields for angle and length, where the body is an inclined plane; its foot stays
 */
export function inclineFields(parts, {name, shape}, render) {
  const now = () => {
    const row = parts.world.row(name), {scene} = parts.world;
    return row < 0 || shape.kind !== 'polygon' ? null : inclineOf(scene.bodies[row].shape.outline.map((point) => parts.world.place(row, point)));
  };
  const shown = now();
  if (!shown) return [];
  const field = (/** @type {string} */ label, /** @type {'angle' | 'length'} */ key) => labelled(label, numberField(shown[key], (value) => {
    const incline = {...now() ?? shown, [key]: value ?? 0}, {angle, length} = incline;
    if (angle > 0 && angle < 90 && length > 0) parts.connection.send('spawn', {body: {name, ...shapeOf(incline)}});
    else {
      parts.notes.showMessage(t('The angle of a slope lies between 0° and 90°, and its length is not 0'), {ok: false});
      render();
    }
  }, {inputMode: 'decimal'}));
  return [field(t('Angle of the slope [°]'), 'angle'), field(t('Length of the slope [m]'), 'length')];
}

/**
 * @param {Incline} incline
 * @returns {{polygon: Point[], at: number[]}} of its body, as in a world file
 */
function shapeOf({foot, side, angle, length}) {
  const [across, up] = polar(length, angle * DEGREE);
  return {polygon: [[0, 0], [side * across, 0], [side * across, up]], at: [...foot, 0]};
}

/**
 * @param {Point[]} corners of a polygon in the world [m]
 * @returns {?Incline} null where it is none
 */
function inclineOf(corners) {
  if (corners.length !== 3) return null;
  for (const [x, y] of corners) {
    const foot = corners.find((each) => each[0] !== x && Math.abs(each[1] - y) <= STRAIGHT * Math.abs(each[0] - x));
    const top = corners.find((each) => each[1] > y && Math.abs(each[0] - x) <= STRAIGHT * (each[1] - y));
    if (!foot || !top) continue;
    const across = x - foot[0], up = top[1] - y;
    return {foot, side: Math.sign(across), angle: Math.atan2(up, Math.abs(across)) / DEGREE, length: Math.hypot(across, up)};
  }
  return null;
}
