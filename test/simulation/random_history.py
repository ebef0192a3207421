# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Random histories of a simulation, each made of a seed.

A history is a list of operations: requests, speeds, seeks, undo, redo, resets, courses, limits,
saved worlds and moments. Each is the name of a method of `histories.Player` with its arguments.
Names are few, so that requests meet. Some histories begin with a shipped world, and are about its
bodies.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
import functools
import random
from typing import Any

from physsim_ros.files import load_world, shipped_worlds, worlds_in
from physsim_ros.model import requests
from physsim_ros.model.actors import actor_from
from physsim_ros.model.applied_forces import forces_from
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.robots import Robot
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon, Shape

# A call of `Player`: the name of a method and its arguments.
Operation = tuple[Any, ...]

SETTINGS = WorldSettings(bounds=(-5.0, 0.0, 5.0, 9.0))
RATES = ((240.0, 60.0), (240.0, 60.0), (480.0, 30.0), (60.0, 60.0), (1000.0, 50.0))
SHAPES = (
    Disc(radius=0.3),
    Disc(radius=0.05),
    Box(width=0.8, height=0.4),
    Polygon(outline=((0.0, 0.0), (1.0, 0.0), (0.2, 0.3), (0.0, 1.0))),
    Compound(element=Box(width=0.3, height=0.3), centers=((-0.3, 0.0), (0.0, 0.0), (0.0, 0.3))),
    Chain(points=((-1.0, 0.0), (0.0, 0.2), (1.0, 0.0)), thickness=0.1),
)
NAMES = tuple(f'a/{number}' for number in range(4))
JOINTS = ('j/0', 'j/1')
# People, of whom '' is nobody.
AUTHORS = ('', 'ann', 'ben')
WORLDS = tuple(sorted(worlds_in(shipped_worlds())))
# Each kind of drive, some with odometry that errs.
ROBOTS = tuple(
    Robot.from_mapping(each)
    for each in (
        {'drive': {'kind': 'differential', 'track': 0.2, 'timeout': 0.1}},
        {'drive': {'kind': 'differential', 'track': 0.2}, 'odometry': {'slip': [0.1, 0.2]}},
        {'drive': {'kind': 'omni', 'max_speed': 2.0}},
        {'drive': {'kind': 'car', 'wheelbase': 0.3}, 'odometry': {'slip': [0.01, 0.02]}},
    )
)

# Applied forces: none, one of a fixed direction at an arm, a thruster.
FORCES = tuple(
    forces_from(each, 'forces')
    for each in (
        [],
        [{'force': [2.0, 0.0], 'at': [0.1, 0.2]}],
        [{'force': [0.0, 5.0], 'axes': 'body'}, {'force': [1.0, 1.0]}],
    )
)
# Each kind of actor, and of start.
ACTORS = tuple(
    actor_from(each, 'actor')
    for each in (
        {'kind': 'path', 'points': [[0, 1], [2, 1]], 'speed': 1.0, 'repeat': 'to_and_fro'},
        {'kind': 'path', 'points': [[0, 1, 0], [1, 2, 9]], 'times': [0, 1], 'start': {'time': 1}},
        {'kind': 'orca', 'points': [[-3, 3], [3, 3]], 'start': {'gate': 'a/0'}},
        {'kind': 'social_force', 'points': [[-3, 3], [3, 3]], 'repeat': 'loop'},
        {'kind': 'orca', 'points': [[1, 1]], 'start': {'near': 'a/1', 'distance': 3}},
    )
)


@functools.cache
def shipped_world(name: str, physics_rate: float) -> WorldState:
    """Return a world that ships with the package, for a rate [Hz]."""
    return load_world(worlds_in(shipped_worlds())[name], physics_rate=physics_rate)


