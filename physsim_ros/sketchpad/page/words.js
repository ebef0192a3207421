// SPDX-License-Identifier: Apache-2.0
/**
 * Answers in the words of people. The server's sentences, which other nodes and logs have too, name bodies
 * by their names and begin with the verb of the request: `spawned drawn/3` is *Circle added* here.
 */

/** @import {Body, Connection} from './types.js' */

/** Verbs before the name of a body, and what is said after what it is. */
const VERBS = new Map([['spawned', 'added'], ['changed', 'changed'], ['moved', 'moved'], ['deleted', 'deleted'],
  ['anchored', 'anchored'], ['released', 'released'], ['set velocity of', 'has a new velocity']]);
/** Whole sentences, and what is said instead. @type {[RegExp, string][]} */
const SENTENCES = [
  [/^saved .* to (.+)\.yaml(.*)/, 'Saved as $1$2'], [/^loaded .* from (.+)\.yaml/, 'Opened $1'], [/^loaded 0 bodies$/, 'An empty world'],
  [/^discarded the unsaved world$/, 'Unsaved world discarded'], [/^deleted the world (.+)/, 'World $1 deleted'], [/^put back the world (.+)/, 'World $1 is back'], [/^renamed .* to (.+)/, 'Renamed to $1'], [/^set gravity$/, 'Gravity set'], [/^set damping$/, 'Air drag set'],
  [/^on course \d+, at .*/, 'Back on the other course'],
  [/^course \d+ begins at .*/, 'A new course begins here'], [/^speed (.+)/, 'Speed $1×'], [/^.*; next: /, 'Next: '],
  [/^a (chain of .+) from .+/, '$1 added'], [/^pose is /, 'position is '], [/^the yaw of pose /, 'the angle '], [/^there is nothing by .+ to undo$/, 'Nothing of yours to undo'], [/^undid (.+?)(, back at .*)?$/, 'Undone: $1'], [/^redid .*/, 'Redone'], [/^(back )?at the beginning, .*/, 'Back at the beginning'],
  [/ at \([^)]*\)$/, ' here'],
];
const LONGEST = 52, HEAD = 24, TAIL = 12; // characters of a name that is shown whole, and of both ends of others
/** Names that nobody chose: of what a pen or a click has drawn. */
const DRAWN = /\b(?:(body|joint|axle|pin|spring|rod|rope|motor|slider|gear) )?((?:drawn|note)\/\d+)/g;

export class Words {
  /** @param {Connection} connection */
  constructor(connection) {
    /** Words for the bodies of the last scene, and of the one before: answers come before and after theirs. */
    this.known = /** @type {Map<string, string>[]} */ ([new Map(), new Map()]);
    connection.on('scene', ({bodies}) => {
      this.known = [new Map(bodies.map((/** @type {Body} */ body) => [body.name, shapeWord(body)])), this.known[0]];
    });
  }

  /** @param {string} name of what an answer is about; one that was free may be used again */
  knows(name) {
    return !isDrawn(name) || this.known[0].has(name);
  }

  /**
   * @param {string} name of a body
   * @returns {string} the name that somebody has chosen, short, else what it is
   */
  of(name) {
    return isDrawn(name) ? this.known[0].get(name) ?? this.known[1].get(name) ?? 'body' : shorten(name);
  }

  /**
   * @param {string} name of a body
   * @returns {string} as it stands in a list: what it is, and the number of its name
   */
  item(name) {
    return isDrawn(name) ? `${this.title(name)} ${name.split('/')[1]}` : shorten(name);
  }

  /** @param {string} name of a body */
  title(name) {
    return isDrawn(name) ? capital(this.of(name)) : this.of(name);
  }

  /**
   * @param {{message: string, subject?: string, topic?: string, ok?: boolean}} answer
   * @returns {string} what it says
   */
  tell({message, subject = '', topic = '', ok = true}) {
    if (topic === '~/clear' && ok) return 'All bodies deleted';
    const verb = subject ? message.slice(0, Math.max(message.indexOf(subject), 0)).trimEnd() : '';
    const joint = /^changed (axle|pin|spring|rod|rope|motor|slider|gear) /.exec(message)?.[1];
    if (joint) return `${capital(joint)} changed`;
    if (verb.startsWith('joined')) return capital(`${/ by (\w+) /.exec(message)?.[1] ?? 'joint'} added`);
    const done = VERBS.get(verb);
    if (done) return `${this.title(subject)} ${done}`;
    return capital(this.phrase(SENTENCES.reduce((text, [sentence, said]) => text.replace(sentence, said), message)));
  }

  /**
   * @param {string} text with names of bodies
   * @returns {string} with words for those that nobody chose
   */
  phrase(text) {
    return text.replace(/\S+/g, (word) => shorten(word)).replace(/\bspawn\b/, 'add').replace(DRAWN, (_, kind, name) => `the ${kind ?? this.of(name)}`);
  }
}

/** @param {string} name of a body */
export function isDrawn(name) {
  return /^(drawn|note)\//.test(name);
}

/** @param {string} name which may have 1,000 characters */
export function shorten(name) {
  return name.length > LONGEST ? `${name.slice(0, HEAD)}…${name.slice(-TAIL)}` : name;
}

/** @param {string} text */
export function capital(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/**
 * @param {Body} body
 * @returns {string} what somebody calls it who sees it
 */
export function shapeWord({name, shape: {kind, outline, width}}) {
  if (name.startsWith('note/')) return 'note';
  if (kind === 'disc') return 'circle';
  if (kind === 'chain') return 'wall';
  if (width) return 'rectangle';
  return kind === 'polygon' && outline.length === 3 ? 'triangle' : 'shape';
}

/** @param {string} meaning of a stroke, as the server has it */
export function meaningWord(meaning) {
  if (meaning === 'hatching') return 'heavier by hatching';
  return meaning === 'disc' ? 'circle' : meaning.replaceAll('_', ' ');
}
