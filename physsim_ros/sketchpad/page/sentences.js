// SPDX-License-Identifier: Apache-2.0
/**
 * The server's sentences, and what this page says instead: words for things and for what was done, and whole sentences.
 *
 * A sentence of the server that is not here is shown as it is.
 */

import {t} from './strings.js';

/** What is drawn, read, joined or undone, by the words of the server. */
export const THINGS = new Map([
  ['disc', t('circle')], ['rectangle', t('rectangle')], ['polygon', t('polygon')], ['wall', t('wall')],
  ['body', t('body')], ['joint', t('joint')], ['axle', t('axle')], ['pin', t('pin')], ['spring', t('spring')],
  ['rod', t('rod')], ['rope', t('rope')], ['chain', t('chain')], ['motor', t('motor')], ['slider', t('slider')],
  ['gear', t('gear')], ['rack', t('rack and pinion')], ['anchor', t('anchor')], ['velocity', t('velocity')], ['gravity', t('gravity')],
  ['delete', t('delete')], ['hatching', t('heavier by hatching')], ['all bodies', t('all bodies')],
  ['several bodies', t('several bodies')], ['several joints', t('several joints')], ['all joints', t('all joints')], ['world', t('the world')],
  ['settings', t('settings')], ['damping', t('air')], ['air_density', t('air')], ['air_viscosity', t('air')], ['wind', t('air')], ['gusts', t('air')],
  ['gravitation', t('attraction')], ['coulomb', t('attraction')],
]);

/** Verbs before the name of a body, and what is said of it. */
export const VERBS = new Map([
  ['spawned', t('{thing} added')], ['changed', t('{thing} changed')], ['moved', t('{thing} moved')],
  ['deleted', t('{thing} deleted')], ['anchored', t('{thing} anchored')], ['released', t('{thing} released')],
  ['set velocity of', t('{thing} has a new velocity')],
]);

/** Verbs of what is undone, and how that is told. */
export const GESTURES = new Map([
  ['spawn', t('add {thing}')], ['change', t('change {thing}')], ['delete', t('delete {thing}')],
  ['cut', t('cut {thing}')], ['move', t('move {thing}')], ['drag', t('drag {thing}')], ['place', t('place {thing}')],
  ['anchor', t('anchor {thing}')], ['release', t('release {thing}')], ['join', t('add {thing}')],
  ['set motion of', t('change {thing}')], ['drive', t('drive {thing}')], ['load', t('open {thing}')],
  ['command', t('change {thing}')],
]);

