// SPDX-License-Identifier: Apache-2.0
/** The grid in metres, and rulers whose steps follow the zoom. */

import {fixed, multiplesOf} from '../rounding.js';

/** @import {Point, SceneView} from '../types.js' */

export const RULER = 18; // px: of the ruler at the lower edge
const SIZE = 11, DIGIT = 0.65; // px: size of letters; em: width of a digit

/** @param {SceneView} view */
export function drawGrid({ctx, camera, palette}) {
  const step = camera.gridStep;
  const [left, top] = camera.toWorld(0, 0), [right, bottom] = camera.toWorld(camera.width, camera.height);
  const pixelX = (/** @type {number} */ x) => Math.round(camera.toPage(x, 0)[0]) + 0.5;
  const pixelY = (/** @type {number} */ y) => Math.round(camera.toPage(0, y)[1]) + 0.5;
  ctx.lineWidth = 1;
  for (const [spacing, color] of /** @type {[number, string][]} */ ([[camera.fineStep, palette.minor], [step, palette.major]])) {
    ctx.strokeStyle = color;
    ctx.beginPath();
    for (const x of multiplesOf(spacing, left, right).map(pixelX)) {
      ctx.moveTo(x, 0);
      ctx.lineTo(x, camera.height);
    }
    for (const y of multiplesOf(spacing, bottom, top).map(pixelY)) {
      ctx.moveTo(0, y);
      ctx.lineTo(camera.width, y);
    }
    ctx.stroke();
  }
}

/** @param {SceneView} view at whose insets the rulers lie, on top of bodies; a bar covers no number */
export function drawRulers(view) {
  const {camera, palette, insets} = view, step = camera.gridStep, [size, unit] = step < 1000 ? [1, 'm'] : [1000, 'km'];
  const digits = Math.max(0, -Math.floor(Math.log10(step)));
  const [left, top] = camera.toWorld(insets.left, insets.top), [right, bottom] = camera.toWorld(camera.width - insets.right, camera.height - insets.bottom);
  const textOf = (/** @type {number} */ value) => `${fixed(value / size, digits)} ${unit}`;
  const write = (/** @type {number} */ value, /** @type {Point} */ at, /** @type {CanvasTextAlign} */ align) =>
    view.write(textOf(value), at, palette.faint, align, SIZE);
  const low = camera.height - insets.bottom;
  // Far out numbers are long: only some lines have room for one.
  const wide = SIZE * (2 + DIGIT * Math.max(textOf(left).length, textOf(right).length));
  for (const value of multiplesOf(step * Math.ceil(wide / (step * camera.scale)), left, right)) {
    const [x] = camera.toPage(value, 0);
    if (x > insets.left + 40 && x < camera.width - insets.right - 20) write(value, [x, low - 6], 'center');
  }
  for (const value of multiplesOf(step, bottom, top)) {
    const [, y] = camera.toPage(0, value);
    if (y > insets.top + 14 && y < low - 24) write(value, [insets.left + 6, y - 4], 'left');
  }
}
