// SPDX-License-Identifier: Apache-2.0
/** The beams of a laser, and what they hit. */

/** @import {Frame, SceneView} from '../types.js' */

const DOT = 4; // px: of a hit

/**
 * @param {SceneView} view
 * @param {NonNullable<Frame['scan']>} scan
 */
export function drawScan({ctx, camera, palette: {accent, force}}, {x, y, hit}) {
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
