// SPDX-License-Identifier: Apache-2.0
/**
 * The page of a class with a world for each pupil (class.html): a pupil is sent there; a teacher sees a card of
 * each, with a live picture, and does for all at once what a teacher may do in one world.
 */

import {unionOf} from './view/body_path.js';
import {Camera} from './view/camera.js';
import {personWord} from './people.js';
import {sayForm} from './ui/people_dialog.js';
import {Connection} from './connection.js';
import {Dialog} from './ui/dialog.js';
import {choice, createElement, elementOf, iconButton, inRow, languageField, showText, soon, textButton} from './dom.js';
import {SceneView} from './view/scene_view.js';
import {answerText, showResults} from './ui/results.js';
import {watchTheme} from './view/theme.js';
import {capital, language, said, t} from './strings.js';
import {Words} from './words.js';
import {WorldState} from './world_state.js';

/** @import {Classmate} from './types.js' */
/** @import {Together} from './ui/together.js' */

const KEY = 'physsim-seat'; // of this browser
const PERIOD = 3000; // ms between two looks at who is where
const GAP = 4; // px around the world in its picture

/** A card of a teacher's page: a seat, its pupil, and the world there, as it is now. */
class Card {
  /** @param {number} number of the seat */
  constructor(number) {
    this.left = false; // whether a body has left what its lesson shows first, since the lesson began
    this.seated = ''; // name of the pupil who has the seat
    this.frozen = false;
    this.running = false;
    this.reached = true; // whether the world answers, as far as anybody knows
    this.raisedAt = 0; // [ms] when the hand was raised; 0 where it is down
    this.name = createElement('a', {target: '_blank', rel: 'noopener'});
    this.lesson = createElement('small');
    this.answer = createElement('p');
    this.state = createElement('small', {className: 'state'});
    this.hand = iconButton(t('Lower the hand'), 'raise', () => this.lowerHand());
    this.hand.hidden = true;
    const canvas = createElement('canvas', {role: 'img'}), more = iconButton(t('More'), 'more', () => this.showMore());
    this.element = createElement('li', {}, inRow(this.name, this.state, this.hand, more), canvas, inRow(this.lesson, this.answer));
    const connection = this.connection = new Connection(`/ws/${number}`);
    this.world = new WorldState(connection);
    this.view = new SceneView(canvas, this.world, new Camera());
    this.words = new Words(connection);
    /** @type {?Classmate | undefined} null until the world has told who is there */
    this.pupil = null;
    this.view.overlays.push(() => this.#frame());
    this.#listen();
    connection.connect();
  }

  #listen() {
    const {connection} = this;
    connection.on('scene', () => this.show());
    connection.on('frame', () => {
      const {paused} = this.world;
      if (this.running !== paused) return;
      this.running = !paused;
      this.show();
    });
    connection.on('class', ({people, frozen}) => {
      this.pupil = people.find((/** @type {Classmate} */ {role}) => role === 'draw');
      this.frozen = frozen;
      this.raisedAt = this.pupil?.raised ? this.raisedAt || performance.now() : 0;
      this.show();
    });
    for (const [type, reached] of /** @type {const} */ ([['open', true], ['heard', true], ['silent', false], ['closed', false]])) {
      connection.on(type, () => {
        this.reached = reached;
        this.show();
      });
    }
  }

