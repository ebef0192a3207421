# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Of fast bodies only those are looked at that could meet anything, and none that could is not."""

from __future__ import annotations

import itertools
import math
import random
from typing import Any

from physsim_ros.engine.ccd import broad_phase, candidates, continuous, time_of_impact
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Join
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Disc
from physsim_ros.simulation.world import World
import pytest

from ...building import spawn


def crowd(seed: int, speed: float) -> World:
    """Return small bodies of all kinds that fly down onto what stands, and into each other."""
    pick = random.Random(seed)
    world = World(settings=WorldSettings(bounds=(-10.0, 0.0, 10.0, 30.0)))
    terrain = Chain(points=((0.0, 0.0), (1.0, 0.2), (2.0, 0.0)), thickness=0.05)
    for number in range(8):
        shape = pick.choice([Disc(radius=0.2), Box(width=1.0, height=0.1), terrain])
        pose = (pick.uniform(-8.0, 8.0), pick.uniform(1.0, 4.0), pick.uniform(-1.0, 1.0))
        spawn(world, f'peg/{number}', shape, pose, anchored=True)
    for number in range(3):
        spawn(world, f'big/{number}', Disc(radius=0.6), (4.0 * number - 4.0, 5.0, 0.0))
    small = [Disc(radius=0.05), Box(width=0.1, height=0.1), Box(width=0.3, height=0.05)]
    for number in range(60):
        row, column = divmod(number, 30)
        velocity = (pick.uniform(-speed, speed), -speed)
        pose = (0.5 * column - 7.0, 6.5 + 0.4 * row, pick.uniform(0.0, 1.0))
        spin = pick.choice([0.0, 0.0, 40.0])
        name = f'small/{number}'
        spawn(world, name, pick.choice(small), pose, velocity=velocity, spin=spin)
    return world


@pytest.mark.parametrize(('seed', 'speed'), [(1, 10.0), (2, 25.0), (3, 3.0)])
def test_who_is_left_out_of_a_crowd_would_not_have_been_stopped(
    monkeypatch: pytest.MonkeyPatch, seed: int, speed: float
) -> None:
    chosen, all_ = crowd(seed, speed), crowd(seed, speed)
    # Or the one would come to its end later than the other.
    monkeypatch.setattr(time_of_impact, 'MOST_LOOKS', 10**9)
    chosen.step(90)
    monkeypatch.setattr(candidates, 'FEW', 10**9)
    all_.step(90)
    assert chosen.digest() == all_.digest()


def test_where_there_are_too_many_pairs_all_are_swept(monkeypatch: pytest.MonkeyPatch) -> None:
    # Some are larger or faster than most, and there is room for no pair with these.
    chosen, all_ = crowd(1, 10.0), crowd(1, 10.0)
    chosen.step(60)
    monkeypatch.setattr(broad_phase, '_MOST_PAIRS', 0)
    all_.step(60)
    assert chosen.digest() == all_.digest()


@pytest.fixture
def swept(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Return how many bodies were swept, step by step."""
    counts: list[int] = []
    arrest = continuous.arrest

    def spy(engine: Any, fast: list[Any], *rest: Any, **more: Any) -> None:
        counts.append(len(fast))
        arrest(engine, fast, *rest, **more)

    monkeypatch.setattr(continuous, 'arrest', spy)
    return counts


def test_of_a_crowd_that_falls_nobody_is_swept_before_the_ground(swept: list[int]) -> None:
    world = World(settings=WorldSettings(bounds=(-10.0, 0.0, 10.0, 30.0)))
    for number in range(100):
        row, column = divmod(number, 20)
        pose = (0.15 * column, 5.0 + 0.15 * row, 0.0)
        spawn(world, f'small/{number}', Disc(radius=0.05), pose)
    # Faster than a quarter of their radius a step after a third of a second, down after one.
    world.step(220)
    assert swept == []
    world.step(60)
    assert swept
    assert world.snapshot().poses[:, 1].min() > 0.04


def heap(**properties: Any) -> World:
    """Return bodies that fly through each other, one of them larger and one faster than most."""
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    for number in range(20):
        radius, speed = 0.5 if number == 7 else 0.05, 100.0 if number == 8 else 30.0
        velocity = (speed * math.cos(number), speed * math.sin(number))
        pose = (0.01 * number, 0.0, 0.0)
        given = {'velocity': velocity, **properties}
        spawn(world, f'body/{number}', Disc(radius=radius), pose, **given)
    return world


@pytest.mark.parametrize(('group', 'meets'), [(0, True), (1, False), (-1, False)])
def test_a_group_whose_bodies_pass_through_each_other_is_not_swept(
    swept: list[int], group: int, *, meets: bool
) -> None:
    heap(group=group).step(1)
    assert bool(swept) is meets


@pytest.mark.parametrize('collide', [True, False])
def test_what_a_joint_keeps_from_colliding_is_not_swept(
    swept: list[int], *, collide: bool
) -> None:
    world = heap()
    for number, (a, b) in enumerate(itertools.combinations(range(20), 2)):
        world.apply(
            Join(
                name=f'joint/{number}',
                kind=JointKind.SPRING,
                points=((0.01 * a, 0.0), (0.01 * b, 0.0)),
                a=f'body/{a}',
                b=f'body/{b}',
                properties=JointProperties(collide=collide),
            )
        )
    world.step(1)
    assert bool(swept) is collide


def test_who_passes_through_sensors_alone_is_not_swept(swept: list[int]) -> None:
    heap(sensor=True).step(1)
    assert swept == []