class Choices(random.Random):
    """
    Random choices of a seed.

    :ivar names: of the bodies that requests are about
    :ivar joints: names of the joints
    """

    def __init__(self, seed: int) -> None:
        super().__init__(seed)
        self.names = NAMES
        self.joints = JOINTS

    def take_names_of(self, world: WorldState) -> None:
        """Choose among names of some of the bodies and joints of a world, too."""
        self.names = (*NAMES[:2], *self.some([each.body.name for each in world.bodies], 6))
        self.joints = (*JOINTS[:1], *self.some([each.name for each in world.joints], 3))

    def number(self, most: float = 3.0) -> float:
        """Choose a number of at most that size, which is short in a program."""
        return round(self.uniform(-most, most), 2)

    def point(self) -> tuple[float, float]:
        """Choose a point in the upper half of the bounds [m]."""
        return self.number(), round(self.number() + 3.0, 2)

    def shape(self) -> Shape:
        """Choose one of a few shapes."""
        return self.choice(SHAPES)

    def made(self, makers: Sequence[tuple[int, Callable[[], Any]]]) -> Any:
        """Choose one of some functions by their weights, and return what it makes."""
        weights, functions = zip(*makers, strict=True)
        return self.choices(functions, weights)[0]()

    def some(self, those: Sequence[str], most: int) -> list[str]:
        """Choose some, each once."""
        return self.sample(those, min(most, len(those)))


def history_of(seed: int) -> list[Operation]:
    """Return the operations of a seed."""
    rng = Choices(seed)
    physics, publish = rng.choice(RATES)
    operations: list[Operation] = [
        ('begin', physics, publish, rng.choice((0.1, 0.17, 0.5, 1.0, 3.0)), rng.random() < 0.5)
    ]
    if rng.random() < 0.1:
        world = rng.choice(WORLDS)
        rng.take_names_of(shipped_world(world, physics))
        operations.append(('load_shipped', world))
    spawns = (replace(spawn_of(rng), name=name, lifetime=0.0) for name in NAMES)
    operations += [('ask', spawn) for spawn in spawns if rng.random() < 0.8]
    if rng.random() < 0.4:
        operations += [('ask', request) for request in robots_of(rng)]
    if rng.random() < 0.5:
        # The state that a reset returns to.
        operations += [('save',), ('load',)]
    for _ in range(rng.randint(8, 50)):
        operations.append(operation_of(rng))
    return operations


def operation_of(rng: Choices) -> Operation:
    makers: list[tuple[int, Callable[[], Operation]]] = [
        (5, lambda: ('ask', request_of(rng), rng.choice(AUTHORS))),
        (5, lambda: ('ask_running', request_of(rng), rng.choice(AUTHORS))),
        (2, lambda: ('ask_at_once', tuple(request_of(rng) for _ in range(rng.randint(2, 5))),
                     rng.random() < 0.5, rng.choice(AUTHORS))),
        (8, lambda: ('run', rng.choice((1.0, 1.0, 1.0, 4.0, 0.3, -1.0, -4.0, -0.3, -64.0)),
                     rng.randint(1, 40))),
        (2, lambda: ('run_overdue', rng.choice((1.0, 4.0, -1.0, -4.0)), rng.randint(1, 30))),
        (6, lambda: ('seek', round(rng.random(), 3))),
        (2, lambda: ('seek_overdue', round(rng.random(), 3), rng.randint(0, 8))),
        (6, lambda: ('undo',)),
        (5, lambda: ('redo',)),
        (2, lambda: ('take_back', rng.choice(AUTHORS[1:]), rng.randint(0, 30))),
        (2, lambda: ('amend', rng.randint(1, 6),
                     tuple(request_of(rng) for _ in range(rng.randint(0, 2))),
                     rng.randint(0, 30))),
        (3, lambda: ('reset',)),
        (4, lambda: ('course', rng.randint(0, 7))),
        (1, lambda: ('limit_memory', rng.choice((1.0, 2.0, 16.0, 256.0)))),
        (1, lambda: ('limit_history', rng.choice((0.5, 1.0, 5.0, 600.0)))),
        (2, lambda: ('save',)),
        (1, lambda: ('load',)),
        (1, lambda: ('open_world', rng.random() < 0.5)),
        (3, lambda: ('save_moment', rng.randint(0, 12))),
        (1, lambda: ('restore',)),
        (1, lambda: ('report_contacts', rng.random() < 0.5)),
        (2, lambda: ('drag', rng.choice(rng.names), rng.point(), rng.randint(1, 10),
                     rng.random() < 0.5)),
    ]  # fmt: skip
    return rng.made(makers)


