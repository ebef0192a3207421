# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The same requests give the same bits; a refusal changes none; a saved state has them all."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import pairwise
import math
import random

from physsim_ros.model.answer import Answer
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checks import FARTHEST
from physsim_ros.model.errors import (
    Anchored,
    BadProperty,
    Malformed,
    NothingThere,
    Refusal,
    UnknownBody,
    UnknownFrame,
    WorldFull,
)
from physsim_ros.model.requests import (
    Anchor,
    ChangeBody,
    Command,
    Configure,
    Delete,
    DeleteAll,
    DeleteBodies,
    Grab,
    MoveBodies,
    Release,
    Request,
    Restore,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import beginning_of, World
import pytest

from ..building import (
    body_at,
    BOX,
    check_begins_alike,
    DISC,
    ELL,
    join,
    names,
    pose,
    RED,
    SHAPES,
    spawn,
    spawning,
    stack,
)

# The same requests, the same bits


def busy_world() -> World:
    """Return a world with all shapes, roles, and everything that decides how it goes on."""
    world = World(settings=WorldSettings(bounds=(-12.0, 0.0, 12.0, 30.0), damping=0.05))
    stack(world, 4)
    for number, shape in enumerate(SHAPES.values()):
        spawn(world, f'mix/{number}', shape, (2.6 * number - 9.0, 6.0 + number, 0.4 * number),
              velocity=(number - 3.0, -1.0), spin=number - 2.0)  # fmt: skip
    spawn(world, 'peg/0', DISC, (3.0, 3.0, 0.0), anchored=True)
    spawn(world, 'lift/0', BOX, (-6.0, 2.0, 0.1), kinematic=True, velocity=(0.5, 0.0))
    spawn(world, 'gate/0', Box(width=4.0, height=4.0), (5.0, 5.0, 0.0), sensor=True,
          anchored=True)  # fmt: skip
    spawn(world, 'ghost/0', DISC, (7.0, 1.0, 0.0), group=3)
    spawn(world, 'ghost/1', DISC, (7.2, 1.0, 0.0), group=3)
    spawn(world, 'brief/0', DISC, (9.0, 1.0, 0.0), lifetime=0.6)
    # The engine puts its last joint in the place of one that is removed.
    for number in range(6):
        place = (1.5 * number, 25.0, 0.0)
        spawn(world, f'hung/{number}', BOX, place, lifetime=0.3)
        join(world, 'pin', [place[:2]], f'pin/{number}')
    ends = ['world', *(f'link/{number}' for number in range(6))]
    for number, (b, a) in enumerate(pairwise(ends)):
        spawn(world, a, DISC, (number - 10.0, 25.0, 0.0))
        join(world, 'axle', [(number - 10.5, 25.0)], f'axle/{number}', a=a, b=b)
    # In another order than they were spawned.
    world.apply(Command(names=('mix/3', 'mix/1'), wrenches=((3.0, 1.0, 0.5), (-2.0, 0.0, 0.0))))
    return world


def test_many_steps_are_as_many_times_one():
    one_by_one, at_once = busy_world(), busy_world()

    for count in (1, 3, 4, 7, 16, 33, 120):
        at_once.step(count)
        for _ in range(count):
            one_by_one.step(1)
        assert at_once.digest() == one_by_one.digest()


@pytest.mark.parametrize('timeout', [1 / 240, 0.01, 0.03])
def test_a_wrench_that_ends_between_frames_ends_alike_however_steps_are_counted_out(timeout):
    worlds = []
    for _ in range(2):
        world = World(
            settings=WorldSettings(bounds=(-9.0, 0.0, 9.0, 9.0), command_timeout=timeout)
        )
        spawn(world, 'a/0', BOX, (0.0, 0.52, 0.0))
        world.apply(Command(names=('a/0',), wrenches=((3.0, -20.0, 0.5),)))
        worlds.append(world)

    for _ in range(10):
        worlds[0].step(4)
    for _ in range(40):
        worlds[1].step(1)

    assert worlds[0].digest() == worlds[1].digest()


@pytest.mark.parametrize('looking', ['snapshot', 'save', 'digest', 'contacts', 'body_at'])
def test_looking_changes_nothing(looking):
    world, unseen = busy_world(), busy_world()
    world.reports_contacts = looking == 'contacts'

    for _ in range(30):
        world.step(4)
        unseen.step(4)
        match looking:
            case 'contacts':
                world.contacts(world.snapshot())
            case 'body_at':
                body_at(world, (0.0, 0.5))
            case _:
                getattr(world, looking)()

    assert world.digest() == unseen.digest()


CHANGES: dict[str, Callable[[World], object]] = {
    'a step': lambda world: world.step(1),
    'a body': lambda world: spawn(world, 'new/0', DISC, (0.0, 20.0, 0.0)),
    'a colour': lambda world: spawn(world, 'peg/0', DISC, (3.0, 3.0, 0.0), color=RED),
    'a lifetime': lambda world: spawn(world, 'peg/0', DISC, (3.0, 3.0, 0.0), lifetime=9.0),
    'a pose': lambda world: world.apply(Command(names=('mix/1',), poses=((0.0, 20.0, 0.0),))),
    'a velocity': lambda world: world.apply(
        Command(names=('mix/1',), twists=((1.0, 0.0, math.nextafter(1.0, 2.0)),))
    ),
    'a wrench': lambda world: world.apply(
        Command(names=('mix/2',), wrenches=((0.0, 0.0, 1e-300),))
    ),
    'how long a wrench acts': lambda world: (
        world.apply(Configure(changes={'command_timeout': 0.25})),
        world.apply(Command(names=('mix/3',), wrenches=((3.0, 1.0, 0.5),))),
        world.apply(Configure(changes={'command_timeout': 0.5})),
    ),
    'a hand': lambda world: world.apply(Grab(hand='h', point=pose(world, 'mix/2')[:2])),
    'an anchor': lambda world: world.apply(Anchor(point=(0.0, 0.5))),
    'gravity': lambda world: world.apply(Configure(changes={'gravity': (0.0, -9.8)})),
    'iterations': lambda world: world.apply(Configure(changes={'iterations': 11})),
    'a default': lambda world: world.apply(Configure(changes={'friction': 0.51})),
    'a body less': lambda world: world.apply(Delete(name='mix/1')),
}


def test_whatever_decides_how_the_world_goes_on_is_in_the_digest():
    world = busy_world()
    for what, change in CHANGES.items():
        before = world.digest()
        change(world)
        assert world.digest() != before, what


# A refusal changes nothing

REFUSED: dict[str, tuple[Callable[[], Request], type[Refusal], str]] = {
    'a body too many': (lambda: spawning('new/0'), WorldFull, ''),
    'a body in no frame': (lambda: spawning('mix/0', frame='nobody/0'), UnknownFrame,
                           'header.frame_id'),
    'a body in the frame of the world by name': (lambda: spawning('mix/0', frame='world'),
                                                 UnknownFrame, 'header.frame_id'),
    'a body too far by its frame': (
        lambda: spawning('mix/0', DISC, (FARTHEST, 0.0, 0.0), frame='far/0'), BadProperty, 'pose'),
    'a body too heavy': (lambda: spawning('mix/0', Disc(radius=1e4), density=1e12), BadProperty,
                         'density'),
    'a body too light': (lambda: spawning('mix/0', Disc(radius=1e-3), density=1e-9), BadProperty,
                         'density'),
    'a body too heavy by the density it has': (lambda: spawning('dense/0', Disc(radius=10.0)),
                                               BadProperty, 'density'),
    'an anchored body with a velocity': (
        lambda: spawning('peg/0', DISC, velocity=(1.0, 0.0)), Anchored, 'velocity'),
    'an anchored body with a spin': (lambda: spawning('peg/0', DISC, spin=1.0), Anchored,
                                     'velocity'),
    'to anchor a moving body': (
        lambda: spawning('mix/0', DISC, anchored=True, velocity=(0.0, 1.0)), Anchored, 'velocity'),
    'to delete nobody': (lambda: Delete(name='nobody/0'), UnknownBody, 'name'),
    'to delete the world': (lambda: Delete(name='world'), UnknownBody, 'name'),
    'to anchor nothing': (lambda: Anchor(point=(0.0, 29.0)), NothingThere, 'point'),
    'to release nothing': (lambda: Release(point=(0.0, 29.0)), NothingThere, 'point'),
    'to anchor in no frame': (lambda: Anchor(point=(0.0, 0.0), frame='nobody/0'), UnknownFrame,
                              'header.frame_id'),
    'to release too far': (lambda: Release(point=(FARTHEST, 0.0), frame='far/0'), BadProperty,
                           'pose'),
    'to command nobody': (lambda: Command(names=('nobody/0',), poses=((0.0, 0.0, 0.0),)),
                          UnknownBody, 'joint_names'),
    'to command one body and nobody': (
        lambda: Command(names=('mix/0', 'nobody/0'), poses=((0.0, 0.0, 0.0),) * 2), UnknownBody,
        'joint_names'),
    'to pose a body in no frame': (
        lambda: Command(names=('mix/0',), poses=((0.0, 0.0, 0.0),), frame='nobody/0'),
        UnknownFrame, 'header.frame_id'),
    'to pose the second too far': (
        lambda: Command(names=('mix/0', 'mix/1'), frame='far/0',
                        poses=((0.0, 0.0, 0.0), (FARTHEST, 0.0, 0.0))), BadProperty, 'pose'),
    'a twist for an anchored body': (
        lambda: Command(names=('mix/0', 'peg/0'), twists=((1.0, 0.0, 0.0),) * 2), Anchored,
        'joint_names'),
    'a wrench for an anchored body': (
        lambda: Command(names=('mix/0', 'peg/0'), wrenches=((1.0, 0.0, 0.0),) * 2,
                        poses=((0.0, 0.0, 0.0),) * 2), Anchored, 'joint_names'),
    'a wrench for a kinematic body': (
        lambda: Command(names=('mix/0', 'lift/0'), wrenches=((1.0, 0.0, 0.0),) * 2,
                        twists=((1.0, 0.0, 0.0),) * 2), BadProperty, 'wrench'),
    'to change nobody': (lambda: ChangeBody(name='nobody/0', properties=Properties(friction=1.0)),
                         UnknownBody, 'name'),
    'to change a pose in no frame': (
        lambda: ChangeBody(name='mix/0', pose=(0.0, 0.0, 0.0), frame='nobody/0'), UnknownFrame,
        'header.frame_id'),
    'to spin an anchored body': (
        lambda: ChangeBody(name='peg/0', properties=Properties(spin=1.0)), Anchored, 'velocity'),
    'to make a body too heavy': (
        lambda: ChangeBody(name='large/0', properties=Properties(density=1e12, friction=0.0)),
        BadProperty, 'density'),
    'to move one body and nobody': (
        lambda: MoveBodies(names=('mix/0', 'nobody/0'), by=(1.0, 0.0)), UnknownBody, 'names'),
    'to move the second too far': (
        lambda: MoveBodies(names=('mix/0', 'far/0'), by=(FARTHEST - 50.0, 0.0)), BadProperty,
        'by'),
    'to delete one body and nobody': (lambda: DeleteBodies(names=('mix/0', 'nobody/0')),
                                      UnknownBody, 'names'),
    'settings out of range': (lambda: Configure(changes={'friction': 0.1, 'damping': 2.0}),
                              BadProperty, 'damping'),
    'settings that are none': (lambda: Configure(changes={'gravity': (0.0, math.nan)}), Malformed,
                               'gravity'),
}  # fmt: skip


def test_a_refusal_changes_nothing():
    world, other = busy_world(), busy_world()
    for each in (world, other):
        spawn(each, 'far/0', DISC, (100.0, 0.0, 0.0), anchored=True)
        spawn(each, 'large/0', Disc(radius=2.0), (60.0, 0.0, 0.0))
        spawn(each, 'dense/0', Disc(radius=0.01), (9.0, 9.0, 0.0), density=1e10)
        each.apply(Configure(changes={'max_bodies': len(each)}))
        each.step(30)
    before = world.digest()

    for what, (make, error, field) in REFUSED.items():
        with pytest.raises(Refusal) as refused:
            world.apply(make())
        assert (type(refused.value), refused.value.field) == (error, field), what
        assert world.digest() == before, what

    # Nor have they changed what no digest shows.
    world.step(60)
    other.step(60)
    assert world.digest() == other.digest()
    assert world.save() == other.save()


# Saved states


def test_a_restored_world_is_its_first_checkpoint():
    world = World()
    stack(world, 8)
    simulation = Simulation()
    simulation.begin(replace(world.save(), memory=None))

    digest = simulation.world.digest()
    simulation.advance_frame()
    simulation.seek(0)
    assert simulation.world.digest() == digest


def test_a_restored_world_goes_on_alike_with_the_requests_that_follow():
    world = busy_world()
    world.apply(Delete(name='mix/0'))
    world.step(50)
    state = world.save()
    worlds = [World(), World()]

    for each in worlds:
        each.apply(Restore(state=state))
    worlds[1].apply(Restore(state=worlds[1].save()))
    for each in worlds:
        # A colour that nobody chose, an end of a wrench and a lifetime are to come alike.
        spawn(each, 'late/0', ELL, (0.0, 8.0, 0.0), lifetime=0.2)
        each.apply(Command(names=('late/0', 'mix/1'), wrenches=((1.0, 0.0, 0.0),) * 2))
        each.step(120)

    assert worlds[0].digest() == worlds[1].digest()


def test_lifetimes_and_wrenches_of_a_world_that_was_built_ahead_count_from_its_restoring():
    world = busy_world()
    world.apply(Command(names=('mix/1',), wrenches=((1.0, 0.0, 0.0),)))
    check_begins_alike(world.save(), world.physics_rate)


def test_the_checkpoint_of_a_world_that_has_just_begun_has_its_requests():
    world = World()
    world.apply(Restore(state=busy_world().save()))
    spawn(world, 'late/0', DISC, (0.0, 20.0, 0.0))

    assert 'late/0' in world.renew().scene.names


def test_a_checkpoint_is_built_ahead_in_three_quarters_of_the_time_to_it():
    simulation = Simulation(speed=1.0, checkpoints=0.5)
    for number in range(60):
        simulation.perform(spawning(f'a/{number}', DISC, (3.0 * number, 5.0, 0.0)))

    # Of 30 frames, the first and the last ones until which a part is still to be built.
    for frame, is_built in ((15, False), (29, True)):
        while simulation.step < 4 * frame:
            simulation.advance_frame()
        assert simulation.world.is_built_ahead is is_built


def test_a_world_that_was_built_ahead_of_another_one_is_not_begun_with():
    world = World()
    world.keep_built(beginning_of(busy_world().save(), world.physics_rate))

    world.apply(Restore(state=World().save()))

    assert len(world) == 0


def test_restoring_replaces_everything_but_the_time():
    world = World(settings=WorldSettings(max_bodies=7))
    spawn(world, 'a/0', DISC)
    state = world.save()
    world.apply(Configure(changes={'gravity': (1.0, 0.0), 'bounds': (-9.0, -9.0, 9.0, 9.0)}))
    spawn(world, 'a/1', DISC, (4.0, 0.0, 0.0))
    world.step(10)

    answer = world.apply(Restore(state=state)).answer

    assert answer == Answer(message='loaded 1 body')
    assert names(world) == ('a/0',)
    assert world.settings == WorldSettings(max_bodies=7)
    assert world.step_count == 10
    # The walls have gone with the rest.
    world.step(480)
    assert pose(world, 'a/0')[1] < -10.0


def test_a_saved_state_is_not_changed_by_what_follows():
    world = busy_world()
    state = world.save()
    text = repr(state)

    world.step(20)
    world.apply(DeleteAll())

    assert repr(state) == text


def test_a_moment_is_saved_on_a_thread_while_the_world_goes_on():
    world = busy_world()
    saver, state = world.saver(), world.save()
    world.step(20)
    world.renew()
    world.apply(DeleteAll())

    with ThreadPoolExecutor() as pool:
        assert repr(pool.submit(saver).result()) == repr(state)


def test_what_is_loaded_is_saved_as_it_was_though_contacts_end_within_steps():
    # In the steps from 132 and 142 on a joint moves a body off what it lay on.
    chance = random.Random(12)
    world = World(settings=WorldSettings(elasticity=0.5, bounds=(-2.0, -1.0, 2.0, 4.0)))
    for number in range(6):
        shape = DISC if chance.random() < 0.5 else BOX
        where = chance.uniform(-1.5, 1.5), chance.uniform(0.0, 3.0), chance.uniform(0.0, 3.0)
        spawn(world, f'a/{number}', shape, where)
    for number in range(3):
        a, b = (f'a/{each}' for each in chance.sample(range(6), 2))
        points = [tuple(pose(world, name)[:2]) for name in (a, b)]
        join(world, 'rod', points, name=f'rod/{number}', a=a, b=b)
    world.step(130)
    for _ in range(15):
        world.step(1)
        saved, loaded = world.save(), World()
        loaded.apply(Restore(state=saved))

        assert repr(loaded.save().memory) == repr(saved.memory)
