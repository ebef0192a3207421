// Copyright 2026 physsim_ros maintainers
// SPDX-License-Identifier: Apache-2.0

// How the search of the site ranks: entries of tools/tables/search_words.py, pages whose title has the word, then
// guides, then reference, then design notes and decisions, then pages of modules, which are made from docstrings.
// Sphinx's own figures are in searchtools.js; what differs is objNameMatch (11 there), objPartialMatch (6), title (15)
// and score.
var RANKS = [
  [/^(robots|drawing|time|testing|python|actors|viewers|questions|howto|installation|learning|classroom)$/, 40],
  [/^tutorials\//, 35],
  [/^interface/, 30],
  [/^(architecture|laws|page_protocol|security)/, -15],
  [/^(decisions\/|changelog|figures|glossary|contributing)/, -30],
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
