// SPDX-License-Identifier: Apache-2.0
/**
 * Answers in the words of people. The server's sentences, which other nodes and logs have too, name bodies
 * by their names and begin with the verb of the request: `spawned drawn/3` is *Circle added* here.
 */

import {GESTURES, SENTENCES, THINGS, VERBS} from './sentences.js';
import {filled, localized, refusalText, t} from './strings.js';

/** @import {Body, Connection} from './types.js' */

/** A joint that is added, by its kind: its name is often that of a body, too. */
const JOINED = /(^|: )join (\w+) .+?(?= and \d+ more$|$)/;
const GESTURE = new RegExp(`(^|: )(${[...GESTURES.keys()].join('|')}) (.+?)( and \\d+ more)?$`);
const LISTED = 200; // bodies that can be chosen from
const LONGEST = 52, HEAD = 24, TAIL = 12; // characters of a name that is shown whole, and of both ends of others
/** Names that nobody chose: of what a pen, a click or a tool of this page has drawn. */
const DRAWN = /\b(?:(body|joint|axle|pin|spring|rod|rope|motor|slider|gear|rack) )?((?:drawn|note|incline|water)\/\d+)(?!\/)/g;

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
   * @param {{message: string, subject: string}} answer
   * @returns {boolean} whether there is a word for what it is about; a name that was free may be used again
   */
  knows({message, subject}) {
    const name = subject || /^redid spawn ([^\s,]+)/.exec(message)?.[1] || '';
    return !isDrawn(name) || this.known[0].has(name);
  }

  /**
   * @param {string} name of a body
   * @returns {string | undefined} what it is; undefined for a name that somebody has chosen
   */
  #word(name) {
    return this.known[0].get(name) ?? this.known[1].get(name) ?? (isDrawn(name) ? thingWord('body') : undefined);
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
   * @param {{message: string, code?: string, subject?: string, topic?: string, ok?: boolean}} answer
   * @returns {string} what it says
   */
  tell({message, code = '', subject = '', topic = '', ok = true}) {
    if (topic === '~/clear' && ok) return t('All bodies deleted');
    const verb = subject ? message.slice(0, Math.max(message.indexOf(subject), 0)).trimEnd() : '';
    const joint = /^changed (axle|pin|spring|rod|rope|motor|slider|gear|rack) /.exec(message)?.[1];
    if (joint) return said('changed', capital(thingWord(joint)));
    const added = /^joined .* by (\w+) /.exec(message) ?? /^an? (\w+) (?:of|between|from|turns) (?!\d+ links)/.exec(message);
    if (added) return said('spawned', capital(thingWord(added[1])));
    const opened = /^loaded .* from (.+)\.yaml/.exec(message)?.[1];
    if (opened) return t('Opened {name}', {name: this.titles.get(opened) ?? opened});
    if (VERBS.has(verb)) return said(verb, this.title(subject));
    // There may be a body there, which the knife has not passed.
    if (message.startsWith('the stroke passes right through no ')) return t('The stroke passes right through nothing');
    const told = capital(this.phrase(sentenceOf(message))).replace(/\d\.\d/g, localized);
    return ok ? told : refusalText(code, told);
  }

  /**
   * @param {string} text with names of bodies
   * @returns {string} with words for those that nobody chose
   */
  phrase(text) {
    const the = (/** @type {string} */ thing) => t('the {thing}', {thing});
    const named = text.replace(JOINED, (_, before, kind) => `${before}join ${the(thingWord(kind))}`)
      .replace(/\S+/g, (name) => !isDrawn(name) && this.known[0].has(name) ? the(this.of(name)) : shorten(name))
      .replace(DRAWN, (_, kind, name) => the(kind ? thingWord(kind) : this.of(name)));
    return named.replace(GESTURE, (_, before, verb, thing, more) => {
      const told = more ? `several ${verb === 'join' ? 'joints' : 'bodies'}` : thing;
      return before + filled(GESTURES.get(verb) ?? '', {thing: THINGS.get(told) ?? told});
    }).replace(/(^|: )reset$/, `$1${t('Reset')}`).replace(/(^|: )open world$/, `$1${t('Open the world')}`);
  }
}

/**
 * @param {string} verb of the server
 * @param {string} thing
 */
function said(verb, thing) {
  return filled(VERBS.get(verb) ?? '', {thing});
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

/** @param {string} message of the server */
export function sentenceOf(message, sentences = SENTENCES) {
  return sentences.reduce((text, [sentence, instead]) => text.replace(sentence, instead), message);
}

/** @param {string} text */
export function capital(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
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
  if (kind === 'disc') return thingWord('disc');
  if (kind === 'chain') return thingWord('wall');
  if (width) return thingWord('rectangle');
  return kind === 'polygon' && outline.length === 3 ? t('triangle') : t('shape');
}

/** @param {string} meaning of a stroke, or kind of a joint, as the server has it */
export function thingWord(meaning) {
  return THINGS.get(meaning) ?? meaning.replaceAll('_', ' ');
}
