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

"""What rests needs the engine now and then, and rests as it would by every step of it."""

from collections.abc import Callable
from dataclasses import replace
import math

import numpy as np
from physsim_ros.engine.stages import pre_solve_hook, sleeping
from physsim_ros.model.requests import Command, Configure, Delete, Pin, Request
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import World
import pymunk
import pytest

from ...building import BOX, DISC, DT, G, spawn, spawning, stack

YARD = WorldSettings(bounds=(-20.0, 0.0, 20.0, 40.0))
STRIDE = 8  # steps of a 240th of a second


def solved(world: World) -> list[int]:
    """Return a list that gets the number of each step that the engine makes."""
    steps: list[int] = []
    pre_solve_hook.hang(_engine(world), lambda *_: steps.append(world.step_count))
    return steps


def _engine(world: World) -> pymunk.Space:
    return world._space._space  # noqa: SLF001 - what makes its steps


def at_rest(count: int = 3) -> World:
    world = World(settings=YARD)
    stack(world, count)
    world.step(2400)
    return world


def test_what_rests_is_solved_for_in_one_step_of_a_stride() -> None:
    world = at_rest()
    steps = solved(world)

    world.step(6 * STRIDE)

    assert len(steps) == 6
    assert set(np.diff(steps)) == {STRIDE}


@pytest.mark.parametrize(('rate', 'stride'), [(60.0, 2), (1000.0, 33)])
def test_a_stride_is_as_long_at_any_rate(rate: float, stride: int) -> None:
    world = World(settings=YARD, physics_rate=rate)
    spawn(world, 'a/0', DISC, (0.0, 0.5, 0.0))
    world.step(240)
    steps = solved(world)

    world.step(4 * stride)

    assert len(steps) == 4


def test_what_moves_is_solved_for_in_each_step() -> None:
    world = at_rest()
    spawn(world, 'a/0', DISC, (9.0, 0.5, 0.0), velocity=(0.5, 0.0), friction=0.0)
    world.step(48)
    steps = solved(world)

    # At a steady velocity too: it would come too far before it is seen to touch.
    world.step(48)

    assert len(steps) == 48


@pytest.mark.parametrize(('radius', 'count'), [(0.1, 3), (0.001, 24)])
def test_what_is_slow_is_solved_for_in_each_step_where_it_is_fast_for_its_size(
    radius: float, count: int
) -> None:
    world = World(settings=replace(YARD, gravity=(0.0, 0.0)))
    spawn(world, 'a/0', Disc(radius=radius), (0.0, 1.0, 0.0), velocity=(0.01, 0.0))
    world.step(48)
    steps = solved(world)

    world.step(24)

    assert len(steps) == count


def test_what_coasts_goes_on_as_it_did() -> None:
    world = World(settings=replace(YARD, gravity=(0.0, 0.0)))
    spawn(world, 'a/0', BOX, (0.0, 1.0, 0.0), velocity=(0.01, -0.005), spin=0.01)
    steps = solved(world)

    world.step(485)

    assert len(steps) < 80
    gone = 485 * DT
    expected = 0.01 * gone, 1.0 - 0.005 * gone, 0.01 * gone
    assert world.snapshot().poses[0] == pytest.approx(expected, abs=1e-12)
    assert world.snapshot().twists[0].tolist() == [0.01, -0.005, 0.01]


