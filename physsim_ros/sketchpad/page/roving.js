// SPDX-License-Identifier: Apache-2.0
/** Toolbars that Tab reaches once; arrow keys move within them (WAI-ARIA, pattern *Toolbar*). */

/** Directions on the page. @type {Record<string, [number, number]>} */
const ARROWS = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
const ASIDE = 3; // weight of the distance across the direction of an arrow key

/**
 * @param {HTMLElement} bar whose buttons may come and go
 * @param {string} first selector of the button that Tab reaches at first
 */
export function makeToolbar(bar, first = 'button') {
  bar.setAttribute('role', 'toolbar');
  const items = () => [...bar.querySelectorAll('button')].filter((each) => each.checkVisibility());
  /** @type {Element | null} */
  let current = null;
  const rove = (/** @type {Element | null} */ to = bar.querySelector(first)) => {
    current = to;
    for (const each of bar.querySelectorAll('button')) each.tabIndex = each === to ? 0 : -1;
  };
  bar.addEventListener('focusin', ({target}) => target instanceof HTMLButtonElement && rove(target));
  bar.addEventListener('keydown', (event) => {
    const all = items(), from = all.find((each) => each === event.target), {key} = event;
    const to = key === 'Home' ? all[0] : key === 'End' ? all.at(-1) : from && key in ARROWS ? nextOf(all, from, ARROWS[key]) : undefined;
    if (!to || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    event.stopPropagation();
    to.focus();
  });
  // The one that Tab reaches may be taken away or hidden.
  new MutationObserver(() => current?.isConnected && current.checkVisibility() ? rove(current) : rove(items()[0]))
    .observe(bar, {childList: true, subtree: true, attributeFilter: ['hidden']});
  rove();
}

/**
 * @param {HTMLButtonElement[]} all
 * @param {HTMLButtonElement} from
 * @param {[number, number]} direction
 * @returns {HTMLButtonElement | undefined} the next one in that direction; undefined where there is none
 */
function nextOf(all, from, [dx, dy]) {
  const [x, y] = centreOf(from);
  let least = Infinity, next;
  for (const each of all) {
    const [toX, toY] = centreOf(each), along = (toX - x) * dx + (toY - y) * dy;
    const far = along + ASIDE * Math.abs((toX - x) * dy - (toY - y) * dx);
    if (along > 1 && far < least) [least, next] = [far, each];
  }
  return next;
}

/** @param {Element} element */
function centreOf(element) {
  const {left, top, width, height} = element.getBoundingClientRect();
  return [left + width / 2, top + height / 2];
}
