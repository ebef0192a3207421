# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Short words for the tests of the core: a world, what is spawned into it, where it is then."""

from collections.abc import Callable, Sequence
from itertools import pairwise
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.colors import Color
from physsim_ros.model.errors import Refusal
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Command, Configure, Join, Restore, Spawn
from physsim_ros.model.scene import Body
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon, Shape, Triangles
from physsim_ros.model.transform import Point, Pose
from physsim_ros.simulation.world import beginning_of, World
import pytest

G = 9.81
DT = 1.0 / 240.0
# Between knots of a net [m].
MESH = 0.3
# A pose goes to the centre of mass and back: a few last bits of metres.
ROUNDING = 1e-12
# Rounding error of the 240 sums of a second in float64 [m, m/s].
ROUNDING_OF_SUMS = 1e-10
RED, BLUE = (1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 0.5)
NOWHERE = WorldSettings(gravity=(0.0, 0.0), friction=0.0, elasticity=1.0)

DISC = Disc(radius=0.5)
BOX = Box(width=1.0, height=1.0)
# Off-centre and concave: the centroid lies at (5/6, 5/6).
ELL = Polygon(outline=((0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)))
# Off-centre: the centroid lies at (1, 2/3).
TRIANGLE = Polygon(outline=((0.0, 0.0), (3.0, 0.0), (0.0, 2.0)))
SHAPES: dict[str, Shape] = {
    'disc': DISC,
    'box': Box(width=1.0, height=0.5),
    'triangle': TRIANGLE,
    'ell': ELL,
    'chain': Chain(points=((-1.0, 0.0), (0.0, 0.2), (1.0, 0.0)), thickness=0.1),
    'triangles': Triangles(
        vertices=((0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
    ),
    'discs': Compound(element=Disc(radius=0.25), centers=((-0.3, 0.0), (0.3, 0.0), (0.0, 0.4))),
    'boxes': Compound(element=Box(width=0.4, height=0.2), centers=((0.0, 0.0), (1.0, 0.0))),
}
# A point that lies in each of them, and not on its edge.
INSIDE = {
    'disc': (0.1, 0.2),
    'box': (0.4, 0.2),
    'triangle': (0.5, 0.5),
    'ell': (0.5, 1.5),
    'chain': (0.5, 0.1),
    'triangles': (0.8, 0.8),
    'discs': (-0.3, 0.1),
    'boxes': (1.0, 0.05),
}

# A red box of 1 m, as scenes describe bodies.
PLAIN_BODY = Body(
    name='box/0',
    shape=BOX,
    color=(1.0, 0.0, 0.0, 1.0),
    mass=None,
    density=1.0,
    friction=0.5,
    elasticity=0.5,
    anchored=False,
    kinematic=False,
    group=0,
    sensor=False,
    expires=None,
)


def refusal(make: Callable[..., object], *given: Any, **said: Any) -> tuple[type[Refusal], str]:
    """Return the class of the refusal of a call, and the field that it names."""
    with pytest.raises(Refusal) as caught:
        make(*given, **said)
    return type(caught.value), caught.value.field


def spawning(
    name: str,
    shape: Shape = DISC,
    pose: Pose = (0.0, 0.0, 0.0),
    *,
    frame: str = '',
    color: Color | None = None,
    lifetime: float = 0.0,
    **said: Any,
) -> Spawn:
    """Return the request of a body; keywords are its properties."""
    return Spawn(
        name=name,
        shape=shape,
        pose=pose,
        frame=frame,
        color=color,
        lifetime=lifetime,
        properties=Properties(**said),
    )


def spawn(world: World, name: str, *arguments: Any, **options: Any) -> None:
    """Spawn a body."""
    world.apply(spawning(name, *arguments, **options))


def joining(
    kind: JointKind | str, points: Sequence[Point], name: str = 'joint/0', **said: Any
) -> Join:
    """Return the request of a joint; keywords are its bodies, a frame, and its properties."""
    where = {key: said.pop(key) for key in ('a', 'b', 'frame') if key in said}
    kind, properties = JointKind(kind), JointProperties(**said)
    return Join(name=name, kind=kind, points=tuple(points), properties=properties, **where)


def join(world: World, *arguments: Any, **options: Any) -> None:
    """Join bodies."""
    world.apply(joining(*arguments, **options))


def command(world: World, name: str, **rows: tuple[float, float, float]) -> None:
    """Command one body: `pose`, `twist` or `wrench`."""
    arrays = {'pose': 'poses', 'twist': 'twists', 'wrench': 'wrenches'}
    world.apply(Command(names=(name,), **{arrays[key]: (row,) for key, row in rows.items()}))


def unlimit_wrenches(world: World) -> None:
    """Let wrenches act until the next command."""
    world.apply(Configure(changes={'command_timeout': 0.0}))


def body(world: World, name: str) -> Body:
    """Return the description of a body."""
    scene = world.snapshot().scene
    return scene.bodies[scene.names.index(name)]


def names(world: World) -> tuple[str, ...]:
    """Return the names of all bodies, in spawn order."""
    return world.snapshot().scene.names


def body_at(world: World, point: Point) -> str | None:
    """Return the topmost body that covers a point of the world [m]."""
    bodies = world.space.bodies
    return next(iter(bodies.at(point)), None)


def pose(world: World, name: str) -> NDArray[np.float64]:
    """Return x, y [m] and yaw [rad] of a body."""
    snapshot = world.snapshot()
    return snapshot.poses[snapshot.scene.names.index(name)]


def twist(world: World, name: str) -> NDArray[np.float64]:
    """Return vx, vy [m/s] and spin [rad/s] of a body."""
    snapshot = world.snapshot()
    return snapshot.twists[snapshot.scene.names.index(name)]


def stack(world: World, count: int) -> None:
    """Stack boxes of 1 m on the floor of the world's bounds."""
    for number in range(count):
        spawn(world, f'stack/{number}', BOX, (0.0, 0.5 + number, 0.0))


def swing(*, link: float, ball: float, radius: float) -> World:
    """Return a ball on 20 links of 0.15 m, of a mass each [kg], let go at 45 degrees."""
    world, count, length, lean = World(), 20, 0.15, math.radians(45.0)
    way = np.array((math.sin(lean), -math.cos(lean)))
    shape = Box(width=length, height=0.03)
    for number in range(count):
        middle = way * length * (number + 0.5)
        spawn(world, f'link/{number}', shape, (*middle, lean - math.pi / 2), mass=link)
    spawn(world, 'ball/0', Disc(radius=radius), (*(way * length * count), 0.0), mass=ball)
    names = ['world', *(f'link/{number}' for number in range(count)), 'ball/0']
    for number, (b, a) in enumerate(pairwise(names)):
        join(world, 'axle', [tuple(way * length * number)], f'joint/{number}', a=a, b=b)
    return world


def net(side: int) -> World:
    """Return a square net of rods that hangs from two corners."""
    world = World()
    knots = np.arange(side * side).reshape(side, side)
    for knot, (row, column) in enumerate(np.ndindex(side, side)):
        pose = (MESH * column, -MESH * row, 0.0)
        spawn(world, f'knot/{knot}', Disc(radius=0.1), pose, group=1)
    down, along = (knots[:-1], knots[1:]), (knots[:, :-1], knots[:, 1:])
    pairs = [pair for ends in (down, along) for pair in zip(*map(np.ravel, ends), strict=True)]
    for number, (a, b) in enumerate(pairs):
        points = tuple((MESH * (knot % side), -MESH * (knot // side)) for knot in (a, b))
        join(world, 'rod', points, f'rod/{number}', a=f'knot/{a}', b=f'knot/{b}')
    for knot in (0, side - 1):
        join(world, 'axle', [(MESH * knot, 0.0)], f'nail/{knot}', a=f'knot/{knot}', b='world')
    return world


def sleepers(world: World) -> list[str]:
    """Return the names of the bodies that sleep in the engine."""
    bodies = world.space.bodies.by_name
    return [name for name, rigid in bodies.items() if rigid.pm_body.is_sleeping]


def check_begins_alike(state: WorldState, physics_rate: float) -> None:
    """Compare a world that begins with a state at any step and one that was built ahead."""
    now, ahead = World(physics_rate=physics_rate), World(physics_rate=physics_rate)
    ahead.keep_built(beginning_of(state, physics_rate))
    for world in (now, ahead):
        world.step(7)
        world.apply(Restore(state=state))

    assert repr(now.renew()) == repr(ahead.renew())
    for _ in range(12):
        for world in (now, ahead):
            world.step(10)
        assert now.digest() == ahead.digest()