@pytest.mark.parametrize('chunk', [1, 3, 267])
def test_what_coasts_is_there_however_steps_are_counted_out(chunk: int) -> None:
    digests = []
    for count in (2403, chunk):
        world = at_rest()
        spawn(world, 'a/0', DISC, (5.0, 0.5, 0.0), velocity=(0.01, 0.0), friction=0.0)
        # Goes within a stride, and what lay on it falls.
        spawn(world, 'a/1', BOX, (9.0, 0.5, 0.0), lifetime=1917 * DT)
        spawn(world, 'a/2', BOX, (9.0, 1.5, 0.0))
        for _ in range(2403 // count):
            world.step(count)
        digests.append(world.digest())

    assert digests[0] == digests[1]


@pytest.mark.parametrize('properties', [{}, {'sensor': True}, {'kinematic': True}])
def test_what_turns_slowly_is_solved_for_in_each_step_where_its_ends_are_fast(
    properties: dict[str, bool],
) -> None:
    world = World(settings=replace(YARD, gravity=(0.0, 0.0)))
    plank = Box(width=20.0, height=1.0)
    spawn(world, 'a/0', plank, (0.0, 20.0, 0.0), spin=0.01, **properties)
    steps = solved(world)

    world.step(48)

    assert len(steps) == 48


def test_what_falls_ever_so_slowly_falls() -> None:
    world = World(settings=replace(YARD, gravity=(0.0, -2e-7)))
    spawn(world, 'a/0', BOX, (0.0, 5.0, 0.0))

    world.step(2400)

    assert world.snapshot().poses[0, 1] == pytest.approx(5.0 - 1e-5, abs=1e-12)


def test_what_the_air_slows_down_is_slowed_down() -> None:
    world = World(settings=replace(YARD, gravity=(0.0, 0.0), damping=1e-5))
    spawn(world, 'a/0', BOX, (0.0, 5.0, 0.0), velocity=(0.01, 0.0))

    world.step(2400)

    slowed = world.snapshot().twists[0, 0] / 0.01 - 1.0
    assert slowed == pytest.approx(-1e-4, rel=1e-3)


def test_what_coasts_is_found_where_it_is() -> None:
    world = World(settings=replace(YARD, gravity=(0.0, 0.0)))
    spawn(world, 'a/0', DISC, (0.0, 1.0, 0.0), velocity=(0.02, 0.0))
    for step in range(5, 2400, 5):
        world.step(5)
        edge = 0.02 * step * DT + 0.5
        assert world.body_at((edge - 1e-6, 1.0)) == 'a/0'
        assert world.body_at((edge + 1e-6, 1.0)) is None


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
def test_steps_after_a_request_are_solved_for(request_of: Callable[[], Request]) -> None:
    world = at_rest()
    steps = solved(world)

    world.apply(request_of())
    world.step(4)

    assert len(steps) == 4


def test_what_hangs_on_joints_is_solved_for_in_each_step() -> None:
    world = at_rest()
    world.apply(Pin(point=(0.0, 1.0)))
    world.step(480)
    steps = solved(world)

    world.step(STRIDE)

    assert len(steps) == STRIDE


def test_what_begins_to_touch_is_solved_for() -> None:
    world = at_rest()
    # Slow enough to count as rest, and on no ground that could slow it down.
    spawn(world, 'a/0', DISC, (2.0, 0.5, 0.0), velocity=(0.001, 0.0), friction=0.0)
    spawn(world, 'a/1', DISC, (3.005, 0.5, 0.0), friction=0.0)
    world.step(240)
    steps = solved(world)
    assert world.snapshot().twists[3, 0] == pytest.approx(0.001, abs=1e-9)

    while world.snapshot().twists[4, 0] < 1e-4:
        world.step(1)
    struck = world.step_count
    world.step(4)

    assert 240 < struck - 2640 < 1300
    assert struck - 2640 > 7 * len([step for step in steps if step < struck])
    assert steps[-4:] == [struck, struck + 1, struck + 2, struck + 3]


def test_what_is_pushed_out_of_what_it_overlaps_is_solved_for_in_each_step() -> None:
    world = World(settings=replace(YARD, bounds=None, gravity=(0.0, 0.0)))
    for number in range(6):
        spawn(world, f'a/{number}', BOX, (0.7 * number, 0.5, 0.0), elasticity=0.0)
    steps = solved(world)

    world.step(48)

    # It has no velocity.
    assert not world.snapshot().twists.any()
    assert len(steps) == 48


@pytest.mark.parametrize('count', range(480, 480 + STRIDE))
def test_a_wrench_that_ends_holds_no_longer(count: int) -> None:
    world = World(settings=replace(YARD, bounds=None, command_timeout=count * DT))
    spawn(world, 'a/0', DISC, (0.0, 0.5, 0.0), mass=1.0)
    world.apply(Command(names=('a/0',), wrenches=((0.0, G, 0.0),)))
    steps = solved(world)

    world.step(count)
    assert len(steps) < 80
    assert np.abs(world.snapshot().twists).max() < 1e-9
    world.step(240)

    assert len(steps) > 240
    assert world.snapshot().twists[0, 1] == pytest.approx(-G, rel=1e-9)


def test_what_expires_at_rest_goes_in_its_step() -> None:
    world = at_rest()
    spawn(world, 'a/0', DISC, (9.0, 0.5, 0.0), lifetime=1.0)

    world.step(239)
    assert 'a/0' in world.snapshot().scene.names
    world.step(1)

    assert 'a/0' not in world.snapshot().scene.names


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
        spawn(world, f'a/{number}', BOX, pose)


@pytest.mark.parametrize('build', [incline, pyramid, heap])
def test_what_rests_stays_where_it_would_by_every_step(
    build: Callable[[World], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    poses = []
    for stride in (sleeping.STRIDE, DT):
        monkeypatch.setattr(sleeping, 'STRIDE', stride)
        world = World(settings=replace(YARD, bounds=(-5.0, 0.0, 5.0, 40.0), friction=0.5))
        build(world)
        steps = solved(world)
        world.step(240 * 80)
        assert (len(steps) < 240 * 40) == (stride != DT)
        poses.append(world.snapshot().poses)

    assert poses[0] == pytest.approx(poses[1], abs=1e-9)


def into_wall(world: World, velocity: float) -> None:
    spin = -velocity / 0.5
    pose = 19.45, 0.5, 0.0
    spawn(world, 'a/0', DISC, pose, velocity=(velocity, 0.0), spin=spin, elasticity=0.5)


def into_disc(world: World, velocity: float) -> None:
    world.apply(Configure(changes={'gravity': (0.0, 0.0)}))
    for number, pose in enumerate([(0.0, 5.0, 0.0), (1.05, 5.2, 0.0)]):
        twist = velocity * (number == 0), 0.0
        spawn(world, f'a/{number}', DISC, pose, velocity=twist, friction=0.0, elasticity=1.0)


def into_box(world: World, velocity: float) -> None:
    world.apply(Configure(changes={'gravity': (0.0, 0.0)}))
    for number, pose in enumerate([(0.0, 5.0, 0.0), (1.05, 5.2, 0.0)]):
        twist = velocity * (number == 0), 0.0
        spawn(world, f'a/{number}', BOX, pose, velocity=twist, elasticity=1.0)


@pytest.mark.parametrize('velocity', [0.0009, 0.005, 0.0199])
@pytest.mark.parametrize('build', [into_wall, into_disc, into_box])
def test_what_meets_something_slowly_leaves_as_it_would_by_every_step(
    build: Callable[[World, float], None], velocity: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    ends = []
    for stride in (sleeping.STRIDE, DT):
        monkeypatch.setattr(sleeping, 'STRIDE', stride)
        world = World(settings=YARD)
        build(world, velocity)
        world.step(round(0.12 / velocity / DT))
        ends.append(world.snapshot())

    # It has met it.
    assert ends[0].twists[0, 0] < 0.5 * velocity
    assert ends[0].twists == pytest.approx(ends[1].twists, abs=1e-3 * velocity)
    # Seen to touch so late, and so far behind on its way back.
    late = sleeping.SLOW * STRIDE * DT
    assert ends[0].poses[:, :2] == pytest.approx(ends[1].poses[:, :2], abs=2 * late)


def test_the_same_bits_come_again_where_rest_is_disturbed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    coasted: list[sleeping.Rest] = []
    coast = sleeping.Rest.coast

    def noted(rest: sleeping.Rest, *, seen: bool) -> None:
        coasted.append(rest)
        coast(rest, seen=seen)

    monkeypatch.setattr(sleeping.Rest, 'coast', noted)
    sim = Simulation(settings=YARD, keyframes=1.0)
    for number in range(4):
        sim.perform(spawning(f'stack/{number}', BOX, (0.0, 0.5 + number, 0.0)))
    sim.perform(spawning('a/1', DISC, (5.0, 0.5, 0.0), velocity=(0.001, 0.0), friction=0.0))
    digests = {}
    for number in range(60 * 12):
        if number == 60 * 8:
            sim.perform(spawning('a/0', DISC, (0.2, 6.0, 0.0)))
        sim.advance_frame()
        if number % 25 == 0:
            digests[sim.step] = sim.world.digest()

    assert 240 < len(coasted) < 2400
    for step in reversed(digests):
        sim.seek(round(step * DT * 1e9))
        assert sim.world.digest() == digests[step]


def test_what_rests_is_given_its_weight_in_each_frame_until_it_is_disturbed() -> None:
    world = World(settings=replace(YARD, bounds=None))
    world.watching = True
    spawn(world, 'shelf/0', Box(width=2.0, height=1.0), (-0.98, -0.5, 0.0), anchored=True)
    spawn(world, 'a/0', DISC, (0.0, 0.5, 0.0), mass=1.0, friction=0.0, velocity=(0.001, 0.0))
    world.step(4)
    steps, off, fell = solved(world), [], 0
    # At 0.02 m it comes to the edge, and falls: no pair begins to touch, and nothing is asked.
    for _ in range(60 * 24):
        before = world.snapshot().twists[1, :2]
        world.contacts(world.snapshot())
        world.step(4)
        after = world.snapshot()
        given = world.contacts(after).impulses.sum(axis=0)
        fell += not given.any()
        off.append(np.abs(given - after.twists[1, :2] + before - (0.0, G * 4 * DT)).max())

    assert len(steps) < 240 * 23
    assert fell > 30
    # But for half a step of gravity where it comes to fly, or flies no more.
    landed = np.isclose(off, G * DT / 2, rtol=0.0, atol=1e-9)
    assert np.count_nonzero(landed) < 12
    assert max(np.where(landed, 0.0, off)) < 1e-7
