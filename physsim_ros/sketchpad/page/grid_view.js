// SPDX-License-Identifier: Apache-2.0
/**
 * What lies below the bodies: the grid in metres, rulers at the edges whose steps follow the zoom, and what the laser
 * of the selected robot sees, its beams as a fan with a dot where one hits.
 */

import {multiplesOf} from './rounding.js';

/** @import {Camera, Frame, Palette} from './types.js' */

const DOT = 4; // px: of a hit

/**
 * @param {CanvasRenderingContext2D} ctx in pixels of the page
 * @param {Camera} camera
 * @param {Palette} palette
 * @param {{left: number, bottom: number}} insets where the rulers lie [px]
 */
export function drawGrid(ctx, camera, palette, insets) {
  const step = camera.gridStep, digits = Math.max(0, -Math.floor(Math.log10(step)));
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
  ctx.fillStyle = palette.faint;
  ctx.font = '11px system-ui, sans-serif';
  const low = camera.height - insets.bottom;
  ctx.textAlign = 'center';
  for (const value of multiplesOf(step, left, right)) {
    const x = pixelX(value);
    if (x > insets.left + 40 && x < camera.width - 20) ctx.fillText(`${value.toFixed(digits)} m`, x, low - 6);
  }
  ctx.textAlign = 'left';
  for (const value of multiplesOf(step, bottom, top)) {
    const y = pixelY(value);
    if (y > 20 && y < low - 24) ctx.fillText(`${value.toFixed(digits)} m`, insets.left + 6, y - 4);
  }
}

/**
 * @param {CanvasRenderingContext2D} ctx
 * @param {Camera} camera
 * @param {Palette} palette
 * @param {NonNullable<Frame['scan']>} scan
 */
export function drawScan(ctx, camera, {accent, force}, {x, y, hit}) {
  ctx.fillStyle = accent;
  ctx.globalAlpha = 0.16;
  ctx.beginPath();
  for (let i = 0; i < x.length; i++) ctx.lineTo(...camera.toPage(x[i], y[i]));
  ctx.fill();
  ctx.globalAlpha = 1;
  ctx.fillStyle = force;
  for (let i = 1; i < x.length; i++) {
    const [px, py] = camera.toPage(x[i], y[i]);
    if (hit[i]) ctx.fillRect(px - DOT / 2, py - DOT / 2, DOT, DOT);
  }
}
