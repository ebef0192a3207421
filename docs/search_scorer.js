// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// How the search of the site ranks: pages whose title has the word, then what looks things up, then what teaches, then
// what tells of the inside, then pages of modules, which are made from docstrings. Sphinx's own figures are in
// searchtools.js; what differs is objNameMatch (11 there), objPartialMatch (6), title (15) and score.
var RANKS = [
  [/^interface\/(properties|parameters|topics)/, 40],
  [/^(robots|drawing|time|testing|python|actors|viewers)$/, 35],
  [/^interface/, 30],
  [/^(decisions\/|changelog|figures|glossary)/, -30],
  [/^api\//, -100],
];
var Scorer = {
  score: ([page, , , , score]) => score + (RANKS.find(([pattern]) => pattern.test(page)) ?? [null, 0])[1],
  objNameMatch: 4,
  objPartialMatch: 1,
  objPrio: {0: 1, 1: 0, 2: -5},
  objPrioDefault: 0,
  title: 60,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
