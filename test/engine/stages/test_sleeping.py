# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sleeping by island: rest costs nothing, changes nothing that is seen, and ends when it must."""

from collections.abc import Callable
from dataclasses import fields, replace
from functools import partial
import math
import random
from typing import Any

import numpy as np
from physsim_ros.model.actors import Path
from physsim_ros.model.applied_forces import AppliedForce
from physsim_ros.model.media import Medium
from physsim_ros.model.requests import Command, Configure, Delete, DriveRobot, Request, Restore
from physsim_ros.model.robots import Differential, Robot, Towed
from physsim_ros.model.scene import Body, BODY_DEFAULTS, Wakes
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc, Polygon
from physsim_ros.model.transform import REST
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import World
import pytest

from ...building import (
    BLUE,
    BOX,
    command,
    DISC,
    G,
    join,
    pose,
    sleepers,
    spawn,
    spawning,
    stack,
    twist,
)

YARD = WorldSettings(bounds=(-20.0, 0.0, 20.0, 40.0))
SECOND = 1_000_000_000


def at_rest(count: int = 3) -> World:
    world = World(settings=YARD)
    stack(world, count)
    world.step(1200)
    return world


def test_an_island_sleeps_without_velocity_while_another_one_moves():
    world = at_rest()
    assert len(sleepers(world)) == 3
    assert np.abs(world.snapshot().twists).max() == 0.0
    spawn(world, 'ball/0', DISC, (15.0, 0.5, 0.0), elasticity=1.0, velocity=(0.0, 12.0))

    world.step(240)

    assert len(sleepers(world)) == 3
    assert 'ball/0' not in sleepers(world)


def test_a_ball_that_rolls_at_a_centimetre_a_second_rolls_on():
    world = World(settings=YARD)
    spawn(world, 'ball/0', DISC, (0.0, 0.5, 0.0), velocity=(0.01, 0.0), spin=-0.02)
    world.step(2400)

    # m; as long as it rolls without slipping nothing slows it down
    assert pose(world, 'ball/0')[0] == pytest.approx(0.1, abs=1e-3)


def test_a_pendulum_does_not_sleep_where_it_turns_round():
    world = World(settings=WorldSettings())
    spawn(world, 'bob/0', DISC, (0.02, -2.0, 0.0))
    join(world, 'axle', [(0.0, 0.0)], a='bob/0', b='world')
    reached = []
    for _ in range(40):
        world.step(60)
        reached.append(pose(world, 'bob/0')[0])

    assert max(reached[-20:]) == pytest.approx(0.02, rel=0.05)
    assert min(reached[-20:]) == pytest.approx(-0.02, rel=0.05)


def on_spring(mass: float, stiffness: float, stretch: float, damping: float) -> World:
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    spawn(world, 'bob/0', DISC, mass=mass)
    said = {'stiffness': stiffness, 'rest_length': 2.0 - stretch, 'damping': damping}
    join(world, 'spring', [(0.0, 0.0), (0.0, 2.0)], a='bob/0', b='world', **said)
    return world


def test_what_sinks_on_a_damper_at_a_tenth_of_a_millimetre_a_second_sinks_on():
    world = on_spring(1.0, 1.0, 0.1, 1000.0)

    world.step(7200)

    # m; a time constant of 1000 s, after 30 s
    assert pose(world, 'bob/0')[1] == pytest.approx(0.1 * -math.expm1(-0.03), abs=1e-5)


def test_a_swing_of_a_millimetre_in_forty_seconds_does_not_sleep_where_it_turns_round():
    world = on_spring(40.0, 1.0, 0.001, 0.0)

    for second in range(1, 41):
        world.step(240)
        exact = 0.001 * (1.0 - math.cos(math.sqrt(1 / 40) * second))
        assert pose(world, 'bob/0')[1] == pytest.approx(exact, abs=1e-5)


