// SPDX-License-Identifier: Apache-2.0
/** The panel of a joint that was tapped: its constants, its force now, and deletion. */

import {choiceField, createElement, inRow, labelled, numberField, range, showText, textButton} from '../dom.js';
import {ALONG_AXIS, ALONG_LINE, AT_POINT} from '../joint_kinds.js';
import {threeDigits} from '../rounding.js';
import {capital, server, t} from '../strings.js';
import {distance} from '../vectors.js';
import {isDrawn} from '../words.js';

/** @import {Joint, Parts, WorldState} from '../types.js' */
/** @import {Content} from './panel.js' */

/**
 * Property, label, greatest and step of its slider, and its value where none was set.
 * @type {Record<string, [keyof Joint, string, number, number, number][]>}
 */
const CONSTANTS = {
  spring: [['stiffness', t('Spring constant [N/m]'), 500, 1, 100], ['rest_length', t('Rest length [m]'), 5, 0.01, 0],
    ['damping', t('Damping [N s/m]'), 20, 0.1, 0]],
  rope: [['length', t('Length [m]'), 10, 0.01, 0], ['rate', t('Rate of a winch [m/s]'), 2, 0.05, 0]],
  slider: [['rate', t('Rate of its drive [m/s]'), 2, 0.05, 0], ['friction', t('Friction [N]'), 50, 0.1, 0]],
  axle: [['stiffness', t('Torsion spring [N m/rad]'), 100, 0.1, 0], ['rest_angle', t('Angle at rest [rad]'), 3.2, 0.01, 0],
    ['damping', t('Damping [N m s/rad]'), 20, 0.1, 0], ['friction', t('Friction [N m]'), 20, 0.1, 0]],
  motor: [['rate', t('Rate [rad/s]'), 20, 0.1, 1], ['max_torque', t('Greatest torque [N m]'), 1000, 1, 1000]],
  gear: [['ratio', t('Ratio'), 5, 0.1, 1]],
};
const SIGNED = ['rate', 'ratio', 'rest_angle'];
const LIMITED = ['axle', 'slider'];
/** What an axle bears a torque by. @type {(keyof Joint)[]} */
const TURNED = ['stiffness', 'damping', 'friction', 'ratchet', 'effort', 'lower', 'upper'];
const RING = 9; // px: at its ends

/**
 * @param {Parts<'connection' | 'meters' | 'selection' | 'words' | 'world'>} parts
 * @param {string[]} names of the joint alone
 * @returns {?Content} null where it is gone
 */
export function jointContent({world, connection, selection, meters, words}, [name]) {
  const findNumber = () => world.scene.joints.findIndex((each) => each.name === name), joint = world.scene.joints[findNumber()];
  if (!joint) return null;
  const change = (/** @type {Record<string, number | string | null>} */ properties) => connection.send('change_joint', {name, properties});
  const unit = joint.kind === 'slider' ? 'm' : 'rad', force = createElement('p');
  /** @type {['lower' | 'upper' | 'max_force' | 'break_force', string][]} */
  const limits = [['break_force', t('Breaks at [{unit}]', {unit: unitOf(joint)})]];
  if (['rope', 'slider'].includes(joint.kind)) limits.unshift(['max_force', t('Greatest force [N]')]);
  if (LIMITED.includes(joint.kind)) limits.unshift(['lower', t('Least [{unit}]', {unit})], ['upper', t('Greatest [{unit}]', {unit})]);
  return {title: capital(server(joint.kind)), name: isDrawn(name) || world.scene.lesson ? '' : name, first: [force], rest: [
    ...(CONSTANTS[joint.kind] ?? []).map(([key, label, most, step, otherwise]) => {
      const value = Number(key === 'length' ? joint.length ?? joint.rest_length : joint[key] ?? otherwise);
      return range(label, SIGNED.includes(key) ? -most : 0, most, step, value, (now) => change({[key]: now}));
    }),
    ...joint.effort === undefined ? [] : [range(t('Motor goes to [{unit}]', {unit}), joint.lower ?? -Math.PI, joint.upper ?? Math.PI, 0.01, 0,
      (position) => connection.send('motor', {name, position}))],
    ...joint.kind === 'axle' ? [ratchetField(joint, (ratchet) => change({ratchet}))] : [],
    ...joint.kind === 'gear' ? [carrierField(joint, world, words, (carrier) => change({carrier}))] : [],
    ...limits.map(([key, label]) =>
      labelled(label, numberField(joint[key] ?? null, (value) => change({[key]: value}), {placeholder: t('none')}))),
    meters.jointField(name),
    inRow(textButton(t('Delete joint'), () => selection.deleteSelected(), 'danger')),
  ], live: (view) => {
    const number = findNumber(), now = world.scene.joints[number];
    if (!now) return;
    showText(force, t('Force now: {force}', {force: jointTexts(world, now).join(' · ')}));
    view.ring(world.place(now.a, now.points[0]), RING, view.palette.accent);
    if (now.points[1] && now.kind !== 'slider') view.ring(world.place(now.b, now.points[1]), RING, view.palette.accent);
  }};
}

/**
 * @param {Joint} axle
 * @param {(direction: ?number) => void} change
 * @returns {HTMLElement} a choice of the direction in which an axle turns
 */
function ratchetField(axle, change) {
  /** @type {[string, string][]} */
  const directions = [['', t('both ways')], ['1', t('counter-clockwise')], ['-1', t('clockwise')]];
  return choiceField(t('Turns'), directions, String(axle.ratchet ?? ''), (chosen) => change(Number(chosen) || null));
}

/**
 * @param {Joint} gear
 * @param {WorldState} world
 * @param {Parts<'words'>['words']} words
 * @param {(name: ?string) => void} change
 * @returns {HTMLElement} a choice of the body about which the angles of a gear are measured
 */
function carrierField(gear, world, words, change) {
  const wheels = [gear.a, gear.b].map((row) => world.scene.bodies[row]?.name);
  const bodies = words.choices(t('none')).filter(([name]) => !wheels.includes(name));
  return choiceField(t('About the arm'), bodies, gear.carrier ?? '', (name) => change(name || null));
}

/**
 * @param {WorldState} world
 * @param {Joint} joint
 * @returns {string[]} its force, how long it is, and the energy of a spring
 */
export function jointTexts(world, joint) {
  const {kind, a, b, points: [p, q], rest_length: rest, stiffness = 100, guides} = joint;
  const force = `${threeDigits(world.frame.forces?.[world.scene.joints.indexOf(joint)] ?? 0)} ${unitOf(joint)}`;
  if (!ALONG_LINE.includes(kind) || guides) return [force];
  const length = distance(world.place(a, p), world.place(b, q)), texts = [force, t('length {length} m', {length: threeDigits(length)})];
  return kind === 'spring' ? [...texts, t('energy {energy} J', {energy: threeDigits(stiffness * (length - rest) ** 2 / 2)})] : texts;
}

/**
 * @param {Joint} joint
 * @returns {string} the unit of its force; of one that bears a torque, too, the greater number counts
 */
function unitOf(joint) {
  if (joint.kind === 'gear') return 'N m';
  const turns = joint.kind === 'axle' && !TURNED.some((key) => joint[key]);
  const bearsBoth = [...AT_POINT, ...ALONG_AXIS].includes(joint.kind) && !turns;
  return bearsBoth ? t('N or N m') : 'N';
}
