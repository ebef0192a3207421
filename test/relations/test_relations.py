# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every relation holds for every scene, or is told as an exception with its figure."""

import itertools

import pytest

from . import changes
from .exceptions import crossings, EXCEPTIONS, is_quick, limit, MARGIN, REASONS, UNKNOWN
from .films import begin, difference, play
from .relations import film, RELATIONS
from .scenes import SCENES
from ..slow import slow


@pytest.mark.parametrize(
    ('relation', 'scene'),
    [names if is_quick(*names) else slow(*names) for names in crossings()],
)
def test_a_relation_holds_for_a_scene(relation, scene):
    law, played = RELATIONS[relation], SCENES[scene]
    if not law.is_about(played):
        return
    off, most = law.off(played), limit(relation, scene)

    told = EXCEPTIONS.get((relation, scene))
    if told is None:
        assert off <= most, f'{law.law}: off by {off:.2g}'
    else:
        assert off > most, 'it is no exception any more: python -m test.relations.exceptions'
        assert off <= MARGIN * told, f'{law.law}: off by {off:.2g}, told {told:.2g}'


@pytest.mark.parametrize('scene', [name for name, scene in SCENES.items() if scene.chaotic])
def test_chaos_is_seen_by_a_displacement_that_grows(scene):
    def growth(size, seed):
        moved = begin(changes.shaken(SCENES[scene].state, by=size, seed=seed))
        seen = play(moved, SCENES[scene].seconds)
        return difference(film(SCENES[scene]), seen).way / size

    displacements = itertools.product((1e-9, 1e-7, 1e-12), range(4))
    assert any(growth(*each) >= 1000.0 for each in displacements)


def test_exceptions_are_those_of_crossings_that_there_are():
    for relation, scene in EXCEPTIONS:
        assert RELATIONS[relation].is_about(SCENES[scene])


def test_each_exception_has_one_reason():
    told = [
        (relation, scene)
        for relations in REASONS.values()
        for relation, scenes in relations.items()
        for scene in scenes
    ]
    assert len(told) == len(set(told))
    assert UNKNOWN not in REASONS
