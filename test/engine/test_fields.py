# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fields begin anew where they are others, and only there."""

import itertools

import numpy as np
from physsim_ros.engine import scene_columns
from physsim_ros.engine.core_world import Table
from physsim_ros.model.requests import Configure
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.simulation.world import World
import pytest

from ..building import DISC, spawn


@pytest.mark.parametrize(
    ('changes', 'are_others'), [({'iterations': 20}, False), ({'gravitation': 2.0}, True)]
)
def test_fields_begin_anew_where_their_numbers_are_others(monkeypatch, changes, are_others):
    # Between the number of a body and its centre are four bytes, which have any content.
    makes, contents = scene_columns._attractor_records, itertools.count(1)  # noqa: SLF001

    def with_content(scene: Scene) -> Table:
        records = makes(scene)
        records.view(np.uint8).reshape(len(records), -1)[:, 4:8] = next(contents)
        return records

    monkeypatch.setattr(scene_columns, '_attractor_records', with_content)
    world = World(settings=WorldSettings(gravity=(0.0, 0.0), gravitation=1.0))
    for x in (0.0, 5.0):
        spawn(world, f'star/{x:g}', DISC, (x, 0.0, 0.0))
    world.step(4)
    assert not world.space.table.records['state']['fresh'].any()

    world.apply(Configure(changes=changes))

    assert world.space.table.records['state']['fresh'][:2].all() == are_others
