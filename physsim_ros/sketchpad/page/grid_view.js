// SPDX-License-Identifier: Apache-2.0
/** The grid in metres, and rulers at the edges whose steps follow the zoom. */

/** @import {Camera, Palette} from './types.js' */

const LEAST_STEP = 70; // px between labelled lines

/**
 * @param {number} scale [px/m]
 * @returns {number} 1, 2 or 5 times a power of ten [m]
 */
function stepOf(scale) {
  const least = LEAST_STEP / scale, power = 10 ** Math.floor(Math.log10(least));
  return power * (least > 5 * power ? 10 : least > 2 * power ? 5 : least > power ? 2 : 1);
}

/**
 * @param {CanvasRenderingContext2D} ctx in pixels of the page
 * @param {Camera} camera
 * @param {Palette} palette
 * @param {{left: number, bottom: number}} insets where the rulers lie [px]
 */
export function drawGrid(ctx, camera, palette, insets) {
  const step = stepOf(camera.scale), digits = Math.max(0, -Math.floor(Math.log10(step)));
  const [left, top] = camera.toWorld(0, 0), [right, bottom] = camera.toWorld(camera.width, camera.height);
  const minor = new Path2D(), major = new Path2D();
  /** @type {[string, number, number][]} */
  const labels = [];
  for (let i = Math.floor(5 * Math.min(left, bottom) / step); i * step / 5 <= Math.max(right, top); i++) {
    const value = i * step / 5, path = i % 5 ? minor : major;
    const [x, y] = camera.toPage(value, value).map((at) => Math.round(at) + 0.5);
    path.moveTo(x, 0);
    path.lineTo(x, camera.height);
    path.moveTo(0, y);
    path.lineTo(camera.width, y);
    if (path === major) labels.push([value.toFixed(digits), x, y]);
  }
  ctx.lineWidth = 1;
  ctx.strokeStyle = palette.minor;
  ctx.stroke(minor);
  ctx.strokeStyle = palette.major;
  ctx.stroke(major);
  ctx.fillStyle = palette.faint;
  ctx.font = '11px system-ui, sans-serif';
  const low = camera.height - insets.bottom;
  for (const [text, x, y] of labels) {
    ctx.textAlign = 'center';
    if (x > insets.left + 40 && x < camera.width - 20) ctx.fillText(text, x, low - 6);
    ctx.textAlign = 'left';
    if (y > 20 && y < low - 24) ctx.fillText(`${text} m`, insets.left + 6, y - 4);
  }
}