def spawn_of(rng: Choices) -> requests.Spawn:
    anchored = rng.random() < 0.2
    wild = rng.random() < 0.1
    speed = 300.0 if wild else 3.0
    said: dict[str, Any] = {'anchored': anchored or None}
    if not anchored and rng.random() < 0.5:
        said |= {'velocity': (rng.number(speed), rng.number(speed))}
        said |= {'spin': rng.number(speed)}
    match rng.randint(0, 9):
        case 0:
            said['mass'] = rng.choice((0.1, 1.0, 1e3 if wild else 3.0))
        case 1:
            said['density'] = rng.choice((0.1, 2.0, 1e3 if wild else 3.0))
        case 2:
            said |= {'friction': 0.1, 'elasticity': 0.9, 'rolling_resistance': rng.random()}
            said |= {
                'one_way': rng.choice(((0.0, 1.0), (1.0, 0.0))),
                'closed_sides': rng.random() < 0.5,
            }
        case 3:
            said |= {'sensor': True, 'group': rng.randint(0, 1), 'label': 'gate'}
        case 4 if not anchored:
            said |= {'kinematic': True}
        case 5 if not anchored:
            said |= {'robot': rng.choice(ROBOTS)}
        case 6:
            said |= {'sensor': True, 'surface_velocity': (rng.number(), rng.number())}
        case 7 if not anchored:
            said |= {'actor': rng.choice(ACTORS), 'kinematic': rng.random() < 0.5}
    return requests.Spawn(
        name=rng.choice(rng.names),
        shape=rng.shape(),
        pose=(*rng.point(), rng.number()),
        frame=frame_of(rng),
        lifetime=rng.choice((0.0,) * 8 + (0.013, 0.4)),
        color=rng.choice((None, None, (0.1, 0.2, 0.3, 0.4))),
        properties=Properties(**said),
    )


def robots_of(rng: Choices) -> Iterator[requests.Request]:
    """Yield the requests for two robots in a world that is seen from above."""
    yield requests.Configure(changes={'gravity': (0.0, 0.0), 'floor_friction': 0.4})
    for name in NAMES[:2]:
        spawn = requests.Spawn(
            name=name, shape=Disc(radius=0.2), pose=(*rng.point(), rng.number())
        )
        yield replace(spawn, properties=Properties(robot=rng.choice(ROBOTS)))
        yield requests.DriveRobot(name=name, velocity=(1.0, rng.number(), rng.number()))


def change_of(rng: Choices) -> dict[str, Any]:
    return rng.choice(
        [
            {'gravity': (rng.number(), rng.number(10.0))},
            {'damping': rng.choice((0.0, 0.2, 0.9))},
            {'iterations': rng.choice((1, 3, 25))},
            {'bounds': rng.choice((None, (-4.0, 0.0, 4.0, 9.0)))},
            {'floor_friction': rng.choice((0.0, 0.4)), 'gravity': (0.0, 0.0)},
            {'seed': rng.randint(0, 9), 'drag_force': rng.choice((0.5, 100.0))},
            {'density': rng.choice((0.5, 2.0))},
            {'friction': rng.choice((0.1, 0.9)), 'elasticity': rng.choice((0.0, 0.9))},
            {'command_timeout': rng.choice((0.0, 0.01, 0.25))},
            {'max_bodies': rng.choice((3, 1000))},
        ]
    )


def command_of(rng: Choices) -> requests.Command:
    names = tuple(rng.some(rng.names, rng.choice((1, 1, 2, 4))))
    rows = {
        key: tuple((rng.number(), rng.number(), rng.number()) for _ in names)
        for key in rng.sample(('poses', 'twists', 'wrenches'), rng.randint(1, 2))
    }
    return requests.Command(names=names, frame=frame_of(rng), **rows)


def frame_of(rng: Choices) -> str:
    return rng.choice(rng.names) if rng.random() < 0.1 else ''


def drive_of(rng: Choices) -> requests.DriveRobot:
    velocity = (rng.number(), rng.number(), rng.number())
    return requests.DriveRobot(name=rng.choice(rng.names), velocity=velocity)


def join_of(rng: Choices) -> requests.Join:
    kind = rng.choice(list(JointKind))
    first, second = rng.sample(rng.names, 2)
    passed = rng.choice((0, 0, 1, 2)) if kind.schema.passes else 0
    return requests.Join(
        name=rng.choice(rng.joints),
        kind=kind,
        points=tuple(rng.point() for _ in range(kind.points + passed)),
        frame=frame_of(rng),
        a=first,
        b=rng.choice((second, 'world')),
        properties=joint_properties_of(rng, kind),
    )


