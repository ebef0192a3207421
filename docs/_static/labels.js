// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// Each cell of a table gets the title of its column, which narrow.css shows before the cell on a phone.
document.addEventListener('DOMContentLoaded', () => {
  for (const table of document.querySelectorAll('table.docutils')) {
    const titles = [...table.querySelectorAll('thead th')].map((cell) => cell.textContent);
    for (const row of table.querySelectorAll('tbody tr')) {
      [...row.children].forEach((cell, column) => {
        cell.dataset.title = titles[column] ?? '';
        cell.classList.toggle('is-empty', !cell.textContent.trim() && !cell.querySelector('img'));
      });
    }
  }
});
