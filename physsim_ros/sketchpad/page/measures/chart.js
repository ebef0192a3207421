// SPDX-License-Identifier: Apache-2.0
/** Charts: axes with round steps, and curves, on a canvas. */

import {digits, multiplesOf, roundUp} from '../rounding.js';

/** @import {Palette} from '../types.js' */

export const EVERY = 80; // ms between pictures of a plot
/** @typedef {{points: number[][], color: string, width: number, alpha?: number, dash?: number[]}} Curve */
/** @typedef {{x: (value: number) => number, y: (value: number) => number}} Scales from values to pixels */

const MARGIN = 0.12; // share of the heights that stays free above and below
const RATIO = 2; // pixels of the canvas to one of the page

/**
 * @param {HTMLCanvasElement} canvas
 * @param {{width: number, height: number, size: number, xLabel: string, yLabel: string, range: number[],
 *   curves: Curve[], behind?: Curve[], room?: number[][], mark?: number, palette: Palette}} what  size: of the font [px];
 *   range: of x; behind: curves that the axes do not follow; room: points that they do
 * @returns {Scales}
 */
export function drawChart(canvas, {width, height, size, xLabel, yLabel, range, curves, behind = [], room = [], mark, palette}) {
  const ctx = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  if (canvas.width !== RATIO * width) canvas.width = RATIO * width;
  if (canvas.height !== RATIO * height) canvas.height = RATIO * height;
  const [least, most] = heightsOf([...curves, {points: room}]), [start, end] = range;
  const left = 3.6 * size, right = width - size / 2, top = 1.5 * size, bottom = height - 1.4 * size;
  const scales = {
    x: (/** @type {number} */ value) => left + (right - left) * (value - start) / (end - start),
    y: (/** @type {number} */ value) => bottom - (bottom - top) * (value - least) / (most - least),
  };
  ctx.setTransform(RATIO, 0, 0, RATIO, 0, 0);
  ctx.clearRect(0, 0, width, height);
  ctx.font = `${size}px system-ui, sans-serif`;
  ctx.fillStyle = palette.ink;
  ctx.textAlign = 'left';
  ctx.fillText(yLabel, 0, size * 0.95);
  ctx.textAlign = 'right';
  ctx.strokeStyle = palette.major;
  ctx.fillStyle = palette.faint;
  ctx.lineWidth = 1;
  const line = (/** @type {number[][]} */ points) => {
    ctx.beginPath();
    for (const [x, y] of points) ctx.lineTo(x, y);
    ctx.stroke();
  };
  for (const value of multiplesOf(roundUp((most - least) * 2.2 * size / (bottom - top)), least, most)) {
    line([[left, scales.y(value)], [right, scales.y(value)]]);
    ctx.fillText(digits(value, 4), left - size * 0.4, scales.y(value) + size * 0.35);
  }
  ctx.textAlign = 'center';
  for (const value of multiplesOf(roundUp((end - start) * 5 * size / (right - left)), start, end)) {
    line([[scales.x(value), top], [scales.x(value), bottom]]);
    ctx.fillText(digits(value, 4) + (xLabel ? '' : ' s'), Math.min(scales.x(value), right - size), bottom + size * 1.15);
  }
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, right - left, bottom - top);
  ctx.clip();
  if (mark !== undefined) {
    ctx.strokeStyle = palette.faint;
    line([[scales.x(mark), top], [scales.x(mark), bottom]]);
  }
  ctx.lineJoin = 'round';
  for (const {points, color, width: thick, alpha = 1, dash = []} of [...behind, ...curves]) {
    ctx.strokeStyle = color;
    ctx.lineWidth = thick;
    ctx.globalAlpha = alpha;
    ctx.setLineDash(dash);
    line(points.map(([x, y]) => [scales.x(x), scales.y(y)]));
  }
  ctx.restore();
  ctx.textAlign = 'right';
  ctx.lineWidth = 4;
  ctx.strokeStyle = palette.paper;
  ctx.strokeText(xLabel, right, bottom - size * 0.4);
  ctx.fillStyle = palette.ink;
  ctx.fillText(xLabel, right, bottom - size * 0.4);
  return scales;
}

/**
 * @param {{points: number[][]}[]} curves
 * @param {number} axis 0 is x
 * @returns {[number, number]} least and greatest value; Infinity and -Infinity where there are no points
 */
export function spanOf(curves, axis) {
  let least = Infinity, most = -Infinity;
  for (const {points} of curves) for (const {[axis]: value} of points) [least, most] = [Math.min(least, value), Math.max(most, value)];
  return [least, most];
}

/**
 * @param {{points: number[][]}[]} curves
 * @returns {[number, number]} least and greatest height of the chart
 */
function heightsOf(curves) {
  const [least, most] = spanOf(curves, 1);
  if (least > most) return [0, 1];
  const margin = Math.max((most - least) * MARGIN, Math.abs(most) * 0.02, 0.05);
  return [least - margin, most + margin];
}