  /** Frame what the lesson shows first; once a body has left that, the whole world. */
  #frame() {
    const {world, view} = this, {bounds, epoch} = world.scene;
    this.#noteLeft();
    // A world without bounds keeps its frame until it changes.
    view.frame(this.left && bounds.length ? unionOf([world.extent(), bounds]) : world.extent(), GAP, `${epoch} ${this.left}`);
  }

  /** Note whether a body has left what its lesson shows first. */
  #noteLeft() {
    const {world, world: {scene: {lesson}, frame: {time}}} = this;
    if (!lesson?.view || !time) this.left = false;
    else if (!this.left) {
      const first = world.extent(), reached = unionOf([first, ...world.boxes]);
      this.left = reached.some((edge, i) => edge !== first[i]);
    }
  }

  /** @returns {string} name of who is there, or has the seat; '' where it is free */
  get person() {
    return this.seated || (this.pupil ? personWord(this.pupil.name) : '');
  }

  /** @param {{name: string, address: string}} seat */
  sit({name, address}) {
    this.seated = name;
    this.name.href = `${address}#class=${encodeURIComponent(this.person)}`;
    this.show();
  }

  lowerHand() {
    if (this.pupil) this.connection.send('lower_hand', {page: this.pupil.page});
  }

  show() {
    const {pupil, person, element, world: {scene: {lesson}}} = this, answered = pupil?.answered;
    showText(this.name, person || t('free'));
    this.view.canvas.ariaLabel = worldOf(person);
    element.classList.toggle('free', !person);
    element.classList.toggle('away', !pupil);
    element.classList.toggle('raised', this.raisedAt > 0);
    this.hand.hidden = !this.raisedAt;
    const here = this.reached ? person && pupil === undefined && t('not here') : t('does not answer');
    showText(this.state, [here, this.running ? '▶' : '❚❚', ...this.frozen ? [t('frozen')] : []].filter(Boolean).join(' · '));
    this.state.title = this.running ? t('playing') : t('paused');
    showText(this.lesson, lesson ? `${lesson.number}. ${t(lesson.title)}` : t('no lesson'));
    const known = answered && answered.lesson === lesson?.title;
    const unit = lesson?.unit === '1' ? '' : lesson?.unit, verdict = answered?.right ? t('✓ right') : t('✗ not yet');
    showText(this.answer, known ? `${answerText(answered.answer)} ${unit} ${verdict}` : '');
    this.answer.className = known && answered.right ? 'right' : '';
    arrangeSoon();
  }

  /** Have all other worlds begin as this run began, and play: they do the same to the bit. */
  async #showRun() {
    dialog.close();
    const {ok, values} = await this.connection.ask('share', {run: true});
    for (const {connection} of ok ? cards.filter((card) => card !== this) : []) {
      connection.send('open_text', {world: values.yaml});
      connection.send('service', {name: 'play'});
    }
  }

  /** Show what a teacher may do for this pupil alone. */
  showMore() {
    const {connection, frozen, person} = this;
    const done = (/** @type {string} */ type, /** @type {Record<string, unknown>} */ fields) => {
      connection.send(type, fields);
      dialog.close();
    };
    dialog.show(worldOf(person), ...person ? [sayForm((text) => done('say', {text}), t('Message to {name}', {name: person}))] : [], inRow(
      textButton(frozen ? t('Let them draw again') : t('Freeze'), () => done('freeze', {frozen: !frozen})),
      textButton(t('Pause'), () => done('service', {name: 'pause'})),
      textButton(t('Show this run to all'), () => this.#showRun()),
      ...this.seated ? [textButton(t('Free this seat'), async () => {
        // Before a next pupil comes.
        connection.send('leave');
        await ask('/free', {seat: cards.indexOf(this)});
        dialog.close();
      })] : []));
  }
}

const form = elementOf('join', HTMLFormElement), name = elementOf('name', HTMLInputElement);
const teacher = elementOf('teacher'), gone = elementOf('gone'), dialog = new Dialog();
/** @type {Card[]} */
const cards = [];
/** @type {Together | undefined} */
let together;

/** Put hands first, in the order in which they were raised, then people by their names, then free seats; and count. */
function arrange() {
  const hands = cards.filter(({raisedAt}) => raisedAt), here = cards.filter(({pupil}) => pupil);
  const order = [...cards].sort((one, other) => (one.raisedAt || Infinity) - (other.raisedAt || Infinity) ||
    Number(!one.person) - Number(!other.person) || one.person.localeCompare(other.person, language));
  const seats = elementOf('seats'), focused = document.activeElement;
  if (order.some(({element}, place) => element !== seats.children[place])) seats.append(...order.map(({element}) => element));
  // An element that is moved loses the focus.
  if (focused instanceof HTMLElement) focused.focus({preventScroll: true});
  showText(elementOf('present'), [t('{count} of {all} here', {count: here.length, all: cards.length}),
    ...hands.length ? [t('hands raised: {count}', {count: hands.length})] : []].join(' · '));
}

/** @param {string} person '' where it is free */
function worldOf(person) {
  return person ? t('World of {name}', {name: person}) : t('Free world');
}

const arrangeSoon = soon(arrange, 100);

/**
 * @param {string} path
 * @param {Record<string, unknown>} fields
 * @returns {Promise<?Response>} null where the class does not answer
 */
