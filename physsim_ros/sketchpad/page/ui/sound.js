// SPDX-License-Identifier: Apache-2.0
/** Sound: a short note for a body that is hit, off at the start. */

/** @import {Frame, Parts} from '../types.js' */

const WEAKEST = 0.5; // m/s: a softer impact is not heard
const LOUD = 8; // m/s: no impact is louder
const VOICES = 4; // impacts of a frame that are heard, the hardest
const LASTS = 0.18; // s
const PITCH = 440; // Hz of a body of 1 kg; that of 16 kg is an octave lower

export class Sound {
  /** @param {Parts<'connection' | 'frames' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    /** @type {?AudioContext} while it is on */
    this.context = null;
    /** @type {Set<string>} pairs of rows that touched in the frame before */
    this.touching = new Set();
    parts.connection.on('frame', (frame) => {
      if (this.context) this.#listen(frame, this.context);
    });
  }

  get on() {
    return this.context !== null;
  }

  /** Browsers let sound begin where somebody has pressed a button. */
  toggle() {
    if (this.context) this.context.close();
    this.context = this.context ? null : new AudioContext();
    this.parts.frames.want(this, {contacts: this.on});
  }

  /**
   * @param {Frame} frame
   * @param {AudioContext} context
   */
  #listen({contacts, speed}, context) {
    const {scene} = this.parts.world, now = new Set(), impacts = [];
    if (!contacts || speed <= 0) return;
    for (let i = 0; i < contacts.a.length; i++) {
      const a = contacts.a[i], b = contacts.b[i], pair = `${a} ${b}`;
      now.add(pair);
      if (this.touching.has(pair)) continue;
      const masses = [a, b].filter((row) => row >= 0 && !scene.bodies[row].anchored).map((row) => scene.bodies[row].mass);
      // The change of velocity of the lighter one.
      const mass = Math.min(...masses), change = Math.hypot(contacts.jx[i], contacts.jy[i]) / mass;
      if (change > WEAKEST && mass < Infinity) impacts.push({mass, change});
    }
    this.touching = now;
    impacts.sort((one, other) => other.change - one.change);
    for (const {mass, change} of impacts.slice(0, VOICES)) this.#play(context, mass, Math.min(change / LOUD, 1));
  }

  /**
   * @param {AudioContext} context
   * @param {number} mass [kg]
   * @param {number} loudness 0 .. 1
   */
  #play(context, mass, loudness) {
    const tone = context.createOscillator(), gain = context.createGain(), begin = context.currentTime;
    tone.type = 'triangle';
    tone.frequency.value = Math.min(Math.max(PITCH * mass ** -0.25, 60), 2000);
    gain.gain.setValueAtTime(0.3 * loudness, begin);
    gain.gain.exponentialRampToValueAtTime(0.001, begin + LASTS);
    tone.connect(gain).connect(context.destination);
    tone.start(begin);
    tone.stop(begin + LASTS);
  }
}
