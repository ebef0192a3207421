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

"""How bodies move: in flight, pushed, carried, through each other, under other settings."""

from collections.abc import Callable
from functools import partial
import math

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import Anchored, BadProperty
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import (
    Anchor,
    Command,
    Configure,
    Delete,
    Join,
    Pin,
    Release,
    Request,
    Spawn,
    Unjoin,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc, Shape
from physsim_ros.simulation.world import World
import pytest

from ..building import (
    BOX,
    DISC,
    DT,
    ELL,
    G,
    NOWHERE,
    pose,
    SHAPES,
    spawn,
    stack,
    TRIANGLE,
    twist,
)

REST = (0.0, 0.0, 0.0)
# Rounding error of the 240 sums of a second in float64 [m, m/s].
ROUNDING = 1e-10
YARD = WorldSettings(bounds=(-20.0, 0.0, 20.0, 40.0))


@pytest.fixture
def world() -> World:
    """Return an empty world without gravity, friction or loss."""
    return World(settings=NOWHERE)


def command(world: World, name: str, **rows: tuple[float, float, float]) -> None:
    """Command one body: `pose`, `twist` or `wrench`."""
    arrays = {'pose': 'poses', 'twist': 'twists', 'wrench': 'wrenches'}
    world.apply(Command(names=(name,), **{arrays[key]: (row,) for key, row in rows.items()}))


def unlimited(world: World) -> None:
    world.apply(Configure(changes={'command_timeout': 0.0}))


# Flight, and what pose and twist are of


@pytest.mark.parametrize('shape', SHAPES.values(), ids=SHAPES.keys())
def test_free_flight_is_exact_for_any_shape(shape: Shape) -> None:
    world = World()
    spawn(world, 'a/0', shape, (1.0, 2.0, 0.3), velocity=(3.0, 4.0), spin=5.0)
    center = world.snapshot().centers[0]

    world.step(240)

    # Of the centre of mass: the origin of an off-centre shape goes round it.
    assert world.snapshot().centers[0] == pytest.approx(
        np.add(center, (3.0, 4.0 - G / 2)), abs=ROUNDING
    )
    assert twist(world, 'a/0') == pytest.approx((3.0, 4.0 - G, 5.0), abs=ROUNDING)
    assert pose(world, 'a/0')[2] == pytest.approx(0.3 + 5.0, abs=ROUNDING)


@pytest.mark.parametrize('shape', [ELL, TRIANGLE], ids=['ell', 'triangle'])
def test_an_off_centre_body_turns_about_its_centre_of_mass(shape: Shape, world: World) -> None:
    spawn(world, 'a/0', shape, (1.0, 2.0, 0.3), spin=math.pi / 2)
    x, y = shape.form.centroid
    cos, sin = math.cos(0.3), math.sin(0.3)
    center = (1.0 + cos * x - sin * y, 2.0 + sin * x + cos * y)
    assert world.snapshot().centers[0] == pytest.approx(center, abs=1e-12)

    world.step(240)

    # A quarter turn: the origin is where a quarter turn about the centre brings it.
    expected = (center[0] + (2.0 - center[1]) * -1.0, center[1] + (1.0 - center[0]))
    assert pose(world, 'a/0') == pytest.approx((*expected, 0.3 + math.pi / 2), abs=ROUNDING)
    assert twist(world, 'a/0') == pytest.approx((0.0, 0.0, math.pi / 2), abs=ROUNDING)


def test_a_commanded_pose_is_the_origins_and_a_commanded_twist_the_centres(world: World) -> None:
    spawn(world, 'a/0', ELL, (5.0, 5.0, 1.0))

    command(world, 'a/0', pose=(1.0, 2.0, 0.3), twist=(0.5, -0.5, 2.0))

    assert pose(world, 'a/0') == pytest.approx((1.0, 2.0, 0.3), abs=1e-12)
    assert twist(world, 'a/0').tolist() == [0.5, -0.5, 2.0]
    center = world.snapshot().centers[0]
    world.step(240)
    assert world.snapshot().centers[0] == pytest.approx(np.add(center, (0.5, -0.5)), abs=ROUNDING)


def test_a_commanded_pose_keeps_the_motion() -> None:
    world = World()
    spawn(world, 'a/0', DISC, velocity=(1.0, 2.0), spin=3.0)
    world.step(24)

    command(world, 'a/0', pose=(9.0, 9.0, 0.0))

    assert twist(world, 'a/0') == pytest.approx((1.0, 2.0 - G / 10, 3.0), abs=ROUNDING)
    world.step(24)
    assert twist(world, 'a/0') == pytest.approx((1.0, 2.0 - G / 5, 3.0), abs=ROUNDING)


def test_a_commanded_twist_keeps_the_pose(world: World) -> None:
    spawn(world, 'a/0', ELL, (1.0, 2.0, 0.3), velocity=(9.0, 9.0))

    command(world, 'a/0', twist=(1.0, 0.0, 0.0))

    assert pose(world, 'a/0') == pytest.approx((1.0, 2.0, 0.3), abs=1e-12)
    assert twist(world, 'a/0').tolist() == [1.0, 0.0, 0.0]


def test_a_resting_body_that_is_thrown_flies_exactly() -> None:
    world = World(settings=YARD)
    spawn(world, 'a/0', BOX, (0.0, 0.5, 0.0))
    world.step(480)
    start = pose(world, 'a/0')

    command(world, 'a/0', twist=(2.0, 5.0, 0.0))
    world.step(120)

    assert pose(world, 'a/0') == pytest.approx(
        np.add(start, (1.0, 2.5 - G / 8, 0.0)), abs=ROUNDING
    )


# Wrenches


def hung(world: World) -> Request:
    world.apply(Join(name='rod/0', kind=JointKind.ROD, points=((0.0, 50.0), (0.0, 53.0)), a='r/0'))
    return Unjoin(name='rod/0')


def sprung(world: World) -> Request:
    points = (0.0, 50.0), (0.0, 53.0)
    world.apply(Join(name='spring/0', kind=JointKind.SPRING, points=points, a='r/0'))
    return Unjoin(name='spring/0')


def pinned(world: World) -> Request:
    world.apply(Pin(point=(0.0, 50.0)))
    return Release(point=(0.0, 50.0))


BELOW = (0.0, 49.0, 0.0)


def floored(world: World, request: Request) -> Request:
    spawn(world, 'f/0', BOX, BELOW, anchored=True)
    return request


def walled(world: World) -> Request:
    world.apply(Configure(changes={'bounds': (-9.0, 49.5, 9.0, 90.0)}))
    return Configure(changes={'bounds': None})


@pytest.mark.parametrize(
    'held',
    [
        hung,
        sprung,
        pinned,
        walled,
        partial(floored, request=Delete(name='f/0')),
        partial(floored, request=Command(names=('f/0',), poses=((9.0, 0.0, 0.0),))),
        partial(
            floored,
            request=Spawn(name='f/0', shape=BOX, pose=BELOW, properties=Properties(sensor=True)),
        ),
    ],
    ids=['rod', 'spring', 'pin', 'wall', 'deleted', 'moved', 'sensor'],
)
def test_what_is_let_go_falls_exactly(held: Callable[[World], Request]) -> None:
    world = World()
    spawn(world, 'r/0', BOX, (0.0, 50.0, 0.0))
    let_go = held(world)
    world.step(240)
    before = world.snapshot()
    x, y, _ = before.poses[0]
    world.apply(let_go)
    assert world.snapshot().twists[0] == pytest.approx(before.twists[0], abs=1e-12)
    world.step(480)
    vy = before.twists[0][1]
    assert pose(world, 'r/0')[:2] == pytest.approx((x, y + 2.0 * vy - G * 2.0), abs=1e-9)
    assert twist(world, 'r/0')[1] == pytest.approx(vy - 2.0 * G, abs=1e-9)


def test_what_keeps_another_support_does_not_stir() -> None:
    world = World()
    spawn(world, 'plank/0', Box(width=4.0, height=0.2), (0.0, 2.1, 0.0))
    for number in range(3):
        spawn(
            world,
            f'post/{number}',
            Box(width=0.5, height=2.0),
            (number - 1.0, 1.0, 0.0),
            anchored=True,
        )
    world.step(240)
    before = pose(world, 'plank/0')
    world.apply(Delete(name='post/1'))
    world.step(240)
    assert pose(world, 'plank/0') == pytest.approx(before, abs=1e-4)


def standing(count: int) -> World:
    """Return a stack at rest on a floor that can be taken away; its boxes are rows 1 and up."""
    world = World(settings=WorldSettings(elasticity=0.0))
    spawn(world, 'floor/0', Box(width=20.0, height=1.0), (0.0, -0.5, 0.0), anchored=True)
    stack(world, count)
    world.step(1200)
    return world


@pytest.mark.parametrize(
    ('request_', 'gravity'),
    [
        (Delete(name='floor/0'), (0.0, -G)),
        (Command(names=('floor/0',), poses=((0.0, -9.0, 0.0),)), (0.0, -G)),
        (Configure(changes={'gravity': (0.0, 0.0)}), (0.0, 0.0)),
        (Configure(changes={'gravity': (0.0, G)}), (0.0, G)),
    ],
    ids=['floor deleted', 'floor moved', 'weightless', 'upward'],
)
def test_a_stack_that_loses_its_footing_falls_as_one(
    request_: Request, gravity: tuple[float, float]
) -> None:
    world = standing(10)
    before = world.snapshot()

    world.apply(request_)
    world.step(240)

    # To the rest of the sway of the stack; the weight that it has borne is gone.
    after, now = gravity[1], world.snapshot()
    assert now.twists[-10:, 1] == pytest.approx(after, abs=1e-4)
    assert now.poses[-10:, 1] == pytest.approx(before.poses[-10:, 1] + after / 2, abs=1e-4)


def test_what_stood_on_a_box_that_is_deleted_falls_as_one_and_the_rest_stands() -> None:
    world = standing(8)

    world.apply(Delete(name='stack/3'))
    world.step(48)

    vy = world.snapshot().twists[1:, 1]
    assert vy[3:] == pytest.approx(-0.2 * G, abs=1e-4)
    assert vy[:3] == pytest.approx(0.0, abs=0.02)


def test_a_floor_laid_at_once_holds_the_stack() -> None:
    world = standing(6)

    world.apply(Delete(name='floor/0'))
    spawn(world, 'floor/1', Box(width=20.0, height=1.0), (0.0, -0.5, 0.0), anchored=True)
    world.step(1)

    assert np.abs(world.snapshot().twists).max() < 0.01


@pytest.mark.parametrize('gravity', [(0.0, -9.7), (0.0, -5.0), (0.0, -0.1)])
def test_a_stack_does_not_stir_where_gravity_is_less(gravity: tuple[float, float]) -> None:
    world = standing(10)

    world.apply(Configure(changes={'gravity': gravity}))

    for _ in range(30):
        world.step(1)
        assert np.abs(world.snapshot().twists).max() < 1e-3


def test_gravity_that_comes_back_finds_what_it_left() -> None:
    world = standing(3)

    for gravity in ((1e-310, 0.0), (G, -G), (0.0, 0.0), (0.0, -G)):
        world.apply(Configure(changes={'gravity': gravity}))
    world.step(240)

    assert np.abs(world.snapshot().twists).max() < 1e-3


def test_looking_at_what_is_let_go_changes_nothing() -> None:
    one, other = standing(4), standing(4)

    for world in (one, other):
        world.apply(Delete(name='floor/0'))
        if world is one:
            world.snapshot()
            world.digest()
            world.save()
        spawn(world, 'floor/1', Box(width=20.0, height=1.0), (0.0, -0.5, 0.0), anchored=True)
        world.apply(Delete(name='stack/1'))
    digests = one.digest(), other.digest()
    for world in (one, other):
        world.step(60)

    assert digests[0] == digests[1]
    assert one.digest() == other.digest()


@pytest.mark.parametrize('gravity', [(0.0, 0.0), (0.0, -G)], ids=['weightless', 'falling'])
@pytest.mark.parametrize('shape', [DISC, ELL], ids=['centred', 'off-centre'])
def test_a_force_gives_its_acceleration_exactly(
    shape: Shape, gravity: tuple[float, float]
) -> None:
    world = World(settings=WorldSettings(gravity=gravity, command_timeout=0.0))
    spawn(world, 'a/0', shape, (1.0, 2.0, 0.3), mass=4.0, velocity=(1.0, 1.0))
    center = world.snapshot().centers[0]

    command(world, 'a/0', wrench=(8.0, -2.0, 0.0))
    world.step(240)

    acceleration = np.add(gravity, (2.0, -0.5))
    assert twist(world, 'a/0') == pytest.approx((*np.add(acceleration, 1.0), 0.0), abs=ROUNDING)
    assert world.snapshot().centers[0] == pytest.approx(
        center + 1.0 + acceleration / 2, abs=ROUNDING
    )


def test_a_torque_gives_its_angular_acceleration_exactly(world: World) -> None:
    unlimited(world)
    spawn(world, 'a/0', Disc(radius=0.5), REST, mass=4.0, spin=1.0)

    command(world, 'a/0', wrench=(0.0, 0.0, 1.5))
    world.step(240)

    # I = ½ m r² = 0.5 kg m², so 3 rad/s².
    assert pose(world, 'a/0') == pytest.approx((0.0, 0.0, 1.0 + 1.5), abs=ROUNDING)
    assert twist(world, 'a/0') == pytest.approx((0.0, 0.0, 4.0), abs=ROUNDING)


def test_a_force_acts_in_world_axes_whichever_way_the_body_turns(world: World) -> None:
    unlimited(world)
    spawn(world, 'a/0', BOX, (0.0, 0.0, 1.0), mass=1.0, spin=7.0)

    command(world, 'a/0', wrench=(1.0, 0.0, 0.0))
    world.step(240)

    assert twist(world, 'a/0') == pytest.approx((1.0, 0.0, 7.0), abs=ROUNDING)


@pytest.mark.parametrize(('timeout', 'steps'), [(0.5, 120), (0.1, 24), (1e-6, 1), (0.0101, 3)])
def test_a_wrench_acts_for_the_timeout_of_simulation_time(timeout: float, steps: int) -> None:
    world = World(settings=WorldSettings(gravity=(0.0, 0.0), command_timeout=timeout))
    spawn(world, 'a/0', DISC, mass=1.0)
    world.step(5)

    command(world, 'a/0', wrench=(240.0, 0.0, 0.0))
    for step in range(1, steps + 10):
        world.step(1)
        assert twist(world, 'a/0')[0] == pytest.approx(min(step, steps), abs=1e-9)


@pytest.mark.parametrize(
    ('before', 'after', 'steps'), [(0.0, 0.1, 24), (2.0, 0.1, 24), (0.5, 2.0, 110)]
)
def test_another_timeout_holds_for_a_wrench_that_acts(
    before: float, after: float, steps: int
) -> None:
    world = World(settings=WorldSettings(gravity=(0.0, 0.0), command_timeout=before))
    spawn(world, 'a/0', DISC, mass=1.0)
    command(world, 'a/0', wrench=(240.0, 0.0, 0.0))
    world.step(10)
    world.apply(Configure(changes={'command_timeout': after}))
    world.step(600)
    # Never longer than it was given when it was asked for.
    assert twist(world, 'a/0')[0] == pytest.approx(10 + steps, abs=1e-9)


def test_a_timeout_of_0_is_no_limit(world: World) -> None:
    unlimited(world)
    spawn(world, 'a/0', DISC, mass=1.0)

    command(world, 'a/0', wrench=(1.0, 0.0, 0.0))
    world.step(2400)

    assert twist(world, 'a/0')[0] == pytest.approx(10.0, abs=1e-8)


def test_a_wrench_acts_until_the_next_one(world: World) -> None:
    spawn(world, 'a/0', DISC, mass=1.0)
    command(world, 'a/0', wrench=(1.0, 0.0, 0.0))
    world.step(60)
    # A new one counts from anew, 0.5 s.
    command(world, 'a/0', wrench=(0.0, 2.0, 0.0))
    world.step(100)
    assert twist(world, 'a/0') == pytest.approx((0.25, 200 * DT, 0.0), abs=ROUNDING)
    world.step(100)
    assert twist(world, 'a/0') == pytest.approx((0.25, 1.0, 0.0), abs=ROUNDING)

    command(world, 'a/0', wrench=(1.0, 0.0, 0.0))
    command(world, 'a/0', wrench=REST)
    world.step(24)
    assert twist(world, 'a/0') == pytest.approx((0.25, 1.0, 0.0), abs=ROUNDING)


def test_a_wrench_begins_and_ends_without_a_jump_of_velocity(world: World) -> None:
    spawn(world, 'a/0', DISC, mass=1.0, velocity=(1.0, 0.0))

    command(world, 'a/0', wrench=(100.0, 0.0, 10.0))
    assert twist(world, 'a/0') == pytest.approx((1.0, 0.0, 0.0), abs=ROUNDING)
    world.step(120)
    assert twist(world, 'a/0')[0] == pytest.approx(51.0, abs=1e-9)
    command(world, 'a/0', wrench=REST)
    assert twist(world, 'a/0')[0] == pytest.approx(51.0, abs=1e-9)


def test_a_wrench_that_only_one_of_two_is_given_moves_only_that(world: World) -> None:
    for number in range(2):
        spawn(world, f'a/{number}', DISC, (5.0 * number, 0.0, 0.0), mass=1.0)

    world.apply(Command(names=('a/1', 'a/0'), wrenches=((1.0, 0.0, 0.0), REST)))
    world.step(24)

    assert twist(world, 'a/0').tolist() == [0.0, 0.0, 0.0]
    assert twist(world, 'a/1')[0] == pytest.approx(0.1, abs=ROUNDING)


def test_an_anchored_body_takes_a_pose_only(world: World) -> None:
    spawn(world, 'a/0', BOX, anchored=True)

    command(world, 'a/0', pose=(1.0, 2.0, 0.3))
    assert pose(world, 'a/0').tolist() == [1.0, 2.0, 0.3]
    for rows in ({'twist': REST}, {'wrench': REST}, {'pose': REST, 'twist': (1.0, 0.0, 0.0)}):
        with pytest.raises(Anchored):
            command(world, 'a/0', **rows)
    assert pose(world, 'a/0').tolist() == [1.0, 2.0, 0.3]


def test_a_command_is_carried_out_whole_or_not_at_all(world: World) -> None:
    for number in range(3):
        spawn(world, f'a/{number}', DISC, (5.0 * number, 0.0, 0.0), anchored=number == 2)
    before = world.snapshot()

    with pytest.raises(Anchored):
        world.apply(
            Command(
                names=('a/0', 'a/1', 'a/2'),
                poses=((1.0, 1.0, 1.0),) * 3,
                twists=((1.0, 1.0, 1.0),) * 3,
            )
        )

    after = world.snapshot()
    assert np.array_equal(after.poses, before.poses)
    assert np.array_equal(after.twists, before.twists)


def test_a_command_moves_many_bodies_at_once(world: World) -> None:
    for number in range(3):
        spawn(world, f'a/{number}', DISC)

    answer = world.apply(
        Command(
            names=('a/2', 'a/0'),
            poses=((1.0, 0.0, 0.0), (2.0, 0.0, 0.0)),
            twists=((3.0, 0.0, 0.0), (4.0, 0.0, 0.0)),
        )
    )

    assert answer == ('', 'commanded 2 bodies')
    assert world.snapshot().poses[:, 0].tolist() == [2.0, 0.0, 1.0]
    assert world.snapshot().twists[:, 0].tolist() == [4.0, 0.0, 3.0]


# Kinematic bodies


def test_a_kinematic_body_pushes_and_is_not_pushed() -> None:
    world = World(settings=YARD)
    spawn(world, 'robot/0', BOX, (-3.0, 0.5, 0.0), kinematic=True, velocity=(1.0, 0.0))
    spawn(world, 'crate/0', BOX, (0.0, 0.5, 0.0), mass=1000.0)

    world.step(960)

    # Neither the crate nor gravity has held it up, not by a last bit more than the sums.
    assert pose(world, 'robot/0') == pytest.approx((1.0, 0.5, 0.0), abs=ROUNDING)
    assert twist(world, 'robot/0').tolist() == [1.0, 0.0, 0.0]
    assert pose(world, 'crate/0')[0] >= 2.0 - 0.006


def test_a_kinematic_body_passes_what_is_anchored(world: World) -> None:
    spawn(world, 'wall/0', Box(width=0.5, height=9.0), anchored=True)
    spawn(world, 'robot/0', BOX, (-2.0, 0.0, 0.0), kinematic=True, velocity=(1.0, 0.0), spin=0.5)

    world.step(960)

    assert pose(world, 'robot/0') == pytest.approx((2.0, 0.0, 2.0), abs=ROUNDING)


def test_a_kinematic_body_takes_pose_and_twist_and_no_wrench(world: World) -> None:
    spawn(world, 'robot/0', ELL, kinematic=True)

    command(world, 'robot/0', pose=(1.0, 2.0, 0.3), twist=(0.0, 1.0, 0.0))
    assert pose(world, 'robot/0') == pytest.approx((1.0, 2.0, 0.3), abs=1e-12)
    world.step(240)
    assert pose(world, 'robot/0') == pytest.approx((1.0, 3.0, 0.3), abs=ROUNDING)
    with pytest.raises(BadProperty):
        command(world, 'robot/0', wrench=(1.0, 0.0, 0.0))


def test_a_kinematic_body_can_be_anchored_and_let_go_as_it_was(world: World) -> None:
    spawn(world, 'robot/0', BOX, kinematic=True, velocity=(1.0, 0.0))

    world.apply(Anchor(point=(0.0, 0.0)))
    world.step(24)
    assert pose(world, 'robot/0').tolist() == [0.0, 0.0, 0.0]
    spawn(world, 'robot/0', BOX, anchored=False, velocity=(1.0, 0.0))
    spawn(world, 'ball/0', DISC, (3.0, 0.0, 0.0), mass=1e6, velocity=(-1.0, 0.0))
    world.step(240)

    assert pose(world, 'robot/0') == pytest.approx((1.0, 0.0, 0.0), abs=ROUNDING)


# Sensors and groups


def test_a_sensor_reports_what_it_overlaps_and_pushes_nothing(world: World) -> None:
    spawn(world, 'gate/0', Box(width=1.0, height=4.0), (2.0, 0.0, 0.0), sensor=True, anchored=True)
    spawn(world, 'a/0', DISC, velocity=(5.0, 1.0))
    world.watching = True

    seen = []
    for _ in range(120):
        world.step(1)
        contacts = world.contacts(world.snapshot())
        seen.append(contacts.pairs.tolist())
        assert not contacts.impulses.any()

    assert pose(world, 'a/0') == pytest.approx((2.5, 0.5, 0.0), abs=ROUNDING)
    touching = [step for step, pairs in enumerate(seen, 1) if pairs]
    # From x = 1, where the rim meets the gate, to the end at 2.5.
    assert touching == list(range(touching[0], 121))
    assert touching[0] == pytest.approx(1.0 / 5.0 * 240, abs=2)
    begun = touching[0]
    assert all(pairs == [[0, 1]] for pairs in seen[begun:])


def test_a_loose_sensor_falls_through_everything() -> None:
    world = World(settings=YARD)
    spawn(world, 'floor/0', BOX, (0.0, 5.0, 0.0), anchored=True)
    spawn(world, 'ghost/0', DISC, (0.0, 8.0, 0.0), sensor=True)

    world.step(240)

    assert pose(world, 'ghost/0') == pytest.approx((0.0, 8.0 - G / 2, 0.0), abs=ROUNDING)


@pytest.mark.parametrize(
    ('groups', 'through'),
    [((0, 0), False), ((1, 1), True), ((1, 2), False), ((1, 0), False), ((-1, -1), True),
     ((-1, 1), False), ((-1, 2**31 - 1), False), ((-(2**31), 2**31 - 1), False),
     ((-(2**31), 0), False)],
)  # fmt: skip
@pytest.mark.parametrize('speed', [2.0, 200.0], ids=['slow', 'fast'])
def test_bodies_of_one_group_pass_through_each_other(
    *, groups: tuple[int, int], through: bool, speed: float, world: World
) -> None:
    spawn(world, 'a/0', DISC, (-2.0, 0.0, 0.0), velocity=(speed, 0.0), group=groups[0])
    spawn(world, 'a/1', DISC, (2.0, 0.0, 0.0), velocity=(-speed, 0.0), group=groups[1])

    world.step(round(4.0 / speed * 240))

    left, right = world.snapshot().poses[:, 0]
    assert bool(left > right) is through


def test_a_group_is_kept_where_the_body_is_changed(world: World) -> None:
    for number in range(2):
        spawn(world, f'a/{number}', DISC, (-1.0 + 2.0 * number, 0.0, 0.0), group=-5)

    spawn(world, 'a/0', BOX, (-1.0, 0.0, 0.0), velocity=(3.0, 0.0))
    world.step(240)

    assert twist(world, 'a/0').tolist() == [3.0, 0.0, 0.0]


# Material


def test_the_pair_has_the_geometric_mean_of_the_elasticities(world: World) -> None:
    spawn(world, 'a/0', DISC, (-1.0, 0.0, 0.0), velocity=(1.0, 0.0), elasticity=0.9)
    spawn(world, 'a/1', DISC, (1.0, 0.0, 0.0), elasticity=0.4, anchored=True)

    world.step(480)

    assert twist(world, 'a/0')[0] == pytest.approx(-math.sqrt(0.9 * 0.4), abs=1e-6)


@pytest.mark.parametrize('mass', [1.0, 250.0])
def test_a_mass_is_the_mass_whatever_the_shape(mass: float, world: World) -> None:
    spawn(world, 'a/0', TRIANGLE, mass=mass)

    command(world, 'a/0', wrench=(mass, 0.0, 0.0))
    world.step(24)

    assert twist(world, 'a/0')[0] == pytest.approx(0.1, abs=ROUNDING)
    assert world.snapshot().scene.inertia[0, 0] == mass


# Settings while the world runs


@pytest.mark.parametrize('gravity', [(0.0, 0.0), (0.0, 9.81), (3.0, -20.0)])
def test_a_change_of_gravity_lets_no_velocity_jump(gravity: tuple[float, float]) -> None:
    world = World()
    spawn(world, 'a/0', ELL, REST, velocity=(1.0, 2.0), spin=1.0)
    world.step(24)
    before, center = twist(world, 'a/0'), world.snapshot().centers[0]

    world.apply(Configure(changes={'gravity': gravity}))

    assert twist(world, 'a/0') == pytest.approx(before, abs=ROUNDING)
    world.step(240)
    assert twist(world, 'a/0') == pytest.approx(np.add(before, (*gravity, 0.0)), abs=ROUNDING)
    assert world.snapshot().centers[0] == pytest.approx(
        center + before[:2] + np.array(gravity) / 2, abs=ROUNDING
    )


def test_damping_takes_its_share_each_second(world: World) -> None:
    spawn(world, 'a/0', DISC, velocity=(8.0, 0.0), spin=4.0)

    world.apply(Configure(changes={'damping': 0.75}))
    world.step(240)
    assert twist(world, 'a/0') == pytest.approx((2.0, 0.0, 1.0), rel=1e-9)
    world.apply(Configure(changes={'damping': 0.0}))
    world.step(240)
    assert twist(world, 'a/0') == pytest.approx((2.0, 0.0, 1.0), rel=1e-9)


def test_damping_of_1_stops_what_is_loose_and_nothing_kinematic(world: World) -> None:
    spawn(world, 'a/0', DISC, velocity=(8.0, 0.0))
    spawn(world, 'robot/0', DISC, (0.0, 5.0, 0.0), velocity=(1.0, 0.0), kinematic=True)

    world.apply(Configure(changes={'damping': 1.0}))
    world.step(240)

    assert twist(world, 'a/0').tolist() == [0.0, 0.0, 0.0]
    assert pose(world, 'robot/0')[0] == pytest.approx(1.0, abs=ROUNDING)


def test_walls_are_raised_moved_and_taken_down_while_the_world_runs(world: World) -> None:
    spawn(world, 'a/0', DISC, velocity=(4.0, 0.0))

    world.apply(Configure(changes={'bounds': (-5.0, -5.0, 5.0, 5.0)}))
    world.step(480)
    assert pose(world, 'a/0')[0] == pytest.approx(9.0 - 8.0, abs=0.05)
    world.apply(Configure(changes={'bounds': (-2.0, -5.0, 5.0, 5.0)}))
    world.step(240)
    # At x = -1.5 it turned back: 2.5 m there, 1.5 m back.
    assert pose(world, 'a/0')[0] == pytest.approx(0.0, abs=0.05)
    world.apply(Configure(changes={'bounds': None}))
    world.step(480)
    assert pose(world, 'a/0')[0] == pytest.approx(8.0, abs=0.05)


@pytest.mark.parametrize('side', range(4))
def test_each_wall_holds(side: int) -> None:
    gravity = ((-G, 0.0), (0.0, -G), (G, 0.0), (0.0, G))[side]
    world = World(settings=WorldSettings(gravity=gravity, bounds=(-3.0, -2.0, 4.0, 5.0)))
    spawn(world, 'a/0', DISC)

    world.step(1200)

    # On the slop of 5 mm.
    edge = (-2.5, -1.5, 3.5, 4.5)[side]
    assert pose(world, 'a/0')[side % 2] == pytest.approx(edge, abs=0.006)


def test_walls_are_made_of_the_default_material() -> None:
    world = World(settings=WorldSettings(gravity=(0.0, 0.0), bounds=(-5.0, -5.0, 5.0, 5.0)))
    spawn(world, 'a/0', DISC, (3.0, 0.0, 0.0), velocity=(4.0, 0.0), elasticity=1.0)

    world.apply(Configure(changes={'elasticity': 0.25}))
    world.step(240)

    assert twist(world, 'a/0')[0] == pytest.approx(-4.0 * 0.5, abs=1e-6)


@pytest.mark.parametrize(
    'changes',
    [{'density': 2.0}, {'command_timeout': 2.0}, {'max_bodies': 99}, {'iterations': 10},
     {'bounds': (-20.0, 0.0, 20.0, 40.0)}],
)  # fmt: skip
def test_a_stack_on_a_wall_does_not_stir_at_what_does_not_concern_it(
    changes: dict[str, object],
) -> None:
    world, other = World(settings=YARD), World(settings=YARD)
    for each in (world, other):
        stack(each, 6)
        each.step(480)

    world.apply(Configure(changes=changes))
    for each in (world, other):
        each.step(60)

    assert np.array_equal(world.snapshot().poses, other.snapshot().poses)


def test_more_iterations_hold_a_stack_better() -> None:
    speeds = []
    for iterations in (1, 30):
        world = World(settings=YARD)
        stack(world, 8)
        world.apply(Configure(changes={'iterations': iterations}))
        world.step(120)
        speeds.append(float(np.abs(world.snapshot().twists).max()))

    assert speeds[0] > 2 * speeds[1]


def test_a_heavy_box_lies_on_a_light_one() -> None:
    world = World()
    spawn(world, 'floor/0', Box(width=10.0, height=1.0), (0.0, -0.5, 0.0), anchored=True)
    for number, mass in enumerate((1.0, 30.0)):
        box = Box(width=0.5, height=0.5)
        spawn(world, f'box/{number}', box, (0.0, 0.25 + 0.5 * number, 0.0), mass=mass)
    for _ in range(100):
        world.step(24)
        assert pose(world, 'box/1') == pytest.approx((0.0, 0.75, 0.0), abs=5e-3)


def test_a_change_of_defaults_changes_no_body(world: World) -> None:
    spawn(world, 'a/0', DISC)
    before = world.snapshot().scene.bodies[0]

    world.apply(Configure(changes={'density': 9.0, 'friction': 0.1, 'elasticity': 0.1}))
    spawn(world, 'a/1', DISC, (3.0, 0.0, 0.0))

    first, second = world.snapshot().scene.bodies
    assert first == before
    assert (second.density, second.friction, second.elasticity) == (9.0, 0.1, 0.1)


# Lost bodies


def test_a_body_that_leaves_the_range_of_numbers_is_removed_and_told(world: World) -> None:
    unlimited(world)
    spawn(world, 'a/0', DISC, mass=1e-9)
    spawn(world, 'a/1', DISC, (5.0, 0.0, 0.0), velocity=(1.0, 0.0))
    command(world, 'a/0', wrench=(-1e12, 0.0, 0.0))

    lost = [world.step(4) for _ in range(3)]

    assert lost == [('a/0',), (), ()]
    assert 'a/0' not in world
    assert pose(world, 'a/1') == pytest.approx((5.0 + 12 * DT, 0.0, 0.0), abs=ROUNDING)


def test_a_body_that_is_lost_in_the_last_step_of_its_life_goes_once(world: World) -> None:
    unlimited(world)
    spawn(world, 'a/0', DISC, mass=1e-9, lifetime=DT)
    command(world, 'a/0', wrench=(-1e12, 0.0, 0.0))

    lost = world.step(4)

    assert lost == ('a/0',)
    assert 'a/0' not in world


# Energy and momentum


def test_energy_and_momentum_are_those_of_the_formulas() -> None:
    world = World(settings=WorldSettings(gravity=(1.0, -G)))
    spawn(world, 'a/0', ELL, (1.0, 2.0, 0.0), mass=3.0, velocity=(4.0, 5.0), spin=6.0)
    spawn(world, 'a/1', DISC, (9.0, 9.0, 0.0), mass=2.0, velocity=(-1.0, 0.0))
    spawn(world, 'a/2', DISC, (20.0, 9.0, 0.0), mass=2.0, velocity=(7.0, 0.0), kinematic=True)
    spawn(world, 'a/3', DISC, (30.0, 9.0, 0.0), mass=2.0, anchored=True)

    snapshot = world.snapshot()

    moment = 3.0 * ELL.form.gyration
    assert snapshot.kinetic_energy == pytest.approx(
        3.0 * 41.0 / 2 + moment * 36.0 / 2 + 2.0 * 1.0 / 2, rel=1e-12
    )
    center = (1.0 + 5.0 / 6.0, 2.0 + 5.0 / 6.0)
    assert snapshot.potential_energy == pytest.approx(
        -3.0 * (center[0] - G * center[1]) - 2.0 * (9.0 - G * 9.0), rel=1e-12
    )
    assert snapshot.momentum == pytest.approx((3.0 * 4.0 - 2.0, 15.0), rel=1e-12)


def test_an_empty_world_has_no_energy(world: World) -> None:
    snapshot = world.snapshot()

    assert (snapshot.kinetic_energy, snapshot.potential_energy) == (0.0, 0.0)
    assert snapshot.momentum == (0.0, 0.0)


def test_a_body_that_is_faster_than_any_number_is_lost() -> None:
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    for number in range(3):
        spawn(world, f'a/{number}', BOX, (1.0 * number, 0.0, 0.0))
    world._space.bodies.by_name['a/1'].engine.velocity = (1e300, 0.0)  # noqa: SLF001
    assert 'a/1' in world.step(1)
    world.step(100)
    assert world.snapshot().scene.names[0] == 'a/0'
    assert pose(world, 'a/0').tolist() == [0.0, 0.0, 0.0]
