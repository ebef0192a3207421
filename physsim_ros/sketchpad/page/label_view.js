// SPDX-License-Identifier: Apache-2.0
/** Labels of bodies: upright at the centre of mass, on a rim of paper, as large as the body has room for. */

/** @import {SceneView} from './types.js' */

const SMALLEST = 11, LARGEST = 28; // px: size of letters
const LINE = 1.25, MARGIN = 1.2; // em: height of a line, left free in a body beside and above the text

/** @param {SceneView} view */
export function drawLabels({ctx, camera, palette, world, bodies}) {
  for (let row = 0; row < world.count; row++) {
    const body = world.scene.bodies[row], appearance = bodies.appearance(body);
    if (!body.label || !bodies.isOnPage(world.frame, row, appearance)) continue;
    const [wide, high] = sizeOf(ctx, body.label), {width = 0, height = 0, thickness} = body.shape;
    const room = width ? Math.min(width / wide, height / high) :
      (thickness ?? 2 * appearance.inner) / Math.hypot(wide, high);
    const size = Math.min(Math.max(room * camera.scale, SMALLEST), LARGEST);
    const [x, y] = camera.toPage(...world.place(row, body.centroid)), lines = body.label.split('\n');
    ctx.font = `${size}px system-ui, sans-serif`;
    ctx.textAlign = 'center';
    ctx.textBaseline = 'middle';
    ctx.lineJoin = 'round';
    ctx.lineWidth = size / 4;
    ctx.strokeStyle = palette.paper;
    ctx.fillStyle = palette.ink;
    lines.forEach((line, i) => {
      const at = y + (i - (lines.length - 1) / 2) * LINE * size;
      ctx.strokeText(line, x, at);
      ctx.fillText(line, x, at);
    });
    ctx.textBaseline = 'alphabetic';
  }
}

/**
 * @param {CanvasRenderingContext2D} ctx
 * @param {string} label
 * @returns {[number, number]} width and height of a box that it fills [em]
 */
export function sizeOf(ctx, label) {
  const lines = label.split('\n');
  ctx.font = '100px system-ui, sans-serif';
  return [Math.max(...lines.map((line) => ctx.measureText(line).width / 100)) + MARGIN, lines.length * LINE + MARGIN];
}
