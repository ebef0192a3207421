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
  /** @type {[string, number, number, boolean][]} */
  const labels = [];
  for (let i = Math.floor(5 * Math.min(left, bottom) / step); ; i++) {
    const value = i * step / 5;
    if (value > Math.max(right, top)) break;
    const path = i % 5 ? minor : major;
    const [px, py] = camera.toPage(value, value);
    const x = Math.round(px) + 0.5, y = Math.round(py) + 0.5;
    if (value >= left && value <= right) {
      path.moveTo(x, 0);
      path.lineTo(x, camera.height);
      if (i % 5 === 0) labels.push([value.toFixed(digits), x, 0, true]);
    }
    if (value >= bottom && value <= top) {
      path.moveTo(0, y);
      path.lineTo(camera.width, y);
      if (i % 5 === 0) labels.push([value.toFixed(digits), 0, y, false]);
    }
  }
  ctx.lineWidth = 1;
  ctx.strokeStyle = palette.minor;
  ctx.stroke(minor);
  ctx.strokeStyle = palette.major;
  ctx.stroke(major);
  ctx.fillStyle = palette.faint;
  ctx.font = '11px system-ui, sans-serif';
  for (const [text, x, y, across] of labels) {
    if (across && x > insets.left + 40 && x < camera.width - 20) {
      ctx.textAlign = 'center';
      ctx.fillText(text, x, camera.height - insets.bottom - 6);
    } else if (!across && y < camera.height - insets.bottom - 24 && y > 20) {
      ctx.textAlign = 'left';
      ctx.fillText(`${text} m`, insets.left + 6, y - 4);
    }
  }
}
