// SPDX-License-Identifier: Apache-2.0
/** Links to copy: one that holds this world, and one to this moment. */

import {createElement} from '../dom.js';
import {t} from '../strings.js';

/** @import {Parts} from '../types.js' */

const LONGEST = 16000; // characters

/**
 * Show a link that holds the world as it is now, and copy it.
 * @param {Parts<'dialog' | 'files' | 'notes'>} parts
 */
export async function showWorldLink(parts) {
  const world = await parts.files.text();
  if (world === null) return;
  const link = `${location.origin}/#world=${await packText(world)}`;
  if (link.length <= LONGEST) await show(parts, t('A link that holds this world'), link);
  else parts.notes.showMessage(t('This world is too large for a link: download it as a file.'), {ok: false});
}

/**
 * Show a link to the moment that is shown, of the lesson that is open, and copy it.
 * @param {Parts<'dialog' | 'lessons' | 'notes' | 'world'>} parts
 */
export async function showMomentLink(parts) {
  const {lessons, world} = parts, lesson = lessons.list.find(({title}) => title === world.scene.lesson?.title);
  const moment = `t=${Number(world.frame.time.toFixed(4))}`;
  await show(parts, t('A link to this moment'), `${location.origin}/#${lesson ? `lesson=${encodeURIComponent(lesson.name)}&` : ''}${moment}`);
}

/**
 * @param {Parts<'dialog' | 'notes'>} parts
 * @param {string} title
 * @param {string} link
 */
async function show({dialog, notes}, title, link) {
  dialog.show(title, createElement('input', {value: link, readOnly: true, autofocus: true, 'aria-label': t('Link')}));
  notes.showMessage(title);
  await navigator.clipboard?.writeText(link).catch(() => {});
}

/**
 * @param {string} text
 * @returns {Promise<string>} for a link: deflated, then base64 for addresses (RFC 4648, section 5)
 */
async function packText(text) {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream('deflate-raw'));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const binary = Array.from(bytes, (byte) => String.fromCharCode(byte)).join('');
  return btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
}
