// SPDX-License-Identifier: Apache-2.0
/** Text in a link: deflated, then base64 for addresses (RFC 4648, section 5). */

const LARGEST = 1 << 20; // bytes; no more is unpacked

/** @param {string} text */
export async function packText(text) {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream('deflate-raw'));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const binary = Array.from(bytes, (byte) => String.fromCharCode(byte)).join('');
  return btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
}

/** @param {string} packed */
export async function unpackText(packed) {
  const binary = atob(packed.replaceAll('-', '+').replaceAll('_', '/'));
  const bytes = Uint8Array.from(binary, (character) => character.charCodeAt(0));
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw')).getReader();
  const parts = [];
  for (let size = 0; ;) {
    const {value, done} = await reader.read();
    if (done) return new Blob(parts).text();
    size += value.length;
    if (size > LARGEST) throw new RangeError('the world of this link is too large');
    parts.push(value);
  }
}
