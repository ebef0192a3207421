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

"""What rests costs few iterations, and rests as it would by all of them."""

from collections.abc import Callable
from dataclasses import replace
import math

import numpy as np
from physsim_ros.core import bell, iterations
from physsim_ros.core.iterations import FEW
from physsim_ros.core.requests import Command, Configure, Delete, Pin, Request
from physsim_ros.core.settings import WorldSettings
from physsim_ros.core.shapes import Box
from physsim_ros.core.simulation import Simulation
from physsim_ros.core.world import World
import pymunk
import pytest

from .worlds import BOX, DISC, DT, G, spawn, spawning, stack

YARD = WorldSettings(bounds=(-20.0, 0.0, 20.0, 40.0))
ALL = YARD.iterations


def _engine(world: World) -> pymunk.Space:
    return world._space._space  # noqa: SLF001 - where the engine's iterations are


def made(world: World) -> list[int]:
    """Return a list that gets, in each step, how many iterations it is made with."""
    counts: list[int] = []
    space = _engine(world)
    bell.hang(space, lambda *_: counts.append(space.iterations))
    return counts


def at_rest(count: int = 3) -> World:
    world = World(settings=YARD)
    stack(world, count)
    world.step(2400)
    return world


def test_what_rests_is_solved_by_few_iterations() -> None:
    world = at_rest()
    counts = made(world)

    world.step(48)

    assert counts == [FEW] * 48


def test_no_more_than_what_is_asked_for() -> None:
    world = World(settings=replace(YARD, iterations=1))
    spawn(world, 'a/0', DISC, (0.0, 0.5, 0.0))
    world.step(240)
    counts = made(world)

    world.step(4)

    assert counts == [1] * 4


def test_what_moves_has_all_of_them() -> None:
    world = at_rest()
    spawn(world, 'a/0', DISC, (9.0, 0.5, 0.0), velocity=(0.5, 0.0), friction=0.0)
    world.step(48)
    counts = made(world)

    # At a steady velocity too: it meets its contact at another place in each step.
    world.step(48)

    assert counts == [ALL] * 48


@pytest.mark.parametrize(
    'request_of',
    [
        lambda: Configure(changes={'gravity': (0.0, -9.0)}),
        lambda: Configure(changes={'bounds': None}),
        lambda: Command(names=('stack/2',), poses=((0.1, 2.5, 0.0),)),
        lambda: Command(names=('stack/2',), twists=((0.0, 0.0, 0.0),)),
        lambda: Command(names=('stack/2',), wrenches=((1.0, 0.0, 0.0),)),
        lambda: Delete(name='stack/0'),
    ],
    ids=['gravity', 'bounds', 'pose', 'twist', 'wrench', 'deleted'],
)
def test_the_step_after_a_request_has_all_of_them(request_of: Callable[[], Request]) -> None:
    world = at_rest()
    counts = made(world)

    world.apply(request_of())
    world.step(1)

    assert counts == [ALL]


def test_what_hangs_on_joints_has_all_of_them() -> None:
    world = at_rest()
    world.apply(Pin(point=(0.0, 1.0)))
    world.step(480)
    counts = made(world)

    world.step(4)

    assert counts == [ALL] * 4


def test_a_step_in_which_anything_begins_to_touch_has_all_of_them() -> None:
    world = at_rest()
    # Slow enough to count as rest, and on no ground that could slow it down.
    spawn(world, 'a/0', DISC, (2.0, 0.5, 0.0), velocity=(0.001, 0.0), friction=0.0)
    spawn(world, 'a/1', DISC, (3.005, 0.5, 0.0), friction=0.0)
    world.step(240)
    counts, last = made(world), world.snapshot().twists[3, 0]
    assert last == pytest.approx(0.001, abs=1e-9)

    while world.snapshot().twists[4, 0] < 1e-4:
        world.step(1)

    # What the blow does is a matter of the next step; it falls in this one.
    assert len(counts) > 240
    assert counts[-1] == ALL
    assert set(counts[:-1]) == {FEW}


