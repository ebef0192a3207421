// SPDX-License-Identifier: Apache-2.0
/** The panel of the selected bodies: properties of a body, its plots. */

import {createElement, elementOf, iconButton, inRow, textOf, textButton, textField} from './dom.js';
import {sizeOf} from './label_view.js';
import {Numbers} from './numbers.js';
import {Plots} from './plots.js';
import {gravityButtons, materialButtons} from './presets.js';
import {sendNote} from './tools/note.js';
import {isDrawn} from './words.js';

/** @import {App, Point} from './types.js' */

/** Key, label, least, most, step. @type {[string, string, number, number, number][]} */
const RANGES = [['density', 'Density [kg/m²]', 0.1, 10, 0.1], ['friction', 'Friction', 0, 2, 0.05],
  ['elasticity', 'Bounciness', 0, 1, 0.05]];
const STEP_OF_DIAL = Math.PI / 12; // rad
const COVERED = 80; // px: nearer to the edge of the panel, or beneath it, a body is covered
const BOTH = 720; // px: least width of a page with room for a panel and a lesson
const BESIDE = 0.5; // m: where a copy is put

export class BodyPanel {
  /** @param {App} app */
  constructor(app) {
    this.app = app;
    this.element = elementOf('panel', HTMLElement);
    this.plots = new Plots(app);
    this.numbers = new Numbers(app);
    this.name = '';
    this.shown = ''; // part of the scene that the panel shows, as text
    this.subject = ''; // that is shown
    /** @type {() => ?Point} */
    this.place = () => null; // of the subject in the world [m]
    this.turn = 0; // of gravity from down, counter-clockwise [rad]
    app.connection.on('scene', () => this.#follow());
  }

  close() {
    this.element.hidden = true;
    this.app.card?.update();
    this.name = '';
    this.app.refit();
    this.plots.watch('');
  }

  /** @param {string} name of a body */
  showBody(name) {
    const body = this.app.world.scene.bodies.find((each) => each.name === name);
    if (!body) return;
    this.name = name;
    const {app} = this, change = (/** @type {object} */ properties) =>
      app.connection.send('change', {name, properties});
    const anchored = createElement('input', {type: 'checkbox', checked: body.anchored,
      onchange: () => change({anchored: anchored.checked})});
    const gate = createElement('input', {type: 'checkbox', checked: body.sensor,
      onchange: () => change({sensor: gate.checked})});
    const label = textField({value: body.label, onchange: () => {
      const value = textOf(label), {height = 0} = body.shape, row = app.world.row(name);
      if (body.name.startsWith('note/') && height) {
        sendNote(app, name, value, [...app.world.place(row, [0, 0]), app.world.frame.yaw[row]], height / sizeOf(app.view.ctx, body.label)[1]);
      } else change({label: value});
    }});
    this.show(this.app.words.title(name), [
      this.numbers.element,
      ...body.robot ? this.app.driving.show(body.robot) : [],
      materialButtons(change),
      ...fields(body, change),
      createElement('label', {}, 'Label', label),
      // A robot is neither.
      ...body.robot ? [] : [createElement('label', {}, 'Anchored', anchored), createElement('label', {}, 'Gate: lets bodies through', gate)],
      inRow(
        textButton('Copy', () => this.copy()),
        textButton('Delete body', () => this.app.selection.deleteBodies(), 'danger')),
      createElement('p', {hidden: body.anchored, textContent: 'Drag the tip of the arrow to set the velocity, the round handle to turn, the square one to scale.'}),
      ...app.trail.switches(name),
      this.plots.element,
    ], isDrawn(name) ? name : '', () => {
      const row = app.world.row(name);
      return row < 0 ? null : app.world.place(row, app.world.scene.bodies[row].centroid);
    });
    this.shown = JSON.stringify(body);
    this.plots.watch(name);
  }

  /** Move the view where the panel covers its subject. */
  uncover() {
    const {app: {camera}, element} = this, {fitted} = camera, place = element.hidden ? null : this.place();
    if (!place) return;
    const {left, top, bottom} = element.getBoundingClientRect(), [x, y] = camera.toPage(...place);
    if (camera.narrow) camera.pan(0, Math.min(top - COVERED - y, 0));
    else if (y < bottom) camera.pan(Math.min(left - COVERED - x, 0), 0);
    camera.fitted = fitted;
  }

  /** @param {string[]} names of several bodies */
  showMany(names) {
    this.name = '';
    this.plots.watch('');
    this.show(`${names.length} bodies`, [
      createElement('p', {textContent: 'Drag them with the lasso.'}),
      inRow(textButton('Copy beside', () => {
        const [left, , right] = this.app.world.boundsOfAll(names);
        this.app.connection.send('copy_machine', {names, by: [right - left + BESIDE, 0]});
      }), textButton('Delete bodies', () => this.app.selection.deleteBodies(), 'danger'))]);
  }

  /** Show the material of the next drawings, and gravity. */
  showMaterial() {
    this.app.selection.select([]);
    const {app} = this, {scene} = app.world, {gravity: [gx, gy]} = scene, strength = Math.hypot(gx, gy);
    // As it was set last: the panel is not renewed while somebody works in it.
    let size = strength;
    if (strength) this.turn = Math.atan2(gx, -gy);
    const pull = () => {
      // The sine of a half turn is not exactly 0: nine digits are.
      app.connection.send('gravity', {gravity: [Math.sin(this.turn) * size, -Math.cos(this.turn) * size].map((each) => Number(each.toFixed(9)))});
    };
    const setSize = (/** @type {number} */ value) => {
      size = value;
      pull();
    };
    const change = (/** @type {any} */ properties) => {
      Object.assign(app.material, properties);
      app.connection.send('draw_with', properties);
    };
    const chosen = app.material.color ?? app.color, color = chosen || [0.3, 0.47, 0.66];
    const any = createElement('input', {type: 'checkbox', checked: !chosen,
      onchange: () => change({color: any.checked ? '' : hexOf(color)})});
    this.show('Material of new bodies', [
      materialButtons((preset) => {
        change(preset);
        this.showMaterial();
      }),
      ...fields({...scene, ...app.material, color}, (properties) => {
        if (properties.color) any.checked = false;
        change(properties);
      }),
      createElement('label', {}, 'Each body another colour', any),
      createElement('h3', {textContent: 'Gravity'}),
      range('Gravity [m/s²]', 0, 25, 0.01, strength, setSize),
      gravityButtons(setSize),
      createElement('label', {}, 'Direction', dial(this.turn, (angle) => {
        this.turn = angle;
        pull();
      })),
      range('Air drag [of the speed, each second]', 0, 0.95, 0.05, scene.damping, (damping) => app.connection.send('air', {damping})),
      createElement('label', {}, 'Sound of impacts', createElement('input', {type: 'checkbox', checked: app.sound.on, onchange: () => {
        app.sound.toggle();
        app.askForParts();
      }}))]);
    this.shown = this.#worldKey();
  }

  /** @returns {string} what the panel of the world shows */
  #worldKey() {
    const {gravity, damping, density, friction, elasticity} = this.app.world.scene;
    return JSON.stringify([gravity, damping, density, friction, elasticity]);
  }

