// SPDX-License-Identifier: Apache-2.0
/** Numbers at the tips of arrows, where they cover neither each other nor an arrow, as far as there is room. */

import {crosses, jointLines, overlap} from './clearance.js';
import {RULER} from './grid_view.js';
import {rotated} from '../vectors.js';

/** @import {Point, SceneView} from '../types.js' */
/** @import {Box} from './clearance.js' */

/**
 * @typedef {{text: string, color: string, tip: Point, along: Point, from?: Point, named?: boolean}} Numbered a number at
 *   the tip of an arrow [px], in whose direction it is put first; named: it is shown even where others are
 */

const FONT = '13px system-ui, sans-serif';
const HALF = 9, BETWEEN = 6, TIP = 7; // px: half of the height of a number, from a tip to it, half of what a tip takes
const TURNS = [0, 0.6, -0.6, 1.2, -1.2, 1.9, -1.9, Math.PI], FAR = [0, 18, 36]; // rad and px of the places that are tried

/**
 * Write the numbers, those of the selected bodies first.
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
