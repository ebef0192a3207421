// SPDX-License-Identifier: Apache-2.0
/**
 * What is written around bodies: their labels, upright at the centre of mass and as large as the body has room for, or
 * beside a body on which a joint is; numbers at arrows; and below them the grid in metres, rulers whose steps follow the zoom, and the beams of a laser.
 */

import {fixed, multiplesOf} from '../rounding.js';
import {ropeStops} from '../rope_path.js';
import {rotated} from '../vectors.js';

/** @import {Frame, Point, SceneView} from '../types.js' */

/**
 * @typedef {{text: string, color: string, tip: Point, along: Point, from?: Point, named?: boolean}} Numbered a number at
 *   the tip of an arrow [px], in whose direction it is put first; named: it is shown even where others are
 */

/** @typedef {[number, number, number, number]} Box left, top, right, bottom [px] */

const SMALLEST = 11, LARGEST = 28; // px: size of letters
const DIGIT = 0.65; // em: width of a digit
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
  const {centroid, name} = world.scene.bodies[row], [x, y] = camera.toPage(...world.place(row, centroid));
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

/** @type {(a: Box, b: Box) => boolean} */
function overlap(a, b) {
  return a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
}

const FONT = '13px system-ui, sans-serif';
const HALF = 9, BETWEEN = 6, TIP = 7, CLEAR = 4; // px: half of the height of a number, from a tip to it, half of what a tip takes, beside a line
const ALONG = ['spring', 'rod', 'rope'], HINGES = ['axle', 'motor', 'pin']; // kinds of joints that are lines, and points
const RULER = 18; // px: of the ruler at the lower edge
const TURNS = [0, 0.6, -0.6, 1.2, -1.2, 1.9, -1.9, Math.PI], FAR = [0, 18, 36]; // rad and px of the places that are tried

/**
 * Write the numbers of arrows where they cover neither each other nor an arrow, as far as there is room: those of
 * the selected bodies first.
 * @param {SceneView} view
 */
export function drawNumbers(view) {
  const {ctx, insets, camera, numbers} = view, sides = [insets.left + 4, insets.top + 4, camera.width - insets.right - 4, camera.height - insets.bottom - RULER];
  /** @type {Box[]} */
  const taken = numbers.map(({tip: [x, y]}) => /** @type {Box} */ ([x - TIP, y - TIP, x + TIP, y + TIP]));
  ctx.font = FONT;
  if (!numbers.length) return;
  const lines = [...numbers.flatMap(({from, tip}) => from ? [/** @type {const} */ ([from, tip])] : []), ...linesOf(view)];
  const inOrder = [...numbers].sort((a, b) => Number(b.named ?? false) - Number(a.named ?? false));
  for (const {text, color, tip: [x, y], along: [ux, uy], from: [fx, fy] = [x, y], named = false} of inOrder) {
    // What lies beyond the page has no number at its edge.
    if (fx < 0 || fy < 0 || fx > camera.width || fy > camera.height) continue;
    const half = ctx.measureText(text).width / 2;
    let best = /** @type {?Box} */ (null), least = Infinity;
    for (const far of FAR) for (const turn of TURNS) {
      const [dx, dy] = rotated([ux, uy], turn);
      const cx = clamp(x + dx * (BETWEEN + half + far), sides[0] + half, sides[2] - half);
      const cy = clamp(y + dy * (BETWEEN + HALF + far), sides[1] + HALF, sides[3] - HALF);
      const box = /** @type {Box} */ ([cx - half, cy - HALF, cx + half, cy + HALF]);
      const covers = 4 * view.covered.filter((other) => overlap(box, other)).length + taken.filter((other) => overlap(box, other)).length +
        lines.filter(([begin, end]) => crosses(box, begin, end)).length;
      if (covers < least) [best, least] = [box, covers];
      if (!least) break;
    }
    if (!best || least >= 4 && !named) continue;
    view.write(text, [(best[0] + best[2]) / 2, best[3] - 5], color, 'center');
  }
}

/** @type {(value: number, least: number, most: number) => number} */
function clamp(value, least, most) {
  return Math.max(Math.min(value, most), least);
}

/** @type {(box: Box, begin: Point, end: Point) => boolean} whether a line crosses a box (Liang and Barsky) */
function crosses([left, top, right, bottom], [px, py], [qx, qy]) {
  let [first, last] = [0, 1];
  for (const [from, way, low, high] of [[px, qx - px, left - CLEAR, right + CLEAR], [py, qy - py, top, bottom]]) {
    if (!way && (from < low || from > high)) return false;
    const [enters, leaves] = way ? [(low - from) / way, (high - from) / way].sort((one, other) => one - other) : [0, 1];
    [first, last] = [Math.max(first, enters), Math.min(last, leaves)];
  }
  return first < last;
}

/**
 * @param {SceneView} view
 * @returns {[Point, Point][]} lines of the page that a number would cross: bounds and joints [px]
 */
function linesOf(view) {
  const {camera, world: {scene}} = view, at = (/** @type {Point} */ point) => camera.toPage(...point), [left, low, right, high] = scene.bounds;
  const corners = /** @type {Point[]} */ (left === undefined ? [] : [[left, low], [right, low], [right, high], [left, high]]);
  const bounds = corners.map((corner, i) => /** @type {[Point, Point]} */ ([at(corner), at(corners[(i + 1) % 4])]));
  return [...bounds, ...jointLines(view).map(({ends}) => ends)];
}

/**
 * @param {SceneView} view
 * @returns {{rows: number[], ends: [Point, Point]}[]} springs, rods and spans of ropes, and hinges, which are points, with the
 *   rows of their bodies [px]
 */
function jointLines({camera, world}) {
  const at = (/** @type {Point} */ point) => camera.toPage(...point);
  return world.scene.joints.filter(({kind, a, b}) => (ALONG.includes(kind) || HINGES.includes(kind)) && a < world.count && b < world.count).flatMap((joint) => {
    const {a, b, kind} = joint, stops = ropeStops(world, joint), ends = HINGES.includes(kind) ? [stops[0], stops[0]] : stops;
    return ends.slice(1).map((stop, i) => ({rows: [a, b], ends: /** @type {[Point, Point]} */ ([at(ends[i].at), at(stop.at)])}));
  });
}

const DOT = 4; // px: of a hit

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
    view.write(textOf(value), at, palette.faint, align, SMALLEST);
  const low = camera.height - insets.bottom;
  // Far out numbers are long: only some lines have room for one.
  const wide = SMALLEST * (2 + DIGIT * Math.max(textOf(left).length, textOf(right).length));
  for (const value of multiplesOf(step * Math.ceil(wide / (step * camera.scale)), left, right)) {
    const [x] = camera.toPage(value, 0);
    if (x > insets.left + 40 && x < camera.width - insets.right - 20) write(value, [x, low - 6], 'center');
  }
  for (const value of multiplesOf(step, bottom, top)) {
    const [, y] = camera.toPage(0, value);
    if (y > insets.top + 14 && y < low - 24) write(value, [insets.left + 6, y - 4], 'left');
  }
}

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
