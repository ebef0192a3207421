# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The drawings that are shipped are machines, built by strokes alone, and they run."""

from __future__ import annotations

from physsim_ros.files import drawings
from physsim_ros.model.errors import Refusal
import pytest
from tools.evaluation.people import drawn_by, PEOPLE, SEVERAL

from .machines import LAWS, Machine, strokes_of
from ..slow import slow

# Seconds between two strokes of a ruler.
PAUSE = 30.0
# Drawings whose law takes less than a second.
QUICK = ('car', 'cradle', 'marble_run', 'seesaw', 'spring_and_mass')
# Those of the people who draw in most different ways; `make evaluate` asks all of them.
FEW = ('no fault', 'ends that cross', 'bowed sides', SEVERAL)


def test_every_shipped_drawing_has_a_law_and_ten_people_draw_it() -> None:
    assert sorted(LAWS) == sorted(drawings())
    assert len(PEOPLE) == 10


@pytest.mark.parametrize('name', [name if name in QUICK else slow(name) for name in LAWS])
def test_a_drawing_runs_as_a_person_expects(name: str) -> None:
    ruler = ((stroke, PAUSE * number) for number, stroke in enumerate(strokes_of(name)))
    LAWS[name](Machine(ruler))


@pytest.mark.slow
def test_of_machines_drawn_by_hand_19_in_20_run() -> None:
    failed = []
    for name, law in LAWS.items():
        for person in FEW:
            try:
                law(Machine(drawn_by(person, strokes_of(name))))
            except (AssertionError, Refusal) as error:
                failed.append((name, person, error))
    assert len(failed) <= 0.05 * len(LAWS) * len(FEW), failed