  copy() {
    const {world, connection} = this.app, row = world.row(this.name);
    if (row >= 0) connection.send('copy', {name: this.name,
      to: [world.frame.x[row] + BESIDE, world.frame.y[row] + BESIDE]});
  }

  /**
   * @param {string} title
   * @param {Node[]} content
   * @param {string} name of the body, where that is not the title
   * @param {() => ?Point} place of the subject in the world [m]
   */
  show(title, content, name = '', place = () => null) {
    this.shown = '';
    this.element.replaceChildren(createElement('header', {},
      createElement('h2', {}, `${title} `, createElement('small', {textContent: name})),
      iconButton('Close', 'close', () => this.app.selection.select([]))), ...content);
    this.element.hidden = false;
    if (this.app.camera.width < BOTH) this.app.lessons.card.open = false;
    // The panel of the same body stays where it was scrolled to.
    const subject = title + name;
    if (subject !== this.subject) this.element.scrollTop = 0;
    this.subject = subject;
    this.app.card?.update();
    this.place = place;
    this.uncover();
  }

  /** Follow a scene in which the body was changed or deleted, by whomever. */
  #follow() {
    if (!this.name) {
      if (!this.element.hidden && this.shown && this.shown !== this.#worldKey() && !this.element.contains(document.activeElement)) {
        queueMicrotask(() => this.showMaterial());
      }
      return;
    }
    const body = this.app.world.scene.bodies.find(({name}) => name === this.name);
    if (!body) this.app.selection.select([]);
    else if (JSON.stringify(body) !== this.shown && !this.element.contains(document.activeElement)) {
      queueMicrotask(() => this.showBody(this.name));
    }
  }
}