/** Whole sentences, in the order in which they are tried. @type {[RegExp, string][]} */
export const SENTENCES = [
  [/^saved .* to (.+)\.yaml(.*)/, t('Saved as $1$2')],
  [/^loaded 0 bodies$/, t('An empty world')],
  [/^discarded the unsaved world$/, t('Unsaved world discarded')],
  [/^what was drawn is not autosaved: .*/, t('The unsaved world cannot be kept: save it')],
  [/^what was drawn is autosaved again$/, t('The unsaved world is kept again')],
  [/^deleted the world (.+)/, t('World $1 deleted')],
  [/^put back the world (.+)/, t('World $1 is back')],
  [/^renamed .* to (.+)/, t('Renamed to $1')],
  [/^set gravity$/, t('Gravity set')],
  [/^set damping$/, t('Air drag set')],
  [/^paused$/, t('paused')],
  [/^playing$/, t('playing')],
  [/^rewinding$/, t('rewinding')],
  [/^playing at (.+)/, `${t('playing')}, $1×`],
  [/^rewinding at (.+)/, `${t('rewinding')}, $1×`],
  [/^deleted (\d+) bodies$/, t('Deleted $1 bodies')],
  [/^(?:moved|set pose of) (\d+) bodies$/, t('Moved $1 bodies')],
  [/^copied 1 body$/, t('Copied one body')], [/^copied (\d+) bodies$/, t('Copied $1 bodies')], [/^copied a robot$/, t('Copied a robot')],
  [/^cut into (\d+) pieces$/, t('Cut into $1 pieces')],
  [/^cut into (\d+) pieces, .*/, t('Cut into $1 pieces, and joints cut through')],
  [/^cut .*/, t('Cut through')],
  [/^loaded 1 body.*/, t('Loaded one body')], [/^loaded (\d+) bodies.*/, t('Loaded $1 bodies')],
  [/^deleted joint .*/, t('Joint deleted')],
  [/^commanded \d+ motors?$/, t('Motor set')],
  [/ is heavier by (.+): .*/, ` ${t('is heavier by $1')}`],
  [/ moves with .*/, ` ${t('has a new velocity')}`],
  [/^gravity towards .*/, t('Gravity set')],
  [/^the material of what is drawn next$/, t('Material of new bodies')],
  [/^you are (.+)/, t('You are $1')],
  [/^your hand is raised$/, t('Your hand is raised')],
  [/^your hand is down$/, t('Your hand is down')],
  [/^the pages are frozen$/, t('All pupils are frozen')],
  [/^the pages are no longer frozen$/, t('All pupils can draw again')],
  [/^locked (.+)/, t('Locked: {names}', {names: '$1'})],
  [/^no body is locked$/, t('No body is locked')],
  [/^on course \d+, at .*/, t('Back on the other course')],
  [/^course \d+ begins at .*/, t('A new course begins here')],
  [/^speed (.+)/, t('Speed $1×')],
  [/(?<=; next: )a point on the rim$/, t('a point on the rim')],
  [/(?<=; next: )(its|the) other end$/, t('the other end')],
  [/(?<=; next: )its other end, beyond the bodies$/, t('the other end, beyond the bodies')],
  [/(?<=; next: )the next corner$/, t('the next corner')],
  [/(?<=; next: )the next corner, or .*/, t('the next corner, or the first one again')],
  [/(?<=; next: )a point of the side across$/, t('a point of the side across')],
  [/(?<=; next: )its tip$/, t('the tip')],
  [/(?<=; next: )its tip, 1 m for 1 m\/s$/, t('the tip, 1 m for 1 m/s')],
  [/(?<=; next: )the tip of its arrow, 1 m for 10 N$/, t('the tip, 1 m for 10 N')],
  [/(?<=; next: )the other one$/, t('the other wheel')],
  [/(?<=; next: )its rack$/, t('the rack')],
  [/(?<=; next: )the next wheel or ring; its end twice$/, t('the next wheel or ring, or the end twice')],
  [/^.*; next: /, `${t('Next:')} `],
  [/^a chain of (\d+) links from .+/, t('Chain of $1 links added')],
  [/^the world would have \d+ bodies; .* is (\d+)$/, t('at most $1 bodies')],
  [/^the world would have \d+ convex pieces; .* is (\d+)$/, t('at most $1 parts of bodies')],
  [/^the world would have \d+ joints; .* is (\d+)$/, t('at most $1 joints')],
  [/^.+ (?:is|reaches) (?:further|further away|faster|stronger|greater) than /, t('more than') + ' '],
  [/^.+ is \S+ m long; below (\S+) m it is a slip of the hand$/, t('shorter than $1 m')],
  [/^a piece of .+ would be too thin to be simulated$/, t('a piece would be too thin')],
  [/^there is no gravity to turn; .*/, t('there is no gravity to turn')],
  [/^a part is thinner than (\S+) m$/, t('a part is thinner than $1 m')],
  [/^the points of a .+ must be (\S+) m apart$/, t('its points are at least $1 m apart')],
  [/^a name has (?:at most|1 to) (\d+) characters$/, t('a name has 1 to $1 characters')],
  [/^.+ cannot be a name: it has no .+$/, t('a name has no "/" and no "."')],
  [/^nothing of (.+) is kept$/, t('nothing of $1 is kept')],
  [/^there is no world '?(.+?)'?( of your own|;.*)$/, t('there is no world $1')],
  [/^\w+ is (\S+)(?: m)?; it must lie between (\S+) and (\S+).*/, t('$1 does not lie between $2 and $3')],
  [/^the body would weigh (\S+) kg; (\S+) to (\S+) kg .*/, t('$1 kg does not lie between $2 and $3')],
  [/^\w+ is \S+; it must not be 0$/, t('it must not be 0')],
  [/^lower is (\S+) and upper (\S+); .*/, t('the least, $1, is above the greatest, $2')],
  [/^label has more than (\d+) characters$/, t('more than $1 characters')],
  [/^the yaw of .+ is too large$/, t('the angle is too large')],
  [/^there is nothing by .+ to undo$/, t('Nothing of yours to undo')],
  [/^undid (.+?)(, back at .*)?$/, t('Undone: $1')],
  [/^redid (.+?)(, at .*)?$/, t('Redone: $1')],
  [/^(back )?at the beginning, .*/, t('Back at the beginning')],
  [/ at \([^)]*\)$/, ` ${t('here')}`],
];