def joint_properties_of(rng: Choices, kind: JointKind) -> JointProperties:
    said = {
        'lower': -rng.random(),
        'upper': rng.random(),
        'ratchet': rng.choice((-1.0, 1.0)),
        'rate': rng.number(20.0),
        'max_torque': rng.choice((0.0, 1.0, 1000.0)),
        'effort': rng.choice((1.0, 100.0)),
        'max_speed': rng.random(),
        'gain': 50.0,
        'stiffness': rng.choice((0.0, 20.0, 3000.0)),
        'damping': rng.choice((0.5, 100.0)),
        'rest_angle': rng.number(),
        'friction': rng.choice((0.0, 1.0, 100.0)),
        'rest_length': rng.random(),
        'length': 2.0 * rng.random(),
        'ratio': rng.choice((-1.0, 0.5, 3.0)),
        'phase': rng.number(),
        'carrier': rng.choice((*rng.names, 'world')),
        'max_force': rng.choice((0.0, 5.0, 500.0)),
        'break_force': 30.0,
        'collide': rng.random() < 0.5,
    }
    # A rope has a guide at each of its inner points.
    known = [name for name in kind.schema.properties if name in said]
    names = [name for name in known if rng.random() < 0.3]
    if 'rate' in names and 'effort' in names:
        # A slider has one of them.
        names.remove('effort')
    return JointProperties(**{name: said[name] for name in names})


def cut_of(rng: Choices) -> requests.Cut:
    """Return a cut; a part of it may be refused after others."""
    first, second = rng.sample(rng.names, 2)
    largest = requests.ChangeBody(name=rng.choice(rng.names), shape=rng.shape())
    return requests.Cut(
        pieces=(largest, spawn_of(rng)),
        joints=(
            requests.Rejoin(name=rng.choice(rng.joints), a=first, b=rng.choice((second, 'world'))),
        ),
        severed=(requests.Unjoin(name=rng.choice(rng.joints)),),
    )


def request_of(rng: Choices) -> requests.Request:
    """Return a request of any kind; names are few, so that requests meet."""
    properties = rng.choice(
        (
            {},
            {'density': 3.0},
            {'mass': 2.0},
            {'friction': 0.1, 'elasticity': 0.0},
            {'velocity': (1.0, 2.0)},
            {'anchored': True},
            {'anchored': False},
            {'kinematic': True},
            {'robot': rng.choice(ROBOTS)},
            {'actor': rng.choice(ACTORS)},
            {'group': rng.randint(0, 1)},
            {'sensor': rng.random() < 0.5},
            {'sensor': True, 'surface_velocity': (1.0, 0.0)},
            {'label': 'two\nlines'},
            {'forces': rng.choice(FORCES)},
        )
    )
    makers: list[tuple[int, Callable[[], requests.Request]]] = [
        (16, lambda: spawn_of(rng)),
        (12, lambda: command_of(rng)),
        (6, lambda: requests.Configure(changes=change_of(rng))),
        (8, lambda: join_of(rng)),
        (6, lambda: drive_of(rng)),
        (2, lambda: requests.Delete(name=rng.choice(rng.names))),
        (1, lambda: requests.DeleteBodies(names=tuple(rng.sample(rng.names, 2)))),
        (1, lambda: cut_of(rng)),
        (1, requests.UnjoinAll),
        (1, requests.DeleteAll),
        (1, lambda: requests.Anchor(point=(0.0, 0.0), frame=rng.choice(rng.names))),
        (2, lambda: requests.Release(point=(0.0, 0.0), frame=rng.choice(rng.names))),
        (2, lambda: requests.Pin(point=(0.0, 0.0), frame=rng.choice(rng.names))),
        (2, lambda: requests.Axle(point=(0.0, 0.0), frame=rng.choice(rng.names))),
        (2, lambda: requests.Unjoin(name=rng.choice(rng.joints))),
        (
            6,
            lambda: requests.ChangeBody(
                name=rng.choice(rng.names), properties=Properties(**properties)
            ),
        ),
        (
            2,
            lambda: requests.ChangeBody(
                name=rng.choice(rng.names),
                shape=rng.choice((None, *SHAPES)),
                color=(0.9, 0.5, 0.1, 1.0),
                pose=(*rng.point(), rng.number()),
                frame=frame_of(rng),
            ),
        ),
        (
            2,
            lambda: requests.ChangeBody(
                name=rng.choice(rng.names), unset=tuple(rng.some(list(Properties.FIELDS), 3))
            ),
        ),
        (3, lambda: requests.MoveBodies(names=(rng.choice(rng.names),), by=(rng.number(), 1.0))),
    ]
    return rng.made(makers)
