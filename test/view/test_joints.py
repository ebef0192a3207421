# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Joints in a recording: symbols share meshes and turn with bodies, lines and dots tell forces."""

from __future__ import annotations

import numpy as np
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import Join, Spawn, Unjoin
from physsim_ros.model.shapes import Box
from physsim_ros.simulation.simulation import Simulation
import pytest

from .picture_file import chunk

SYMBOLS = '/world/joints/symbols'


def spawn(name, x):
    return Spawn(name=name, shape=Box(width=1.0, height=1.0), pose=(x, 5.0, 0.0))


@pytest.fixture
def chain():
    """Make three boxes: two axles to the background, and a spring between the first two."""
    simulation = Simulation(physics_rate=240, publish_rate=60)
    for name, x in (('a/0', 0.0), ('a/1', 3.0), ('a/2', 6.0)):
        simulation.perform(spawn(name, x))
    for number, x in enumerate((0.4, 3.4)):
        simulation.perform(
            Join(name=f'axle/{number}', kind=JointKind.AXLE, points=((x, 5.0),), a=f'a/{number}')
        )
    ends = ((0.0, 5.0), (3.0, 5.0))
    simulation.perform(Join(name='spring/0', kind=JointKind.SPRING, points=ends, a='a/0', b='a/1'))
    return simulation


def symbols(recording):
    """Return the names of the joints of each symbol in the recording."""
    recording.close()
    found = {}
    for each in chunk.RrdReader(recording.path).stream():
        if each.entity_path.startswith(SYMBOLS) and not each.is_static:
            table = each.to_record_batch()
            if 'name' in table.schema.names:
                found[each.entity_path] = table.column('name').to_pylist()[-1]
    return found


def test_symbols_that_look_alike_are_instances_of_one_mesh_at_their_points(recording, chain):
    frames = [chain.advance_frame() for _ in range(10)]
    recording.draw(*frames)

    by_path = symbols(recording)
    (path,) = (path for path, names in by_path.items() if names == ['axle/0', 'axle/1'])
    places = recording.last(path[1:], 'InstancePoses3D:translations')
    snapshot = frames[-1].snapshot
    assert places[:, :2] == pytest.approx(snapshot.ends[:2, 0], abs=1e-5)
    turns = recording.last(path[1:], 'InstancePoses3D:quaternions')
    yaw = 2 * np.arctan2(turns[:, 2], turns[:, 3])
    assert yaw == pytest.approx(snapshot.poses[:2, 2], abs=1e-5)


def test_a_spring_is_a_line_and_an_axle_a_dot_each_in_the_colour_of_its_force(recording, chain):
    frames = [chain.advance_frame() for _ in range(10)]
    recording.draw(*frames)

    (coil,) = recording.last('world/joints/lines', 'LineStrips3D:strips')
    ends = np.array(coil.tolist())[[0, -1], :2]
    assert ends == pytest.approx(frames[-1].snapshot.ends[2], abs=1e-5)
    dots = recording.last('world/joints/forces', 'Points3D:positions')
    assert dots[:, :2] == pytest.approx(frames[-1].snapshot.ends[:2, 0], abs=1e-5)
    assert len(recording.last('world/joints/forces', 'Points3D:colors')) == 2


def test_joints_that_are_gone_are_cleared(recording, chain):
    recording.draw(chain.advance_frame())
    for name in ('axle/0', 'axle/1', 'spring/0'):
        chain.perform(Unjoin(name=name))
    recording.draw(chain.advance_frame())

    paths = [*(path[1:] for path in symbols(recording)), 'world/joints/lines']
    for path in paths:
        assert [row.frame for row in recording.rows(path, 'Clear:is_recursive')] == [1]
