// SPDX-License-Identifier: Apache-2.0
/**
 * Answers in the words of people. The server's texts, which other nodes and logs have too, name bodies by their names:
 * `spawned drawn/3` is *Circle added* here.
 */

import {capital, refusalText, said, server, t} from './strings.js';

/** @import {Body, Connection, Text} from './types.js' */

const LISTED = 200; // bodies that can be chosen from
const LONGEST = 52, HEAD = 24, TAIL = 12; // characters of a name that is shown whole, and of both ends of others

export class Words {
  /** @param {Connection} connection */
  constructor(connection) {
    /** Words for bodies of the last scene, and of the one before: answers come before and after theirs. */
    this.known = /** @type {Map<string, string>[]} */ ([new Map(), new Map()]);
    /** @type {Body[]} of the last scene */
    this.bodies = [];
    /** What worlds and lessons that can be opened are called, by their names. @type {Map<string, string>} */
    this.titles = new Map();
    connection.on('worlds', (/** @type {Record<'worlds' | 'lessons', {name: string, title: string, shipped: boolean}[]>} */ {worlds, lessons}) => {
      this.titles = new Map();
      for (const world of worlds) this.titles.set(world.name, headingOf(world));
      for (const {name, title} of lessons) this.titles.set(name, t(title));
    });
    connection.on('scene', ({bodies, lesson}) => {
      this.bodies = bodies;
      this.known = [new Map(lesson ? lessonWords(this.bodies) : []), this.known[0]];
      for (const body of this.bodies) {
        if (isDrawn(body.name)) this.known[0].set(body.name, shapeWord(body));
        // A link is called as in the file of its robot.
        for (const part of body.robot?.parts ?? []) this.known[0].set(part, part.slice(body.name.length + 1, -2).replaceAll('_', ' '));
      }
    });
  }

  /**
   * @param {Text} text
   * @returns {boolean} whether there is a word for what it is about; a name that was free may be used again
   */
  knows([, values]) {
    return Object.values(values).every((value) => typeof value === 'string' ? !isDrawn(value) || this.known[0].has(value) : this.knows(value));
  }

  /**
   * @param {string} name of a body
   * @returns {string | undefined} what it is; undefined for a name that somebody has chosen
   */
  #word(name) {
    return this.known[0].get(name) ?? this.known[1].get(name) ?? (isDrawn(name) ? server('body') : undefined);
  }

  /**
   * @param {string} name of a body
   * @returns {string} the name that somebody has chosen, short, else what it is
   */
  of(name) {
    return this.#word(name) ?? shorten(name);
  }

  /**
   * @param {string} name of a body
   * @returns {string} as it stands in a list: what it is, and the number of its name
   */
  item(name) {
    return isDrawn(name) ? `${this.title(name)} ${name.split('/')[1]}` : this.title(name);
  }

  /**
   * @param {string} none what is said for no body
   * @returns {[name: string, item: string][]} bodies to choose from, gates first
   */
  choices(none) {
    const bodies = [...this.bodies].sort((one, other) => Number(other.sensor) - Number(one.sensor));
    return [['', none], ...bodies.slice(0, LISTED).map(({name}) => /** @type {[string, string]} */ ([name, this.item(name)]))];
  }

  /** @param {string} name of a body */
  title(name) {
    const word = this.#word(name);
    return word ? capital(word) : shorten(name);
  }

  /**
   * @param {{text: Text, code?: string, ok?: boolean}} answer
   * @returns {string} what it says; '' where the clock, the hand or the tool show the same
   */
  sayAnswer({text, code = '', ok = true}) {
    const words = this.say(text), sentence = /^\S+\/\d/.test(words) ? words : capital(words); // a name stays as it is
    return ok ? sentence : refusalText(code, sentence, text[0]);
  }

  /** @param {string} name of a body, or another value of a text */
  #named(name) {
    const word = this.#word(name);
    return word ? t('the {thing}', {thing: word}) : shorten(name);
  }

  /** @param {Text} text with names of bodies and worlds, in whose place it has words for those that nobody chose */
  say(text) {
    return said(text, (value, place) => {
      if (place === 'world') return this.titles.get(value) ?? value;
      if (place === capital(place)) return this.title(value);
      return this.#word(value) ? this.#named(value) : value.split(', ').map((name) => this.#named(name)).join(', ');
    });
  }
}

/**
 * @param {Body[]} bodies of a lesson
 * @returns {[name: string, word: string][]} what they are, as their names say: `ice/0` is *ice*
 */
function lessonWords(bodies) {
  const named = bodies.map(({name}) => /^([a-z_]+)\/(\d+)$/.exec(name)).filter((each) => each !== null);
  return named.map(([name, stem, number]) => {
    const isOnly = named.filter((each) => each[1] === stem).length === 1;
    return [name, t(stem.replaceAll('_', ' ')) + (isOnly ? '' : ` ${number}`)];
  });
}

/** @param {string} name of a body */
export function isDrawn(name) {
  return /^(drawn|note|incline|water)\/\d+$/.test(name);
}

/** @param {string} name which may have 1,000 characters */
function shorten(name) {
  return name.length > LONGEST ? `${name.slice(0, HEAD)}…${name.slice(-TAIL)}` : name;
}

/**
 * @param {{name: string, shipped: boolean}} world
 * @returns {string} what it is called
 */
export function headingOf({name, shipped}) {
  return shipped ? t(capital(name.replaceAll('_', ' '))) : name;
}

/**
 * @param {Body} body
 * @returns {string} what somebody calls it who sees it
 */
export function shapeWord({name, robot, medium, shape: {kind, outline, width}}) {
  if (robot) return t('robot');
  if (medium) return t('water');
  if (name.startsWith('note/')) return t('note');
  if (name.startsWith('incline/')) return t('inclined plane');
  if (kind === 'disc') return server('disc');
  if (kind === 'chain') return server('wall');
  if (width) return server('rectangle');
  return kind === 'polygon' && outline.length === 3 ? t('triangle') : t('shape');
}
