// SPDX-License-Identifier: Apache-2.0

/**
 * The recording in Rerun's web viewer, beside the page.
 *
 * Each batch of the stream is acknowledged when its last frame is on the screen; the server sends the next
 * one then, so that a slow browser leaves frames out and stays behind by one of its own frames.
 */

import {elementOf} from './dom.js';
import {watchTheme} from './theme.js';

/** Time from a batch to its picture that is told [s]: a delay between a deed and its picture that is seen. */
const SLOW = 0.5;
/** Frames of the viewer after which a batch is acknowledged that it does not show, as while it is paused. */
const MOST_FRAMES = 8;
const CHANNEL = 'physsim';

const status = elementOf('recording', HTMLElement);
/** Time that the viewer shows, on its timeline [ns]. */
let shown = -1;

const nextFrame = () => new Promise((resolve) => { requestAnimationFrame(resolve); });

/** @param {string} text */
function onViewerEvent(text) {
  const event = JSON.parse(text);
  if (event.type === 'time_update' || event.type === 'timeline_change') shown = event.time;
}

/** Start the viewer. */
async function startViewer() {
  // @ts-expect-error a `let` of the classic script re_viewer.js, which has no types
  const glue = typeof wasm_bindgen === 'undefined' ? null : wasm_bindgen;
  if (!glue) throw new Error('the viewer does not answer; load the page again');
  await glue({module_or_path: '/rerun/re_viewer_bg.wasm'});
  const viewer = new glue.WebHandle({hide_welcome_screen: true, persist: false, on_viewer_event: onViewerEvent});
  await viewer.start(elementOf('viewer', HTMLCanvasElement));
  viewer.open_channel(CHANNEL, CHANNEL);
  return viewer;
}

/**
 * Show a batch, and wait until it is on the screen.
 *
 * @param {any} viewer
 * @param {ArrayBuffer} batch
 * @param {number} recorded time of its last frame [ns]
 */
async function showBatch(viewer, batch, recorded) {
  const begun = performance.now(), isFirst = shown < 0;
  viewer.send_rrd_to_channel(CHANNEL, new Uint8Array(batch));
  for (let frames = 0; frames < MOST_FRAMES && shown < recorded; frames += 1) await nextFrame();
  const seconds = (performance.now() - begun) / 1000;
  // The first frame of a viewer takes longer: it compiles what it draws with.
  status.textContent = seconds > SLOW && !isFirst ?
    `${seconds.toFixed(1)} s behind: this browser draws slowly, frames are left out` : '';
}

/** @param {any} viewer */
function connect(viewer) {
  const scheme = location.protocol.replace('http', 'ws');
  const socket = new WebSocket(`${scheme}//${location.host}/rerun/ws`);
  socket.binaryType = 'arraybuffer';
  let recorded = 0;
  socket.addEventListener('message', async ({data}) => {
    if (typeof data === 'string') {
      ({recorded} = JSON.parse(data));
      return;
    }
    const end = recorded;
    await showBatch(viewer, data, end);
    if (socket.readyState === WebSocket.OPEN) socket.send(String(end));
  });
  socket.addEventListener('close', () => { status.textContent = 'The recording has ended; load the page again.'; });
}

watchTheme();
try {
  const viewer = await startViewer();
  // Without a graphics card that takes seconds, in which the browser draws nothing else.
  status.textContent = 'Rerun draws its first picture …';
  connect(viewer);
} catch (error) {
  status.textContent = `Rerun cannot be shown: ${error instanceof Error ? error.message : error}`;
}