def test_what_is_pushed_out_of_what_it_overlaps_has_all_of_them() -> None:
    world = World(settings=replace(YARD, bounds=None, gravity=(0.0, 0.0)))
    for number in range(6):
        spawn(world, f'a/{number}', BOX, (0.7 * number, 0.5, 0.0), elasticity=0.0)
    counts = made(world)

    world.step(48)

    # It has no velocity. What the first step asks for is seen after the second.
    assert not world.snapshot().twists.any()
    assert counts[2:] == [ALL] * 46


def incline(world: World) -> None:
    angle = math.radians(26.5)
    out = -math.sin(angle), math.cos(angle)
    spawn(world, 'slope/0', Box(width=9.0, height=1.0), (0.0, 9.0, angle), anchored=True)
    spawn(world, 'a/0', BOX, (out[0], 9.0 + out[1], angle), friction=0.5)


def pyramid(world: World) -> None:
    for row in range(8):
        for column in range(8 - row):
            x = 1.02 * (column - (8 - row) / 2)
            spawn(world, f'a/{8 * row + column}', BOX, (x, 0.5 + row, 0.0))


def heap(world: World) -> None:
    for number in range(24):
        pose = 1.05 * (number % 4) - 2.0, 0.6 + 1.1 * (number // 4), 0.1 * number
        spawn(world, f'a/{number}', DISC if number % 2 else BOX, pose)


@pytest.mark.parametrize('build', [incline, pyramid, heap])
def test_what_rests_stays_where_it_would_by_all_iterations(
    build: Callable[[World], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    poses = []
    for few in (FEW, ALL):
        monkeypatch.setattr(iterations, 'FEW', few)
        world = World(settings=replace(YARD, bounds=(-5.0, 0.0, 5.0, 40.0), friction=0.5))
        build(world)
        world.step(240 * 40)
        counts = made(world)
        world.step(240 * 40)
        assert counts.count(few) > 0.8 * len(counts)
        poses.append(world.snapshot().poses)

    assert poses[0] == pytest.approx(poses[1], abs=1e-9)


def test_the_same_bits_come_again_where_rest_is_disturbed() -> None:
    sim = Simulation(settings=YARD, keyframes=1.0)
    for number in range(4):
        sim.perform(spawning(f'stack/{number}', BOX, (0.0, 0.5 + number, 0.0)))
    sim.perform(spawning('a/1', DISC, (5.0, 0.5, 0.0), velocity=(0.001, 0.0), friction=0.0))
    digests, rested = {}, 0
    for number in range(60 * 12):
        if number == 60 * 8:
            sim.perform(spawning('a/0', DISC, (0.2, 6.0, 0.0)))
        sim.advance_frame()
        rested += _engine(sim.world).iterations == FEW
        if number % 25 == 0:
            digests[sim.step] = sim.world.digest()

    assert 60 < rested < 60 * 8
    for step in reversed(digests):
        sim.seek(round(step * DT * 1e9))
        assert sim.world.digest() == digests[step]


def test_what_rests_is_given_its_weight_in_each_frame_until_it_is_disturbed() -> None:
    world = World(settings=replace(YARD, bounds=None))
    world.watching = True
    spawn(world, 'shelf/0', Box(width=2.0, height=1.0), (-0.98, -0.5, 0.0), anchored=True)
    spawn(world, 'a/0', DISC, (0.0, 0.5, 0.0), mass=1.0, friction=0.0, velocity=(0.001, 0.0))
    world.step(4)
    counts, off, fell = made(world), [], 0
    # At 0.02 m it comes to the edge, and falls: no pair begins to touch, and nothing is asked.
    for _ in range(60 * 24):
        before = world.snapshot().twists[1, :2]
        world.contacts(world.snapshot())
        world.step(4)
        after = world.snapshot()
        given = world.contacts(after).impulses.sum(axis=0)
        fell += not given.any()
        off.append(np.abs(given - after.twists[1, :2] + before - (0.0, G * 4 * DT)).max())

    assert FEW in counts
    assert fell > 30
    # But for half a step of gravity where it comes to fly, or flies no more.
    landed = np.isclose(off, G * DT / 2, rtol=0.0, atol=1e-9)
    assert np.count_nonzero(landed) < 12
    assert max(np.where(landed, 0.0, off)) < 1e-7
