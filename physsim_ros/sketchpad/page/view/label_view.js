// SPDX-License-Identifier: Apache-2.0
/**
 * The labels of bodies: upright at the centre of mass, as large as the body has room for, or beside a body on which a joint
 * is.
 */

import {CLEAR, crosses, jointLines, overlap} from './clearance.js';

/** @import {SceneView} from '../types.js' */
/** @import {Box} from './clearance.js' */

const SMALLEST = 11, LARGEST = 28; // px: size of letters
const LINE = 1.25, MARGIN = 1.2, BASE = 0.35; // em: height of a line, left free in a body beside and above the text, from the middle of a line to its base
const REMEMBERED = 500; // texts whose sizes are known

/** @type {Map<string, [number, number]>} sizes by text [em] */
const sizes = new Map();

/** @param {SceneView} view */
export function drawLabels(view) {
  const {ctx, camera, palette, world, bodies} = view;
  if (!world.scene.bodies.some(({label}) => label)) return;
  /** @type {Box[]} */
  const drawn = [];
  const lines = jointLines(view);
  for (let row = 0; row < world.count; row++) {
    const body = world.scene.bodies[row], appearance = bodies.appearance(body);
    if (!body.label || !bodies.isOnPage(world.frame, row, appearance)) continue;
    const [wide, high] = labelSize(ctx, body.label), {width = 0, height = 0, thickness} = body.shape;
    const room = width ? Math.min(width / wide, height / high) :
      (thickness ?? 2 * appearance.inner) / Math.hypot(wide, high);
    const size = Math.min(Math.max(room * camera.scale, SMALLEST), LARGEST);
    const texts = body.label.split('\n'), half = (wide - MARGIN) * size / 2, below = texts.length * LINE * size / 2;
    const box = labelBox(view, row, lines, half, below), x = box[0] + half, y = box[1] + below;
    // Larger than its body, it may lie on others, but not on their labels.
    if (room * camera.scale < SMALLEST && drawn.some((other) => overlap(box, other))) continue;
    drawn.push(box);
    texts.forEach((line, i) => view.write(line, [x, y + ((i - (texts.length - 1) / 2) * LINE + BASE) * size], palette.ink, 'center', size));
  }
}

/**
 * @param {SceneView} view
 * @param {number} row of the body
 * @param {ReturnType<typeof jointLines>} lines
 * @param {number} half of the width of its label [px]
 * @param {number} below half of its height [px]
 * @returns {Box} of the label: at the centre of mass, or where a joint lies there, beside the body
 */
function labelBox({camera, world}, row, lines, half, below) {
  const {name} = world.scene.bodies[row], [x, y] = camera.toPage(...world.centerOf(row));
  const [xmin, ymin, xmax, ymax] = world.boundsOfAll([name]), [left, top] = camera.toPage(xmin, ymax), [right, low] = camera.toPage(xmax, ymin);
  const places = [[x, y], [x, top - below], [x, low + below], [right + half + CLEAR, y], [left - half - CLEAR, y]];
  const boxes = places.map(([px, py]) => /** @type {Box} */ ([px - half, py - below, px + half, py + below]));
  const own = lines.filter(({rows}) => rows.includes(row));
  return boxes.find((box) => !own.some(({ends}) => crosses(box, ...ends))) ?? boxes[0];
}

/**
 * @param {CanvasRenderingContext2D} ctx
 * @param {string} label
 * @returns {[number, number]} width and height of a box that it fills [em]
 */
export function labelSize(ctx, label) {
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
