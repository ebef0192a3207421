// SPDX-License-Identifier: Apache-2.0
/**
 * What is wrong with a world file, in the words of the page: loaded when one is refused. Names, keys and values stay as
 * the file has them.
 *
 * A sentence of the server that is not here is shown as it is.
 */

import {SENTENCES} from '../sentences.js';
import {t} from '../strings.js';
import {sentenceOf, thingWord} from '../words.js';

/** In the order in which they are tried, before those of all answers. @type {[RegExp, string][]} */
const WRONG = [
  [/^the file is not YAML: .*, line (\d+)$/, t('line $1 is not YAML')],
  [/^the file must be a YAML mapping.*/, t('it has no keys with values')],
  [/^format must be (\d+)$/, t('"format: $1" is missing')],
  [/^there is no property (.+); (?:nearest is|use) (.+)$/, t('there is no key $1, but $2')],
  [/^there is no property (.+?)(?:;.*)?$/, t('there is no key $1')],
  [/^there is no kind of \w+ (.+?);.*there are (.+)$/, t('there is no kind $1; there are $2')],
  [/^there is no body (.+?)(?:;.*)?$/, t('there is no body $1')],
  [/^a body has one of (.+)$/, t('it has none of $1')],
  [/^the name appears twice$/, t('the name appears twice')],
  [/^(\w+) is missing$/, t('$1 is missing')],
  [/^(\w+) must be a (?:whole )?number,.* not (.+)$/, t('$1 is not a number: $2')],
  [/^(\w+) must be true or false, not (.+)$/, t('$1 is neither true nor false: $2')],
  [/^(\w+) is .+; it must be a list of (\d+) numbers$/, t('$1 is not a list of $2 numbers')],
  [/^(\w+) is (\S+?)(?: \S+)?; it must lie between (\S+) and (\S+).*/, t('$1: $2 does not lie between $3 and $4')],
];

/**
 * @param {string} message of the server about a file
 * @returns {string} in the words of the page, beginning with the body or joint that it is about
 */
export function fileSentence(message) {
  const [, kind = '', name = '', wrong] = /^(?:(body|joint) (.+?): )?(.*)$/s.exec(message) ?? [];
  return (kind && `${thingWord(kind)} ${name}: `) + sentenceOf(wrong, [...WRONG, ...SENTENCES]);
}
