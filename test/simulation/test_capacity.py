# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A world refuses what it has no place for, before the engine has it, and changes nothing."""

from dataclasses import replace
from typing import Any

from physsim_ros.engine.overlaps import count_inside
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import WorldFull
from physsim_ros.model.requests import (
    Anchor,
    ChangeBody,
    Command,
    Configure,
    Delete,
    DeleteAll,
    MoveBodies,
    Release,
    Request,
    Restore,
    Spawn,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Compound, Shape
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import capacity, World
import pytest
from tools.adversary.scenes import crossing_rods, one_pose, sphere_lists

from ..building import BOX, DISC, ELL, joining, spawn, stack, TRIANGLE

# Of 5 bodies in one place 10 pairs overlap.
FEW = WorldSettings(max_overlaps=10, gravity=(0.0, 0.0))


def flooded(world: World, requests: list[Request]) -> int:
    """Return how many of the requests were refused, each without a change."""
    refused = 0
    for request in requests:
        before = world.digest()
        try:
            world.apply(request)
        except WorldFull:
            refused += 1
            assert world.digest() == before
    return refused


def row(count: int, shape: Shape = DISC, *, distance: float = 3.0, **said: Any) -> World:
    world = World(settings=FEW)
    for number in range(count):
        spawn(world, f'a/{number}', shape, (distance * number, 0.0, 0.0), **said)
    return world


@pytest.mark.parametrize(
    'scene', [one_pose(12), sphere_lists(4, 8), crossing_rods(12)], ids=['pose', 'lists', 'rods']
)
def test_what_overlaps_too_much_is_refused_one_by_one(scene):
    world = World(settings=FEW)

    refused = flooded(world, scene)

    assert 0 < refused < len(scene)
    world.step(10)


def test_a_world_that_is_full_refuses_and_is_seldom_counted(monkeypatch):
    # Large enough that a count takes longer than some requests.
    world = World(settings=replace(FEW, max_overlaps=900))
    assert flooded(world, one_pose(45)) == 3
    every, counted = capacity.count_overlaps, list[int]()

    def count(*args: Any, **said: Any) -> int:
        counted.append(every(*args, **said))
        return counted[-1]

    monkeypatch.setattr(capacity, 'count_overlaps', count)
    for _ in range(2):
        late = [Spawn(name=f'late/{number}', shape=DISC) for number in range(50)]
        assert flooded(world, late) == 50
        world.step(1)
    # At most 100 pieces and overlaps for each request, and a count at each step.
    assert 1000 < sum(counted) <= 100 * 100 + 2 * 945


def test_overlaps_within_bodies_that_move_together_count_once(monkeypatch):
    lump = Compound(element=DISC, centers=((0.0, 0.0),) * 20)
    world = World(settings=replace(FEW, max_overlaps=80))
    for number in range(2):
        spawn(world, f'lump/{number}', lump, (9.0 * number, 0.0, 0.0))
    every, counted = capacity.count_overlaps, list[int]()

    def count(*args: Any, **said: Any) -> int:
        counted.append(every(*args, **said))
        return counted[-1]

    monkeypatch.setattr(capacity, 'count_overlaps', count)
    # Each has 19 within, and so the bound is 76: the rest of the world is not counted.
    world.apply(MoveBodies(names=('lump/0', 'lump/1'), by=(0.0, 1.0)))
    assert counted == [0]


def test_what_has_moved_apart_leaves_a_place():
    world = World(settings=FEW)
    assert flooded(world, one_pose(12)) == 7
    world.apply(MoveBodies(names=('spawn/0', 'spawn/1'), by=(9.0, 0.0)))
    world.step(1)

    spawn(world, 'late/0', DISC)


def test_what_is_deleted_leaves_a_place_within_the_step():
    world = World(settings=FEW)
    assert flooded(world, one_pose(12)) == 7
    world.apply(DeleteAll())

    # Also after some more were refused in between: no count is of bodies that are gone.
    assert flooded(world, one_pose(12)) == 7
    world.apply(Delete(name='spawn/0'))
    assert flooded(world, one_pose(12)[5:]) == 6


@pytest.mark.parametrize(
    'request_',
    [
        Command(names=tuple(f'a/{number}' for number in range(6)), poses=((0.0, 0.0, 0.0),) * 6),
        Spawn(name='a/0', shape=Box(width=99.0, height=1.0)),
        ChangeBody(name='b/0', properties=Properties(anchored=False)),
        Release(point=(0.0, 99.0)),
    ],
    ids=['poses', 'a change in place', 'a change', 'a release'],
)
def test_what_comes_to_overlap_too_much_is_refused(request_):
    world = row(14)
    for number in range(12):
        spawn(world, f'b/{number}', DISC, (0.0, 99.0, 0.0), anchored=True)

    assert flooded(world, [request_]) == 1


def test_bodies_that_are_moved_one_by_one_are_refused():
    world = row(12)
    requests = [Command(names=(f'a/{k}',), poses=((0.0, 9.0, 0.0),)) for k in range(12)]

    assert flooded(world, list(requests)) == 7


def test_a_state_that_overlaps_too_much_is_refused_whole():
    full = World(settings=WorldSettings(max_overlaps=10_000))
    assert flooded(full, one_pose(12)) == 0
    state = full.save()
    world = row(3)

    too_much = Restore(state=type(state)(settings=FEW, bodies=state.bodies))
    assert flooded(world, [too_much]) == 1
    world.apply(Restore(state=state))
    assert len(world) == 12


def test_a_state_of_too_many_bodies_is_refused():
    world = row(3)
    state = replace(world.save(), settings=replace(FEW, max_bodies=2))

    assert flooded(world, [Restore(state=state)]) == 1
    world.apply(Restore(state=replace(state, settings=replace(FEW, max_bodies=3))))


def test_a_world_that_cannot_begin_keeps_its_past():
    simulation = Simulation(settings=FEW)
    for name in ('a/0', 'b/0'):
        simulation.perform(Spawn(name=name, shape=DISC))
        simulation.advance_frame()
    state = replace(simulation.save(), settings=replace(FEW, max_bodies=1))
    with pytest.raises(WorldFull):
        simulation.begin(state)
    assert simulation.step == 8
    assert simulation.undo() == 'undid spawn b/0, back at 0.017 s'


def test_convex_pieces_are_counted():
    world = World(settings=WorldSettings(max_shapes=7))
    discs = Compound(element=DISC, centers=((0.0, 0.0), (2.0, 0.0), (4.0, 0.0)))
    requests: list[Request] = [
        Spawn(name=f'a/{number}', shape=discs, pose=(0.0, 3.0 * number, 0.0))
        for number in range(3)
    ]

    assert flooded(world, requests) == 1
    # In its place there is room for one more.
    world.apply(Spawn(name='a/0', shape=Compound(element=DISC, centers=discs.centers[:2])))
    assert flooded(world, [Restore(state=world.save())]) == 0
    spawn(world, 'b/0', DISC, (0.0, 9.0, 0.0))
    spawn(world, 'b/1', DISC, (0.0, 12.0, 0.0))
    assert flooded(world, [Spawn(name='b/2', shape=DISC, pose=(0.0, 15.0, 0.0))]) == 1


def test_pieces_of_one_body_in_one_place_count_for_a_tenth():
    discs = Compound(element=DISC, centers=((0.0, 0.0),) * 20)
    assert count_inside(discs) == 190

    assert flooded(World(settings=FEW), [Spawn(name='a/0', shape=discs)]) == 1
    anchored = Properties(anchored=True)
    assert flooded(World(settings=FEW), [Spawn(name='a/0', shape=discs, properties=anchored)]) == 0


def test_what_only_touches_is_no_overlap():
    world = World(settings=WorldSettings(max_overlaps=0, bounds=(-50.0, 0.0, 50.0, 30.0)))
    stack(world, 10)
    for number, shape in enumerate((DISC, BOX, ELL, TRIANGLE) * 5):
        spawn(world, f'a/{number}', shape, (5.0 + 4.0 * (number % 4), 1.0 + 4.0 * number, 0.0))
    world.step(480)

    world.apply(Restore(state=world.save()))


def test_a_lower_limit_holds_for_what_comes_then():
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    assert flooded(world, one_pose(6)) == 0
    world.apply(Configure(changes={'max_overlaps': 15}))

    assert flooded(world, [Spawn(name='late/0', shape=DISC)]) == 1


def test_what_was_accepted_once_is_accepted_in_every_replay():
    simulation = Simulation(settings=FEW, speed=1.0)
    for request in one_pose(5):
        simulation.requests.submit(request, topic='~/spawn')
    simulation.advance_frame()
    simulation.perform(Configure(changes={'max_overlaps': 0}))
    for _ in range(30):
        simulation.advance_frame()
    digest = simulation.world.digest()

    for _ in range(2):
        simulation.seek(0)
        simulation.seek(round(31 / 60 * 1e9))

    assert simulation.world.digest() == digest
    assert not [each for each in simulation.advance_frame().answers if each.code]


def test_an_anchored_body_is_anchored_wherever_it_is():
    world = World(settings=FEW)
    assert flooded(world, one_pose(5)) == 0

    world.apply(Anchor(point=(0.0, 0.0)))


def axles(count: int) -> list[Request]:
    """Return requests for axles of one body."""
    return [
        joining('axle', [(0.0, 0.1 * number)], f'axle/{number}', a='a/0')
        for number in range(count)
    ]


@pytest.mark.parametrize('in_all', [True, False])
def test_joints_are_counted(monkeypatch, in_all):
    world = World(settings=WorldSettings(max_joints=4 if in_all else 100))
    spawn(world, 'a/0', DISC, (0.0, 0.0, 0.0))
    if not in_all:
        monkeypatch.setattr(capacity, 'MOST_JOINTS_ON_BODY', 4)

    assert flooded(world, axles(7)) == 3
    assert flooded(world, [*axles(4), Restore(state=world.save())]) == 0
    state = replace(world.save(), settings=WorldSettings(max_joints=3))
    monkeypatch.setattr(capacity, 'MOST_JOINTS_ON_BODY', 3)
    assert flooded(world, [Restore(state=state)]) == 1


def test_topics_of_robots_are_counted(monkeypatch):
    drive, sensors = {'kind': 'omni'}, [{'kind': 'imu', 'name': f'imu{each}'} for each in range(3)]
    topics = Properties(robot={'drive': drive}).robot.topic_count
    monkeypatch.setattr(capacity, 'MOST_ROBOT_TOPICS', 2 * topics + 2)
    world = row(2, robot={'drive': drive, 'sensors': sensors[:1]})
    more = Properties(robot={'drive': drive, 'sensors': sensors})
    requests = [
        Spawn(name='b/0', shape=DISC, properties=Properties(robot={'drive': drive})),
        ChangeBody(name='a/1', properties=more),
    ]
    assert flooded(world, requests) == 2
    full = world.save()
    assert flooded(World(settings=FEW), [Restore(state=full)]) == 0
    monkeypatch.setattr(capacity, 'MOST_ROBOT_TOPICS', 2 * topics)
    assert flooded(World(settings=FEW), [Restore(state=full)]) == 1
