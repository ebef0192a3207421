// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// How the search of the site ranks: all pages before those of modules, which are made from docstrings. Sphinx's own
// figures are in searchtools.js; what differs is objNameMatch (11 there), objPartialMatch (6) and score.
var Scorer = {
  score: ([page, , , , score]) => (page.startsWith('api/') ? score - 100 : score),
  objNameMatch: 4,
  objPartialMatch: 1,
  objPrio: {0: 1, 1: 0, 2: -5},
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
