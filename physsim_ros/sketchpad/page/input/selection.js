// SPDX-License-Identifier: Apache-2.0
/**
 * The selection: what the panel shows, bodies that are selected among it, and the one that is pointed at, with its name
 * beside it. Who opens, closes or follows panels selects here, or listens: each change is the event `change`.
 */

import {Emitter} from '../emitter.js';
import {t} from '../strings.js';

/** @import {Body, Joint, Parts, Point, SceneView, Touch} from '../types.js' */

const BESIDE = 0.5; // m between bodies and their copies
const NEAR = 8; // px: a tap that far from a joint means it

/** @typedef {'' | 'body' | 'several' | 'joint' | 'world' | 'measure'} Kind of a subject of the panel; '' is a closed one */

export class Selection extends Emitter {
  /** @param {Parts<'camera' | 'connection' | 'frames' | 'notes' | 'pointers' | 'view' | 'words' | 'world'>} parts */
  constructor(parts) {
    super();
    this.parts = parts;
    /** @type {Kind} */
    this.kind = '';
    /** @type {string[]} names of bodies, or of the joint */
    this.subject = [];
    /** @type {Set<string>} of bodies */
    this.names = new Set();
    /** Bodies that were copied, or cut: pasted, those are moved. @type {{names: string[], cut: boolean}} */
    this.kept = {names: [], cut: false};
    /** The pointer, where it is not pressed; null where it has left. @type {?Touch} */
    this.pointed = null;
    parts.view.overlays.push((view) => this.#draw(view));
    parts.pointers.on('press', () => { this.pointed = null; });
    parts.pointers.on('point', (touch) => { this.pointed = touch; });
    // Of the same name, a body of another world is another body.
    parts.connection.on('world', () => { this.kept.names = []; });
    parts.connection.on('scene', ({bodies, joints}) => {
      const known = new Set((this.kind === 'joint' ? joints : bodies).map((/** @type {Body | Joint} */ {name}) => name));
      const rest = this.subject.filter((name) => known.has(name));
      if (rest.length < this.subject.length) this.select(rest);
    });
  }

  /** @returns {string} the name of the body that is the subject; '' where that is none, or several */
  get name() {
    return this.kind === 'body' ? this.subject[0] : '';
  }

  /** @returns {string} the name of the joint that is the subject */
  get joint() {
    return this.kind === 'joint' ? this.subject[0] : '';
  }

  /** @param {string[]} names of bodies */
  select(names) {
    this.show(names.length > 1 ? 'several' : names.length ? 'body' : '', names);
  }

  /**
   * @param {Kind} kind of the subject
   * @param {string[]} subject names of its bodies, or of the joint
   */
  show(kind, subject = []) {
    const {frames, world} = this.parts;
    Object.assign(this, {kind, subject});
    this.names = new Set(kind === 'joint' ? [] : subject);
    const some = this.names.size > 0;
    frames.want(this, {velocities: some, contacts: some, laser: world.body(this.name)?.robot ? this.name : ''});
    this.emit('change');
  }

  /** @param {Touch} touch */
  selectAt(touch) {
    const {world, camera} = this.parts, body = world.nameAt(touch);
    const joint = world.jointAt(touch.at, touch.slop + NEAR / camera.scale, body !== '');
    // A second tap selects the body below the joint.
    if (joint && joint !== this.joint) this.show('joint', [joint]);
    else this.select(body ? [body] : []);
  }

  selectAll() {
    this.select(this.parts.world.scene.bodies.map(({name}) => name));
  }

  /** @param {boolean} cut whether the selected bodies are moved, not copied, where they are pasted */
  keep(cut) {
    if (!this.names.size) return;
    this.kept = {names: [...this.names], cut};
    this.parts.notes.showMessage(cut ? t('Cut: paste it elsewhere') : t('Copied'));
  }

  /** @param {?Point} at where the middle of the bodies comes to lie [m]; null is beside them */
  paste(at) {
    const {world, connection} = this.parts, {kept} = this, names = kept.names.filter((name) => world.row(name) >= 0);
    if (!names.length) return;
    // Of a part the whole robot is copied.
    const whole = names.map((name) => world.robotOf(name) ?? world.body(name));
    const [left, low, right, high] = world.boundsOfAll(whole.flatMap((body) => body ? [body.name, ...body.robot?.parts ?? []] : []));
    connection.send(kept.cut ? 'move_bodies' : 'copy_machine', {names, by: at ? [at[0] - (left + right) / 2, at[1] - (low + high) / 2] : [right - left + BESIDE, 0]});
    kept.cut = false;
  }

  /** Copy the selected bodies beside them. */
  duplicate() {
    const before = this.kept;
    this.kept = {names: [...this.names], cut: false};
    this.paste(null);
    this.kept = before;
  }

  /** Delete the selected bodies, or the joint. */
  deleteSelected() {
    const {parts: {connection}, joint} = this;
    if (joint) connection.send('unjoin', {name: joint});
    else if (this.names.size) connection.send('delete', {names: [...this.names]});
    this.select([]);
  }

  /** @param {SceneView} view */
  #draw(view) {
    const {palette} = view, {world, camera, words, pointers: {tool}} = this.parts;
    for (const name of this.names) view.outline(name, palette.accent);
    // Bodies come and go under a pointer that rests.
    const name = this.pointed ? world.nameAt({at: camera.toWorld(...this.pointed.page), slop: this.pointed.slop}) : '';
    view.canvas.classList.toggle('over', name !== '');
    if (!name || !this.pointed) return;
    if (tool.aims) view.outline(name, palette[tool.aims]);
    const [x, y] = this.pointed.page;
    view.write(words.item(name), [x + 16, y - 10], palette.ink);
  }
}
