// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// How the search of the site ranks: titles and texts of pages before names of the code. Sphinx's own figures are in
// searchtools.js; what differs is objNameMatch (11 there) and objPartialMatch (6).
var Scorer = {
  objNameMatch: 4,
  objPartialMatch: 1,
  objPrio: {0: 1, 1: 0, 2: -5},
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
