// SPDX-License-Identifier: Apache-2.0
/** Numbers as people read and write them in their language: what is drawn and set has three digits, what changes all the time two places; round steps of scales. */

import {localized} from './strings.js';
import {DEGREE, wrapped} from './vectors.js';

/** @param {number} value */
export function threeDigits(value) {
  return Math.abs(value) < 1e4 ? digits(value, 3) : localized(value.toExponential(2));
}

/**
 * @param {number} value
 * @param {number} most significant digits
 * @returns {string} without zeros at its end
 */
export function digits(value, most) {
  return localized(String(Number(value.toPrecision(most))));
}

/**
 * @param {number} value
 * @param {number} places after the decimal sign
 */
export function fixed(value, places) {
  return localized(value.toFixed(places));
}

/**
 * @param {number} value that changes from frame to frame
 * @returns {string} of nearly the same width while it does
 */
export function twoPlaces(value) {
  return Math.abs(value) < 0.005 ? '0' : fixed(value, Math.abs(value) < 100 ? 2 : 0);
}

/**
 * @param {number} angle of a direction, after any number of turns [rad]
 * @param {number} places after the decimal sign, without zeros at its end
 */
export function degrees(angle, places = 1) {
  return `${digits(Number((wrapped(angle) / DEGREE).toFixed(places)), 6)}°`;
}

/**
 * @param {string} text that somebody has typed, with a decimal point or comma
 * @returns {number} NaN where it is none
 */
export function numberOf(text) {
  const value = text.trim() === '' ? NaN : Number(text.replace(',', '.').replaceAll('−', '-'));
  return Number.isFinite(value) ? value : NaN;
}

/**
 * @param {number} value
 * @returns {number} the least number of 1, 2 or 5 times a power of ten that is not below the value
 */
export function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value)), share = value / power * (1 - 1e-9);
  return Number(((share > 5 ? 10 : share > 2 ? 5 : share > 1 ? 2 : 1) * power).toPrecision(1));
}

/**
 * @param {number} step
 * @param {number} from
 * @param {number} to
 */
export function multiplesOf(step, from, to) {
  const first = Math.ceil(from / step);
  return Array.from({length: Math.floor(to / step) - first + 1}, (_, i) => (first + i) * step);
}
