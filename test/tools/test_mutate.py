# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`make mutate` changes constants and conditions of both languages, and nothing else."""

import ast
from pathlib import Path

import pytest
from tools.mutate.__main__ import candidates
from tools.mutate.mutations import mutations_of

from ..source_tree import ROOT

C = """
// a < b in a comment
static const double least = 1e-6, most = 2.5; // 3 < 4
enum { ROUNDS = 10 };
enum { ONE, TWO };
    for (int k = 0; k < count; k++) {
    assert(count <= most && room == 2);
        if (x >= least && is_µ) {
"""
PYTHON = """
LEAST = 3
NONE = 0
NAME = 'µ'
def found(x, y):
    local = 4
    return NAME if x is not None or y == 1 else local
"""


@pytest.mark.parametrize(
    ('name', 'text', 'lines'),
    [
        (
            'a.c',
            C,
            [
                'static const double least = 1e-6 * 40, most = 2.5; // 3 < 4',
                'static const double least = 1e-6, most = 2.5 * 40; // 3 < 4',
                'enum { ROUNDS = 10 * 40 };',
                'if (x < least && is_µ) {',
                'if (x >= least || is_µ) {',
            ],
        ),
        (
            'a.py',
            PYTHON,
            [
                'LEAST = 3 * 40',
                'return NAME if x is not None and y == 1 else local',
                'return NAME if x is None or y == 1 else local',
                'return NAME if x is not None or y != 1 else local',
            ],
        ),
    ],
)
def test_each_constant_and_each_condition_is_changed(name, text, lines):
    found = mutations_of(Path(name), text)

    assert [each.told(text.encode()).rpartition('+ ')[2] for each in found] == lines


def test_mutations_of_the_package_are_still_python():
    for each in candidates(['maps', 'sensing']):
        ast.parse(each.applied((ROOT / each.path).read_bytes()))
