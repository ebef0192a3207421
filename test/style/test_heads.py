# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The head of a stage of the core tells its problem, its method and its cost, each on a line."""

import re

import pytest

from .sources import ROOT

HEADS = {
    path.name: path.read_text().split('\n\n')[1]
    for path in sorted((ROOT / 'physsim_ros/engine/core').glob('*.c'))
}
# Files that are no stage: tables, constraints of Chipmunk, and the list of stages itself.
OTHERS = {'core.c', 'joint_parts.c', 'step.c'}
STAGES = [
    name
    for name in HEADS
    if '"stages.h"' in (ROOT / 'physsim_ros/engine/core' / name).read_text()
    if name not in OTHERS
]


@pytest.mark.parametrize('name', STAGES)
def test_a_stage_tells_problem_method_and_cost(name):
    begun = set(re.findall(r'^// (\w+)\b', HEADS[name], re.MULTILINE))

    assert {'Problem', 'Method', 'Cost'} <= begun


@pytest.mark.parametrize('name', HEADS)
def test_each_of_these_begins_a_line(name):
    assert not re.search(
        r'[^\s/] (Problem|Method|Scope|Laws?|Limits?|Cost|Energy|Without it)\b:? ', HEADS[name]
    )
