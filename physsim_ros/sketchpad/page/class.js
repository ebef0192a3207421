// SPDX-License-Identifier: Apache-2.0
/** The page of a class with a world for each pupil (class.html): a pupil is sent there, a teacher sees who is where. */

import {createElement, elementOf} from './dom.js';
import {watchTheme} from './theme.js';

const KEY = 'physsim-seat'; // of this browser
const PERIOD = 3000; // ms between two looks at who is where

const form = elementOf('join', HTMLFormElement), name = elementOf('name', HTMLInputElement);
const teacher = elementOf('teacher', HTMLElement);

form.addEventListener('submit', async (event) => {
  event.preventDefault();
  const response = await fetch('/join', {method: 'POST', body: JSON.stringify({name: name.value, key: localStorage.getItem(KEY) ?? ''})});
  if (!response.ok) {
    elementOf('refused', HTMLElement).textContent = await response.text();
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
  if (teacher.hidden) teacher.querySelector('img')?.setAttribute('src', '/qr.svg');
  teacher.hidden = false;
  // No link: it would make a pupil of the teacher's browser.
  elementOf('pupils', HTMLElement).textContent = pupils;
  elementOf('seats', HTMLElement).replaceChildren(...seats.map((/** @type {{name: string, address: string}} */ seat) =>
    createElement('li', {}, createElement('a', {href: seat.address, target: '_blank', rel: 'noopener', className: 'button',
      textContent: seat.name || 'free'}))));
  setTimeout(showSeats, PERIOD);
}

watchTheme();
showSeats();
