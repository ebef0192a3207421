// SPDX-License-Identifier: Apache-2.0
/** The selection: bodies that are selected, and the one that is pointed at, with its name beside it. */

import {t} from '../strings.js';

/** @import {App, Body, Point, SceneView, Touch} from '../types.js' */

const BESIDE = 0.5; // m between bodies and their copies
const NEAR = 8; // px: a tap that far from a joint means it

export class Selection {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    /** @type {Set<string>} of bodies */
    this.names = new Set();
    /** Bodies that were copied, or cut: pasted, those are moved. @type {{names: string[], cut: boolean}} */
    this.kept = {names: [], cut: false};
    this.hovered = ''; // name of a body
    /** @type {Point | undefined} [px] */
    this.hoveredAt = undefined;
    app.view.overlays.push((view) => this.#draw(view));
    app.gestures.on('press', () => this.#hover(null));
    app.gestures.on('point', (touch) => this.#hover(touch));
    app.connection.on('scene', ({bodies}) => {
      const known = new Set(bodies.map((/** @type {Body} */ {name}) => name));
      for (const name of this.names) if (!known.has(name)) this.names.delete(name);
    });
  }

  /** @param {string[]} names of bodies */
  select(names) {
    const {app} = this;
    this.names = new Set(names);
    app.panel.show(names.length > 1 ? 'several' : names.length ? 'body' : '', names);
    app.askForParts();
  }

  /** @param {Touch} touch */
  selectAt({at, slop}) {
    const {world, camera} = this.app, row = world.bodyAt(at, slop);
    const name = world.jointAt(at, slop + NEAR / camera.scale, row >= 0);
    // A second tap selects the body below the joint.
    const joint = name === this.app.panel.joint ? '' : name;
    this.select(row < 0 || joint ? [] : [world.scene.bodies[row].name]);
    if (joint) this.app.panel.show('joint', [joint]);
  }

  selectAll() {
    this.select(this.app.world.scene.bodies.map(({name}) => name));
  }

  /** @param {boolean} cut whether the selected bodies are moved, not copied, where they are pasted */
  keep(cut) {
    if (!this.names.size) return;
    this.kept = {names: [...this.names], cut};
    this.app.notes.showMessage(cut ? t('Cut: paste it elsewhere') : t('Copied'));
  }

  /** @param {?Point} at where the middle of the bodies comes to lie [m]; null is beside them */
  paste(at) {
    const {world, connection} = this.app, {kept} = this, names = kept.names.filter((name) => world.row(name) >= 0);
    if (!names.length) return;
    const [left, low, right, high] = world.boundsOfAll(names);
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
    const {connection, panel: {joint}} = this.app;
    if (joint) connection.send('unjoin', {name: joint});
    else if (this.names.size) connection.send('delete', {names: [...this.names]});
    this.select([]);
  }

  /** @param {?Touch} touch */
  #hover(touch) {
    const {world, view} = this.app, row = touch ? world.bodyAt(touch.at, touch.slop) : -1;
    const name = row < 0 ? '' : world.scene.bodies[row].name;
    view.canvas.classList.toggle('over', row >= 0);
    this.hovered = name;
    this.hoveredAt = touch?.page;
  }

  /** @param {SceneView} view */
  #draw(view) {
    const {palette} = view, {world, gestures: {tool}} = this.app;
    for (const name of this.names) {
      const row = world.row(name);
      if (row >= 0) view.outline(row, palette.accent);
    }
    const row = this.hovered ? world.row(this.hovered) : -1;
    if (row < 0 || !this.hoveredAt) return;
    if (tool.aims) view.outline(row, palette[tool.aims]);
    const [x, y] = this.hoveredAt;
    view.write(this.app.words.item(this.hovered), [x + 16, y - 10], palette.ink);
  }
}
