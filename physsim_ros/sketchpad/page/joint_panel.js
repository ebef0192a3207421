// SPDX-License-Identifier: Apache-2.0
/** The panel of a joint that was tapped: its constants, its force now, and deletion. */

import {createElement, inRow, numberField, range, textButton} from './dom.js';
import {threeDigits} from './rounding.js';
import {t} from './strings.js';
import {capital, isDrawn, thingWord} from './words.js';

/** @import {App, Joint, SceneView} from './types.js' */
/** @import {Content} from './panel.js' */

/**
 * Property, label, greatest and step of its slider, and its value where none was set.
 * @type {Record<string, [keyof Joint, string, number, number, number][]>}
 */
const CONSTANTS = {
  spring: [['stiffness', t('Spring constant [N/m]'), 500, 1, 100], ['rest_length', t('Rest length [m]'), 5, 0.01, 0],
    ['damping', t('Damping [N s/m]'), 20, 0.1, 0]],
  rope: [['length', t('Length [m]'), 10, 0.01, 0]],
  motor: [['rate', t('Rate [rad/s]'), 20, 0.1, 1], ['max_torque', t('Greatest torque [N m]'), 1000, 1, 1000]],
  gear: [['ratio', t('Ratio'), 5, 0.1, 1]],
};
const MEASURED = ['spring', 'rod', 'rope'], LIMITED = ['axle', 'slider'];

export class JointPanel {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.force = createElement('p');
    app.view.overlays.push((view) => this.#draw(view));
  }

  /** @returns {number} of the joint in the scene; -1 where it is gone */
  get #number() {
    return this.app.world.scene.joints.findIndex(({name}) => name === this.app.panel.joint);
  }

  /**
   * @param {string} name of a joint
   * @returns {?Content} null where it is gone
   */
  content(name) {
    const joint = this.app.world.scene.joints[this.#number];
    if (!joint) return null;
    const change = (/** @type {Record<string, ?number>} */ properties) =>
      this.app.connection.send('change_joint', {name, properties});
    const unit = joint.kind === 'slider' ? 'm' : 'rad';
    /** @type {['lower' | 'upper' | 'break_force', string][]} */
    const limits = [['break_force', t('Breaks at [N]')]];
    if (LIMITED.includes(joint.kind)) limits.unshift(['lower', t('Least [{unit}]', {unit})], ['upper', t('Greatest [{unit}]', {unit})]);
    return {title: capital(thingWord(joint.kind)), name: isDrawn(name) ? '' : name, first: [this.force], rest: [
      ...(CONSTANTS[joint.kind] ?? []).map(([key, label, most, step, otherwise]) => {
        const value = Number(key === 'length' ? joint.length ?? joint.rest_length : joint[key] ?? otherwise);
        return range(label, key === 'rate' || key === 'ratio' ? -most : 0, most, step, value, (now) => change({[key]: now}));
      }),
      ...limits.map(([key, label]) =>
        createElement('label', {}, label, numberField(joint[key] ?? null, (value) => change({[key]: value}), {placeholder: t('none')}))),
      inRow(textButton(t('Delete joint'), () => this.delete(), 'danger')),
    ]};
  }

  delete() {
    this.app.connection.send('unjoin', {name: this.app.panel.joint});
    this.app.selection.select([]);
  }

  /** @param {SceneView} view */
  #draw(view) {
    const {world} = this.app, number = this.#number, joint = world.scene.joints[number];
    if (!joint) return;
    const force = [t('Force now: {force} N', {force: threeDigits(world.frame.forces?.[number] ?? 0)}), ...this.#lengthNow(joint)].join(' · ');
    if (this.force.textContent !== force) this.force.textContent = force;
    view.ring(world.place(joint.a, joint.points[0]), 9, view.palette.accent);
    if (joint.points[1] && joint.kind !== 'slider') view.ring(world.place(joint.b, joint.points[1]), 9, view.palette.accent);
  }

  /**
   * @param {Joint} joint
   * @returns {string[]} how long it is, and the energy of a spring
   */
  #lengthNow({kind, a, b, points: [p, q], rest_length: rest, stiffness = 100}) {
    if (!MEASURED.includes(kind)) return [];
    const {world} = this.app, [ax, ay] = world.place(a, p), [bx, by] = world.place(b, q);
    const length = Math.hypot(bx - ax, by - ay), text = t('length {length} m', {length: threeDigits(length)});
    return kind === 'spring' ? [text, t('energy {energy} J', {energy: threeDigits(stiffness * (length - rest) ** 2 / 2)})] : [text];
  }
}
