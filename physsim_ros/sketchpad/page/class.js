// SPDX-License-Identifier: Apache-2.0
/**
 * The page of a class with a world for each pupil (class.html): a pupil is sent there; a teacher sees a card of
 * each, with a live picture, and does for all at once what a teacher may do in one world.
 */

import {Camera} from './view/camera.js';
import {sayForm} from './ui/classroom.js';
import {Connection} from './connection.js';
import {choice, createElement, elementOf, inRow, languageField, textButton} from './dom.js';
import {SceneView} from './view/scene_view.js';
import {watchTheme} from './view/theme.js';
import {t} from './strings.js';
import {WorldState} from './world_state.js';

/** @import {Classmate} from './types.js' */

const KEY = 'physsim-seat'; // of this browser
const PERIOD = 3000; // ms between two looks at who is where
const GAP = 4; // px around the world in its picture

/** A card of a teacher's page: a seat, its pupil, and the world there, as it is now. */
class Card {
  /** @param {number} number of the seat */
  constructor(number) {
    this.framed = -1; // epoch of the scene that was framed
    this.width = 0; // of the picture then [px]
    this.name = createElement('a', {target: '_blank', rel: 'noopener'});
    this.lesson = createElement('small');
    this.answer = createElement('p');
    this.hand = createElement('strong', {textContent: t('hand raised'), hidden: true});
    const canvas = createElement('canvas', {role: 'img'});
    this.element = createElement('li', {}, inRow(this.name, this.hand), canvas, this.lesson, this.answer);
    const connection = this.connection = new Connection(`/ws/${number}`), camera = new Camera();
    this.world = new WorldState(connection);
    this.view = new SceneView(canvas, this.world, camera);
    this.canvas = canvas;
    /** @type {Classmate | undefined} */
    this.pupil = undefined;
    connection.on('frame', () => {
      const {scene} = this.world;
      if (scene.epoch === this.framed && camera.width === this.width) return;
      // A world without bounds keeps its frame until it changes.
      [this.framed, this.width] = [scene.epoch, camera.width];
      camera.fit(this.world.extent(), {left: GAP, top: GAP, right: GAP, bottom: GAP});
      this.show();
    });
    connection.on('class', ({people}) => {
      this.pupil = people.find((/** @type {Classmate} */ {role}) => role === 'draw');
      this.show();
    });
    connection.connect();
  }

  /** @param {{name: string, address: string}} seat */
  sit({name, address}) {
    this.name.href = address;
    this.name.textContent = name || t('free');
    this.element.classList.toggle('free', !name);
    this.canvas.ariaLabel = t('World of {name}', {name: name || t('nobody')});
  }

  show() {
    const {pupil, world: {scene: {lesson}}} = this, answered = pupil?.answered;
    this.lesson.textContent = lesson ? `${lesson.number}. ${t(lesson.title)}` : t('no lesson');
    this.hand.hidden = !pupil?.raised;
    const known = answered && answered.lesson === lesson?.title;
    const unit = lesson?.unit === '1' ? '' : lesson?.unit, verdict = answered?.right ? t('✓ right') : t('✗ not yet');
    this.answer.textContent = known ? `${answered.answer} ${unit} ${verdict}` : '';
    this.answer.className = known && answered.right ? 'right' : '';
    this.element.classList.toggle('raised', Boolean(pupil?.raised));
  }
}

const form = elementOf('join', HTMLFormElement), name = elementOf('name', HTMLInputElement);
const teacher = elementOf('teacher');
/** @type {Card[]} */
const cards = [];

form.addEventListener('submit', async (event) => {
  event.preventDefault();
  const response = await fetch('/join', {method: 'POST', body: JSON.stringify({name: name.value, key: localStorage.getItem(KEY) ?? ''})});
  if (!response.ok) {
    elementOf('refused').textContent = await response.text();
    return;
  }
  const {address, key} = await response.json();
  localStorage.setItem(KEY, key);
  location.assign(address);
});

async function showSeats() {
  const {teacher: teaches, seats, pupils} = await fetch('/seats').then((response) => response.json(), () => ({}));
  if (!teaches) return;
  form.hidden = true;
  if (teacher.hidden) begin(seats.length);
  teacher.hidden = false;
  // No link: it would make a pupil of the teacher's browser.
  elementOf('pupils').textContent = pupils;
  seats.forEach((/** @type {{name: string, address: string}} */ seat, /** @type {number} */ i) => cards[i].sit(seat));
  setTimeout(showSeats, PERIOD);
}

/**
 * Begin to watch the worlds of a class.
 * @param {number} count of seats
 */
function begin(count) {
  document.querySelector('main')?.classList.add('wide');
  teacher.querySelector('img')?.setAttribute('src', '/qr.svg');
  for (let number = 0; number < count; number++) cards.push(new Card(number));
  elementOf('seats').append(...cards.map(({element}) => element));
  const toAll = (/** @type {string} */ type, /** @type {Record<string, unknown>} */ fields) => {
    for (const {connection} of cards) connection.send(type, fields);
  };
  const lessons = choice(t('Lesson'), [], '', () => {});
  cards[0].connection.on('worlds', ({lessons: list}) => lessons.replaceChildren(...list.map(
    (/** @type {{name: string, number: number, title: string}} */ each) =>
      createElement('option', {value: each.name, textContent: `${each.number}. ${t(each.title)}`}))));
  // A lesson may have been written meanwhile.
  lessons.onpointerdown = () => cards[0].connection.send('list');
  elementOf('all').append(inRow(lessons,
    textButton(t('Open the lesson for all'), () => cards.forEach(({connection}) => connection.openLesson(lessons.value))),
    textButton(t('Pause all'), () => toAll('service', {name: 'pause'})),
    textButton(t('Freeze all'), () => toAll('freeze', {frozen: true})),
    textButton(t('Let them draw again'), () => toAll('freeze', {frozen: false})),
    textButton(t('Clear all worlds'), () => confirm(t('Delete all bodies of all worlds?')) && toAll('service', {name: 'clear'}), 'danger')),
  sayForm((text) => toAll('say', {text})));
}

document.querySelector('main')?.append(inRow(languageField()));
watchTheme();
showSeats();
