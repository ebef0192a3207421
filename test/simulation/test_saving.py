# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A save is harmless: what comes after it is, to the bit, what comes without it."""

from collections.abc import Callable

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import Configure, Join, Spawn
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.simulation import Simulation
import pytest

from ..slow import slow

BOX = Box(width=0.5, height=0.5)
FLOOR = Configure(changes={'bounds': (-4.0, 0.0, 4.0, 40.0)})


def stack(sim: Simulation, *, at: float = 0.25) -> None:
    for level in range(6):
        sim.perform(Spawn(name=f'stack/{level}', shape=BOX, pose=(0.0, at + 0.5 * level, 0.0)))


def resting() -> Simulation:
    sim = Simulation()
    sim.perform(FLOOR)
    stack(sim)
    return sim


def falling() -> Simulation:
    sim = Simulation()
    sim.perform(FLOOR)
    for number in range(12):
        shape = BOX if number % 2 else Disc(radius=0.3)
        pose = (0.3 * (number % 3), 1.0 + number, 0.2 * number)
        sim.perform(Spawn(name=f'a/{number}', shape=shape, pose=pose))
    return sim


def jointed() -> Simulation:
    sim = falling()
    sim.perform(
        Spawn(name='b/0', shape=BOX, pose=(-2, 6, 0), properties=Properties(velocity=(3, 0)))
    )
    for number, (a, b) in enumerate((('a/1', 'a/3'), ('b/0', 'a/5'), ('b/0', 'world'))):
        kind = (JointKind.AXLE, JointKind.ROPE, JointKind.ROD)[number]
        points = ((-2.0 + number, 6.0), (-1.0 + number, 8.0))[: kind.points]
        sim.perform(Join(name=f'j/{number}', kind=kind, points=points, a=a, b=b))
    return sim


def sleeping() -> Simulation:
    sim = resting()
    for _ in range(300):
        sim.advance_frame()
    ball = Disc(radius=0.2)
    sim.perform(Spawn(name='late/0', shape=ball, pose=(0.1, 9.0, 0.0)))
    return sim


@pytest.mark.parametrize('scene', [resting, falling, slow(jointed), sleeping])
def test_the_future_after_saves_is_the_future_without_them(
    scene: Callable[[], Simulation],
) -> None:
    saved, straight = scene(), scene()
    for number in range(300):
        if number % 7 == 0:
            state = saved.save()
            loaded = Simulation()
            loaded.begin(state)
            assert loaded.world.save() == state
        saved.advance_frame()
        straight.advance_frame()
        assert saved.world.digest() == straight.world.digest()

    saved.seek(1_000_000_000)
    straight.seek(1_000_000_000)
    assert saved.world.digest() == straight.world.digest()