def test_what_comes_to_rest_on_a_damped_spring_sleeps_there():
    world = on_spring(1.0, 100.0, 0.05, 6.0)

    world.step(2400)

    assert sleepers(world) == ['bob/0']
    assert pose(world, 'bob/0')[1] == pytest.approx(0.05, abs=1e-6)


def test_a_spring_that_sleeps_is_not_solved():
    world = on_spring(1.0, 100.0, 0.05, 6.0)
    world.step(2400)
    assert sleepers(world) == ['bob/0']
    core = world.space.core
    written = core.read_impulses() + 0.01

    core.write_impulses(written)
    world.step(1)

    assert (core.read_impulses()[:, 0] == written[:, 0]).all()


# If a sub-step of falling began the idle time anew, as in Chipmunk, each would take a second more.
@pytest.mark.parametrize(('seed', 'seconds'), [(0, 2.0), (1, 1.75), (4, 3.25)])
def test_a_pile_sleeps_though_a_contact_that_bears_nothing_is_lost_now_and_then(seed, seconds):
    chance = random.Random(seed)
    world = World(settings=WorldSettings(bounds=(-1.0, 0.0, 1.0, 30.0), elasticity=0.0))
    wedge = Polygon(outline=((0.0, 0.0), (0.5, 0.0), (0.4, 0.4)))
    for number in range(20):
        place = 0.6 * (number % 3) - 0.6 + chance.uniform(-0.1, 0.1), 0.5 + 0.7 * (number // 3)
        shape = Box(width=0.5, height=0.5) if number % 2 else wedge
        spawn(world, f'piece/{number}', shape, (*place, chance.uniform(0.0, 3.0)))

    world.step(round(seconds * world.physics_rate))

    assert len(sleepers(world)) == 20


WAKING: dict[str, Callable[[], Request]] = {
    'gravity': lambda: Configure(changes={'gravity': (8.0, -G)}),
    'bounds': lambda: Configure(changes={'bounds': (-20.0, -5.0, 20.0, 40.0)}),
    'pose': lambda: Command(names=('stack/0',), poses=((5.0, 3.0, 0.0),)),
    'twist': lambda: Command(names=('stack/2',), twists=((1.0, 2.0, 0.0),)),
    'wrench': lambda: Command(names=('stack/2',), wrenches=((50.0, 0.0, 0.0),)),
    'deleted': lambda: Delete(name='stack/0'),
    'struck': lambda: spawning('ball/0', DISC, (-3.0, 1.5, 0.0), velocity=(20.0, 0.0)),
    'drawn_into': lambda: spawning('wall/0', Box(width=0.2, height=9.0), anchored=True),
}


@pytest.mark.parametrize('request_of', WAKING.values(), ids=WAKING)
def test_a_sleeping_stack_wakes(request_of):
    world = at_rest()
    before = pose(world, 'stack/2').copy()

    world.apply(request_of())
    world.step(120)

    assert np.abs(pose(world, 'stack/2') - before).max() > 1e-3


def test_a_stack_on_an_anchored_floor_wakes_when_the_floor_is_moved():
    world = World(settings=WorldSettings())
    spawn(world, 'floor/0', Box(width=10.0, height=1.0), (0.0, -0.5, 0.0), anchored=True)
    stack(world, 2)
    world.step(1200)
    assert len(sleepers(world)) == 2

    world.apply(Command(names=('floor/0',), poses=((0.0, -5.0, 0.0),)))
    world.step(120)

    assert pose(world, 'stack/0')[1] < 0.0


# Another value of each property of a body, but of its name.
OTHER: dict[str, Any] = {
    'shape': DISC,
    'color': BLUE,
    'mass': 7.0,
    'density': 3.0,
    'friction': 0.01,
    'elasticity': 0.9,
    'anchored': True,
    'kinematic': True,
    'group': 3,
    'sensor': True,
    'expires': 10**6,
    'surface_velocity': (0.0, 1.0),
    'belt': 1.0,
    'rolling_resistance': 0.5,
    'one_way': (0.0, -1.0),
    'closed_sides': True,
    'robot': Robot(drive=Differential(traction=0.01)),
    'towed': Towed(traction=0.01),
    'label': 'bank',
    'actor': Path(points=((9.0, 0.0, 0.0),), speed=1.0, traction=0.01),
    'forces': (AppliedForce(force=(9.0, 0.0)),),
    'charge': 9.0,
    'medium': Medium(density=1000.0),
}
PROPERTIES = pytest.mark.parametrize('name', [each.name for each in fields(Body)][1:])


def banks(*, anchored: bool) -> World:
    """Return a world on a slope: what lies on a bank sleeps, as does what lies beside it."""
    settings = WorldSettings(gravity=(1.0, -G), bounds=(-9.0, 0.0, 9.0, 9.0), coulomb=1.0)
    world = World(settings=settings)
    spawn(world, 'bank/0', Box(width=4.0, height=1.0), (0.0, 0.5, 0.0), anchored=anchored)
    spawn(world, 'on/0', BOX, (0.0, 1.5, 0.0), group=3)
    spawn(world, 'apart/0', BOX, (7.0, 0.5, 0.0))
    world.step(300)
    assert {'on/0', 'apart/0'} <= {*sleepers(world)}
    return world


def tables() -> World:
    """Return a table that leans, seen from above, with bodies that sleep on it."""
    world = World(settings=WorldSettings(gravity=(1.0, 0.0), floor_friction=0.4))
    spawn(world, 'bank/0', Box(width=4.0, height=1.0), (0.0, 0.5, 0.0))
    spawn(world, 'on/0', BOX, (0.0, 1.5, 0.0), group=3)
    world.step(300)
    assert sleepers(world) == ['bank/0', 'on/0']
    return world


def changed_bank(world: World, name: str) -> Body:
    """Return the description of the bank with another value of a property."""
    body = world.space.bodies.by_name['bank/0'].body
    value = OTHER[name] if getattr(body, name) != OTHER[name] else BODY_DEFAULTS[name]
    # Robots and actors are not anchored.
    movable = {'anchored': False} if name in {'robot', 'actor'} else {}
    return replace(body, **{name: value}, **movable)


def change_bank(world: World, body: Body) -> Wakes:
    bank = world.space.bodies.by_name['bank/0']
    wakes = bank.body.wakes(body)
    world.space.change(bank, body, bank.pose, REST)
    return wakes


@pytest.mark.parametrize('anchored', [True, False])
@PROPERTIES
def test_a_changed_property_wakes_the_body_or_what_touches_it_or_nobody(name, anchored):
    world = banks(anchored=anchored)
    asleep = sleepers(world)

    wakes = change_bank(world, changed_bank(world, name))

    # An anchored body does not sleep; another one wakes with its island.
    itself = set() if anchored else {'bank/0', 'on/0'}
    woken = {Wakes.NOBODY: set(), Wakes.ITSELF: itself, Wakes.TOUCHING: {'bank/0', 'on/0'}}[wakes]
    assert sleepers(world) == [each for each in asleep if each not in woken]
    # A body that wakes by itself keeps contacts and velocity; one that is thrown begins to fly.
    assert wakes is Wakes.TOUCHING or not world.space.bodies.by_name['bank/0'].state['thrown']


@pytest.mark.parametrize(
    'build', [partial(banks, anchored=True), partial(banks, anchored=False), tables]
)
@PROPERTIES
def test_what_sleeps_moves_after_a_change_as_in_a_world_that_begins_with_it(name, build):
    asleep, awake = build(), World()
    body, state = changed_bank(asleep, name), asleep.save()
    bodies = (replace(state.bodies[0], body=body, motion=None), *state.bodies[1:])
    awake.apply(Restore(state=replace(state, bodies=bodies, memory=None)))
    assert not sleepers(awake)

    change_bank(asleep, body)
    for world in (asleep, awake):
        world.step(120)

    # m, rad: the contacts of the other world begin without impulses.
    assert pose(asleep, 'bank/0') == pytest.approx(pose(awake, 'bank/0'), abs=1e-3)
    assert pose(asleep, 'on/0') == pytest.approx(pose(awake, 'on/0'), abs=1e-3)


def test_what_sleeps_on_a_floor_slides_when_its_friction_falls():
    world = tables()

    world.apply(Configure(changes={'floor_friction': 0.05}))
    world.step(240)

    # m: half of what gravity leaves of friction
    assert pose(world, 'on/0')[0] == pytest.approx((1.0 - 0.05 * G) / 2, rel=0.01)


def test_a_conveyor_that_comes_to_a_body_that_sleeps_carries_it():
    world = World(settings=WorldSettings(gravity=(0.0, 0.0), floor_friction=0.5))
    said = {'kinematic': True, 'sensor': True, 'surface_velocity': (0.0, 1.0)}
    spawn(world, 'box/0', BOX)
    spawn(
        world, 'belt/0', Box(width=2.0, height=2.0), (-3.0, 0.0, 0.0), velocity=(1.0, 0.0), **said
    )

    world.step(600)

    # m: the belt is under it for a second, and friction needs a fifth of that.
    assert pose(world, 'box/0')[1] > 0.3


def weights(world: World, seconds: float) -> list[float]:
    """Return the impulses of the ground on its first body, frame by frame [N s]."""
    found = []
    for _ in range(round(60 * seconds)):
        world.step(4)
        contacts = world.contacts(world.snapshot())
        ground = (contacts.pairs[:, 1] == -1) & (contacts.pairs[:, 0] == 0)
        found.append(float(np.abs(contacts.impulses[ground, 1]).sum()))
    return found


def test_sleeping_bodies_stay_in_the_contacts_with_their_weight():
    world = World(settings=YARD)
    world.reports_contacts = True
    stack(world, 3)
    weights(world, 4.0)
    found = weights(world, 2.0)

    assert len(sleepers(world)) == 3
    # N s in a frame; 1 % is law 30
    assert found == pytest.approx([3.0 * G / 60.0] * len(found), rel=0.01)


def test_who_begins_to_watch_sees_the_contacts_of_sleeping_bodies():
    world = at_rest()
    assert len(sleepers(world)) == 3

    world.reports_contacts = True
    found = weights(world, 0.5)

    assert len(sleepers(world)) == 3
    assert found == pytest.approx([3.0 * G / 60.0] * len(found), rel=0.01)


def test_a_contact_that_wakes_is_reported_once():
    world = at_rest()
    world.reports_contacts = True
    weights(world, 0.5)
    world.apply(Command(names=('stack/2',), twists=((0.0, 0.0, 0.0),)))

    # The half-step lead of a velocity that is set is taken back in the first frame.
    assert weights(world, 0.5) == pytest.approx([3.0 * G / 60.0] * 30, rel=0.05)


def course(sim: Simulation, until: int) -> list[str]:
    digests = []
    while sim.step < until:
        sim.advance_frame()
        digests.append(sim.world.digest())
    return digests


def test_rewinding_through_falling_asleep_and_waking_gives_the_same_bits():
    sim = Simulation(settings=YARD)
    for number in range(3):
        pose_of = (0.0, 0.5 + number, 0.0)
        sim.requests.submit(spawning(f'stack/{number}', BOX, pose_of), topic='~/spawn')
    asleep = course(sim, 1200)
    assert len(sleepers(sim.world)) == 3
    ball = spawning('ball/0', Disc(radius=0.2), (-3.0, 1.5, 0.0), velocity=(9.0, 0.0))
    sim.requests.submit(ball, topic='~/spawn')
    awake = course(sim, 1800)

    for back in (1300, 900, 200):
        sim.seek(round(back * SECOND / 240))
        again = course(sim, 1800)
        first = len(asleep + awake) - len(again)
        assert again == (asleep + awake)[first:]


def test_a_save_wakes_nothing():
    one, other = at_rest(), at_rest()

    one.save()
    one.step(60)
    other.step(60)

    assert len(sleepers(one)) == 3
    assert one.digest() == other.digest()


def test_a_body_that_is_spawned_where_one_sleeps_is_pushed_out():
    world = at_rest(1)
    spawn(world, 'late/0', BOX, (0.3, 0.6, 0.0))
    world.step(480)

    apart = abs(pose(world, 'late/0') - pose(world, 'stack/0'))
    assert max(apart[0], apart[1]) > 0.98
    assert np.abs(twist(world, 'late/0')).max() < 0.01


def on_a_floor() -> World:
    """Return a world seen from above in which a disc and a robot sleep."""
    world = World(settings=WorldSettings(gravity=(0.0, 0.0), floor_friction=0.4))
    spawn(world, 'a/0', DISC)
    spawn(world, 'b/0', DISC, (5.0, 0.0, 0.0))
    spawn(world, 'tb/0', DISC, (0.0, 5.0, 0.0), robot={'drive': {'kind': 'omni'}})
    world.step(300)
    assert sleepers(world) == ['a/0', 'b/0', 'tb/0']
    return world


def test_who_looks_at_a_body_that_sleeps_does_not_change_how_it_wakes():
    seen, unseen = on_a_floor(), on_a_floor()
    for world in (seen, unseen):
        command(world, 'a/0', wrench=(8.0, 0.0, 0.0))
        if world is seen:
            world.snapshot()
        world.step(10)

    assert seen.digest() == unseen.digest()
    assert twist(seen, 'a/0')[0] > 0.0


def test_a_robot_that_sleeps_starts_alike_whatever_else_is_asked_in_its_step():
    alone, beside = on_a_floor(), on_a_floor()
    command(beside, 'b/0', wrench=(8.0, 0.0, 0.0))
    for world in (alone, beside):
        world.apply(DriveRobot(name='tb/0', velocity=(1.0, 0.0, 0.0)))
        world.step(10)

    assert pose(alone, 'tb/0').tobytes() == pose(beside, 'tb/0').tobytes()
    assert twist(alone, 'tb/0')[0] > 0.0


def struck(on_floor: bool, mass: float) -> World:
    """Return a world in which a disc comes to another one, which sleeps after half a second."""
    top = {'gravity': (0.0, 0.0), 'floor_friction': 0.1}
    world = World(settings=WorldSettings(**top) if on_floor else YARD)
    spawn(world, 'disc/0', DISC, (0.0, 0.5, 0.0))
    rolling = {'velocity': (2.5, 0.0), 'spin': -5.0}
    spawn(world, 'ball/0', DISC, (-2.8, 0.5, 0.0), mass=mass, **rolling)
    return world


# kg; the light disc wakes the other one without making it too fast for sleep
@pytest.mark.parametrize('mass', [1.0, 1e-4])
@pytest.mark.parametrize('on_floor', [False, True])
def test_a_call_of_many_steps_gives_the_bits_of_calls_of_single_ones(on_floor, mass):
    singly, asleep = struck(on_floor, mass), []
    for steps in range(1, 480):
        singly.step(1)
        asleep.append('disc/0' in sleepers(singly))
        if steps % 30 == 0:
            at_once = struck(on_floor, mass)
            at_once.step(steps)
            assert sleepers(at_once) == sleepers(singly)
            assert at_once.digest() == singly.digest()

    # It falls asleep, wakes and falls asleep again.
    changes = [each for each, before in zip(asleep[1:], asleep, strict=False) if each != before]
    assert changes[:2] == [True, False]