function ask(path, fields) {
  return fetch(path, {method: 'POST', headers: {Accept: 'application/json'}, body: JSON.stringify(fields)}).catch(() => null);
}

form.addEventListener('submit', async (event) => {
  event.preventDefault();
  const response = await ask('/join', {name: name.value, key: localStorage.getItem(KEY) ?? ''});
  if (!response?.ok) {
    const answer = await response?.json().catch(() => null);
    elementOf('refused').textContent = answer?.text ? capital(said(answer.text)) : t('The class is not reachable: try again.');
    return;
  }
  const {address, key} = await response.json();
  localStorage.setItem(KEY, key);
  location.assign(address);
});

async function showSeats() {
  /** @type {?{teacher?: boolean, seats?: {name: string, address: string}[], pupils?: string}} null where there is no answer */
  const known = await fetch('/seats', {signal: AbortSignal.timeout(PERIOD)}).then((response) => response.ok ? response.json() : {}).catch(() => null);
  gone.hidden = known !== null || teacher.hidden;
  gone.textContent = t('The class is not reachable. This page comes back with it.');
  if (known?.teacher) showClass(known.seats ?? [], known.pupils ?? '');
  // A pupil's page has nothing to look at.
  if (known?.teacher || !teacher.hidden) setTimeout(showSeats, PERIOD);
}

/**
 * @param {{name: string, address: string}[]} seats
 * @param {string} pupils address of pupils
 */
function showClass(seats, pupils) {
  // The class has begun anew, of another size.
  if (cards.length && cards.length !== seats.length) location.reload();
  if (teacher.hidden) begin(seats.length, pupils);
  seats.forEach((seat, i) => cards[i]?.sit(seat));
}

/**
 * Begin to watch the worlds of a class.
 * @param {number} count of seats
 * @param {string} pupils address of pupils
 */
function begin(count, pupils) {
  form.hidden = true;
  teacher.hidden = false;
  elementOf('title').textContent = t('Your class');
  document.querySelector('main')?.classList.add('wide');
  for (let number = 0; number < count; number++) cards.push(new Card(number));
  elementOf('seats').append(...cards.map(({element}) => element));
  const toAll = (/** @type {string} */ type, /** @type {Record<string, unknown>} */ fields) => {
    for (const {connection} of cards) connection.send(type, fields);
  };
  /** @type {{name: string, number: number, title: string}[]} */
  let listed = [];
  const lessons = choice(t('Lesson'), [], '', () => {});
  cards[0].connection.on('worlds', ({lessons: list}) => {
    const chosen = lessons.value;
    listed = list;
    lessons.replaceChildren(...listed.map((each) => createElement('option', {value: each.name, textContent: `${each.number}. ${t(each.title)}`})));
    if (chosen) lessons.value = chosen;
  });
  // A lesson may have been written meanwhile.
  lessons.onfocus = () => cards[0].connection.send('list');
  // No link: it would make a pupil of the teacher's browser.
  const showCode = () => dialog.show(t('Pupils come here'), createElement('img', {src: '/qr.svg', className: 'code', alt: t('QR code of the address of pupils')}),
    createElement('p', {id: 'pupils'}, pupils));
  elementOf('all').append(textButton(t('Pupils come here'), showCode), lessons,
    textButton(t('Open the lesson for all'), () => cards.forEach(({connection}) => connection.openLesson(lessons.value))),
    textButton(t('Play all'), () => toAll('service', {name: 'play'})),
    textButton(t('Pause all'), () => toAll('service', {name: 'pause'})),
    textButton(t('Freeze all'), () => toAll('freeze', {frozen: true})),
    textButton(t('Let them draw again'), () => toAll('freeze', {frozen: false})),
    textButton(t('Clear all worlds'), () => confirm(t('Delete all bodies of all worlds?')) && toAll('service', {name: 'clear'}), 'danger'),
    textButton(t('All runs in one picture'), async () => {
      const {Together} = await import('./ui/together.js');
      together ??= new Together(dialog, cards);
      together.show();
    }),
    textButton(t('Results'), () => showResults(dialog, listed, () => toAll('forget_results', {}))),
    sayForm((text) => toAll('say', {text})));
}

document.querySelector('main')?.append(inRow(languageField()));
watchTheme();
showSeats();
