// SPDX-License-Identifier: Apache-2.0
/** Labels of bodies: upright at the centre of mass, on a rim of paper, as large as the body has room for. */

/** @import {SceneView} from './types.js' */

/** @typedef {[number, number, number, number]} Box left, top, right, bottom [px] */

const SMALLEST = 11, LARGEST = 28; // px: size of letters
const LINE = 1.25, MARGIN = 1.2; // em: height of a line, left free in a body beside and above the text
const REMEMBERED = 500; // texts whose sizes are known

/** @type {Map<string, [number, number]>} sizes by text [em] */
const sizes = new Map();

/** @param {SceneView} view */
export function drawLabels({ctx, camera, palette, world, bodies}) {
  /** @type {Box[]} */
  const drawn = [];
  for (let row = 0; row < world.count; row++) {
    const body = world.scene.bodies[row], appearance = bodies.appearance(body);
    if (!body.label || !bodies.isOnPage(world.frame, row, appearance)) continue;
    const [wide, high] = sizeOf(ctx, body.label), {width = 0, height = 0, thickness} = body.shape;
    const room = width ? Math.min(width / wide, height / high) :
      (thickness ?? 2 * appearance.inner) / Math.hypot(wide, high);
    const size = Math.min(Math.max(room * camera.scale, SMALLEST), LARGEST);
    const [x, y] = camera.toPage(...world.place(row, body.centroid)), lines = body.label.split('\n');
    const right = (wide - MARGIN) * size / 2, below = lines.length * LINE * size / 2;
    const box = /** @type {Box} */ ([x - right, y - below, x + right, y + below]);
    // Larger than its body, it may lie on others, but not on their labels.
    if (room * camera.scale < SMALLEST && drawn.some((other) => overlap(box, other))) continue;
    drawn.push(box);
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
  let size = sizes.get(label);
  if (!size) {
    const lines = label.split('\n');
    ctx.font = '100px system-ui, sans-serif';
    size = [Math.max(...lines.map((line) => ctx.measureText(line).width / 100)) + MARGIN, lines.length * LINE + MARGIN];
    if (sizes.size >= REMEMBERED) sizes.clear();
    sizes.set(label, size);
  }
  return size;
}

/** @type {(a: Box, b: Box) => boolean} */
function overlap(a, b) {
  return a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
}
