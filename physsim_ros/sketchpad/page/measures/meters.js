// SPDX-License-Identifier: Apache-2.0
/** Meters: a quantity of a body, or the force of a joint, that stays beside it in the world, as somebody has chosen in its panel. */

import {checkField, choiceField} from '../dom.js';
import {jointTexts} from '../panels/joint_panel.js';
import {QUANTITIES, quantityText} from './quantities.js';
import {t} from '../strings.js';

/** @import {Parts, Point, SceneView} from '../types.js' */

const ABOVE = 22, PADDING = 6, HALF = 11; // px: from a body to its meter; beside the text; half of the height

export class Meters {
  /** @param {Parts<'connection' | 'records' | 'view' | 'world'>} parts */
  constructor(parts) {
    this.parts = parts;
    /** @type {Map<string, string>} quantities by body */
    this.bodies = new Map();
    /** @type {Set<string>} names */
    this.joints = new Set();
    parts.view.overlays.push((view) => this.#draw(view));
    parts.connection.on('world', () => {
      this.joints.clear();
      this.bodies.clear();
      this.#record();
    });
  }

  /**
   * @param {string} name of a body
   * @returns {HTMLElement} the choice of its meter
   */
  field(name) {
    const quantities = Object.entries(QUANTITIES).slice(1).map(([key, {label: each}]) => /** @type {[string, string]} */ ([key, each]));
    return choiceField(t('Meter in the world'), [['', t('none')], ...quantities], this.bodies.get(name) ?? '', (key) => {
      if (key) this.bodies.set(name, key);
      else this.bodies.delete(name);
      this.#record();
    });
  }

  /**
   * @param {string} name of a joint
   * @returns {HTMLElement} the switch of its meter
   */
  jointField(name) {
    return checkField(t('Meter in the world'), this.joints.has(name), (shown) => { this.joints[shown ? 'add' : 'delete'](name); });
  }

  #record() {
    this.parts.records.want(this, [...this.bodies.keys()]);
  }

  /** @param {SceneView} view */
  #draw(view) {
    const {world, records} = this.parts, {bodies, joints, gravity} = world.scene;
    for (const [name, key] of this.bodies) {
      const top = world.topOf(name), sample = records.now(name);
      if (top && sample) drawMeter(view, top, quantityText(key, QUANTITIES[key].of(sample, bodies[world.row(name)], gravity)));
    }
    for (const joint of joints) {
      if (!this.joints.has(joint.name)) continue;
      const [[px, py], [qx, qy]] = [world.place(joint.a, joint.points[0]), world.place(joint.b, joint.points[1])];
      drawMeter(view, [(px + qx) / 2, (py + qy) / 2], jointTexts(world, joint).slice(0, 2).join(' · '));
    }
  }
}

/**
 * @param {SceneView} view
 * @param {Point} place above which it stands [m]
 * @param {string} text
 */
function drawMeter({ctx, camera, palette, insets, covered}, place, text) {
  ctx.font = '600 13px system-ui, sans-serif';
  const half = ctx.measureText(text).width / 2 + PADDING, [atX, atY] = camera.toPage(...place);
  // What is in sight has its meter in sight.
  const x = Math.min(Math.max(atX, insets.left + half), camera.width - insets.right - half), y = Math.max(atY, insets.top + ABOVE + HALF);
  covered.push([x - half, y - ABOVE - HALF, x + half, y - ABOVE + HALF]);
  ctx.fillStyle = palette.paper;
  ctx.strokeStyle = palette.faint;
  ctx.lineWidth = 1;
  ctx.beginPath();
  ctx.roundRect(x - half, y - ABOVE - HALF, 2 * half, 2 * HALF, PADDING);
  ctx.fill();
  ctx.stroke();
  ctx.fillStyle = palette.ink;
  ctx.textAlign = 'center';
  ctx.fillText(text, x, y - ABOVE + HALF / 2);
}