/**
 * @param {any} values by key
 * @param {(properties: any) => void} change
 * @returns {HTMLElement[]}
 */
function fields(values, change) {
  const color = createElement('input', {type: 'color', value: hexOf(values.color), onchange: () => change({color: color.value})});
  return [
    ...RANGES.map(([key, label, least, most, step]) => range(label, least, most, step, values[key],
      (value) => change({[key]: value}))),
    createElement('label', {}, 'Colour', color)];
}

/**
 * @param {number[] | string} color channels, each 0 .. 1, or as hexOf returns it
 * @returns {string} as inputs have it
 */
function hexOf(color) {
  if (typeof color === 'string') return color;
  return `#${color.slice(0, 3).map((channel) =>
    Math.round(255 * channel).toString(16).padStart(2, '0')).join('')}`;
}

/**
 * @param {string} label
 * @param {number} min
 * @param {number} max
 * @param {number} step
 * @param {number} value
 * @param {(value: number) => void} change when it is let go
 */
export function range(label, min, max, step, value, change) {
  const typed = createElement('input', {type: 'number', min, step: 'any', value: Number(value.toPrecision(6)), 'aria-label': `${label}, typed`,
    onchange: () => typed.value !== '' && change(Number(typed.value))});
  const input = createElement('input', {type: 'range', min, max: Math.max(max, value), step, value, 'aria-label': label,
    oninput: () => { typed.value = input.value; },
    onchange: () => change(Number(input.value))});
  return createElement('div', {className: 'field'}, createElement('span', {textContent: label}), typed, input);
}

/**
 * A compass that is dragged, or turned by arrow keys.
 * @param {number} turn from down, counter-clockwise [rad]
 * @param {(turn: number) => void} change
 */
function dial(turn, change) {
  const canvas = createElement('canvas', {className: 'dial', width: 144, height: 144, tabIndex: 0, role: 'slider', 'aria-label': 'Direction of gravity',
    'aria-valuemin': -180, 'aria-valuemax': 180});
  const ctx = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  const show = () => {
    const degrees = Math.round(turn * 180 / Math.PI), x = Math.sin(turn), y = Math.cos(turn);
    canvas.setAttribute('aria-valuenow', String(degrees));
    canvas.setAttribute('aria-valuetext', degrees ? `${degrees}° from down` : 'down');
    ctx.setTransform(1, 0, 0, 1, 72, 72);
    ctx.clearRect(-72, -72, 144, 144);
    ctx.lineWidth = 6;
    ctx.lineCap = 'round';
    ctx.strokeStyle = getComputedStyle(document.documentElement).getPropertyValue('--weight');
    ctx.beginPath();
    for (const [along, across] of [[-50, 0], [50, 0], [28, 18], [50, 0], [28, -18]]) ctx.lineTo(x * along + y * across, y * along - x * across);
    ctx.stroke();
  };
  const point = (/** @type {PointerEvent} */ {clientX, clientY, buttons}) => {
    if (!buttons) return;
    const {left, top, width} = canvas.getBoundingClientRect();
    const angle = Math.atan2(clientX - left - width / 2, clientY - top - width / 2);
    turn = Math.round(angle / STEP_OF_DIAL) * STEP_OF_DIAL;
    show();
  };
  canvas.onpointerdown = (event) => {
    canvas.setPointerCapture(event.pointerId);
    point(event);
  };
  canvas.onpointermove = point;
  canvas.onpointerup = () => change(turn);
  canvas.onkeydown = (event) => {
    const by = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1}[event.key];
    if (!by) return;
    event.preventDefault();
    event.stopPropagation();
    turn += by * STEP_OF_DIAL;
    show();
    change(turn);
  };
  show();
  return canvas;
}
