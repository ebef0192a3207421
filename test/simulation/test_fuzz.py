# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
After any requests in any order the world is sound, and a refusal changes nothing.

HISTORIES says how many sequences of requests are played, 60 where it does not.
"""

from collections.abc import Callable
import math
import os

import numpy as np
from physsim_ros.model import requests
from physsim_ros.model.errors import Refusal
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon, Shape, Triangles
from physsim_ros.simulation.world import World
import pytest

from .random_history import Choices, JOINTS, request_of

SEEDS = range(int(os.environ.get('HISTORIES', '60')))
FRAME = 4
# Few names, so that requests meet.
NAMES = ('a/0', 'a/1', 'b/0', 'b/1', 'b/-5')
NOBODY = ('nobody/7', 'world', '')
STRANGE = (0.0, -0.0, 1e-9, -1.0, 1e3, 1e5, -1e5, 1e7, 1e12, 1e300, 5e-324, math.inf, math.nan)
# Few numbers, so that they coincide, and allowed ones that are as great and as small as can be.
EDGES = (0.0, 0.0, 1.0, -1.0, 0.5, 2.0, 1e-3, 1e5, 1e12)
AT_POINTS = (requests.Anchor, requests.Release, requests.Pin, requests.Axle)

Ask = Callable[[World], requests.Request]


class Wild(Choices):
    """
    Choices of which some cannot be: of odd seeds by strange numbers and names, else by edges.

    :ivar strange: numbers of which half of the numbers of this request are
    """

    def __init__(self, seed: int) -> None:
        super().__init__(seed)
        self.edges_alone = seed % 2 == 0
        self.strange: tuple[float, ...] = ()

    def begin_request(self, world: World) -> None:
        """Choose whether the next request has strange numbers and names."""
        junk = not self.edges_alone and self.random() < 0.25
        self.strange = EDGES if self.edges_alone else STRANGE if junk else ()
        # Mostly those that there are.
        self.names = (*(3 * world.scene.names), *NAMES, *(NOBODY if junk else ()))
        self.joints = (*[joint.name for joint in world.scene.joints], *JOINTS)

    def number(self, most: float = 3.0) -> float:
        strange = self.strange and self.random() < 0.5
        return self.choice(self.strange) if strange else self.uniform(-most, most)

    def length(self) -> float:
        """Choose a side or a radius [m]."""
        edge = self.strange and self.random() < 0.5
        return self.number() if edge else self.uniform(0.1, 1.5)

    def outline(self) -> tuple[tuple[float, float], ...]:
        """Choose corners, mostly around a centre: simple, and rarely convex."""
        if self.strange and self.random() < 0.5:
            return tuple(self.point() for _ in range(self.randint(0, 6)))
        x, y, count = self.uniform(-2.0, 2.0), self.uniform(-2.0, 2.0), self.randint(3, 9)
        angles = [math.tau * number / count for number in range(count)]
        radii = [self.uniform(0.3, 1.5) for _ in angles]
        return tuple(
            (x + radius * math.cos(angle), y + radius * math.sin(angle))
            for radius, angle in zip(radii, angles, strict=True)
        )

    def shape(self) -> Shape:
        """Make a shape of any kind and size, which may be refused."""
        length, other, outline = self.length(), self.length(), self.outline()
        match self.randrange(6):
            case 0:
                return Disc(radius=length)
            case 1:
                return Box(width=length, height=other)
            case 2:
                return Polygon(outline=outline)
            case 3:
                return Chain(points=outline, thickness=length / 4)
            case 4:
                return Triangles(vertices=outline[: len(outline) // 3 * 3])
        element = Disc(radius=length) if self.random() < 0.5 else Box(width=length, height=other)
        return Compound(element=element, centers=outline)

    def ask(self, world: World) -> requests.Request:
        """
        Return a request of any kind.

        :raises Refusal: it cannot be
        """
        self.begin_request(world)
        at = {'point': self.point(), 'frame': self.choice(('', *self.names))}
        makers = [
            (60, lambda: request_of(self)),
            (2, lambda: requests.DeleteAll(namespace=self.choice('abc'))),
            (2, lambda: requests.UnjoinAll(namespace=self.choice(('j', 'joint')))),
            (2, lambda: requests.Restore(state=world.save())),
            (1, lambda: requests.Configure(changes={'speed': self.number()})),
            *((1, lambda kind=kind: kind(**at)) for kind in AT_POINTS),
        ]
        return self.made(makers)


class Model:
    """Which bodies there should be: in spawn order, each with the step at which it goes."""

    def __init__(self) -> None:
        self.bodies: dict[str, int | None] = {}

    def apply(self, request: requests.Request, step: int) -> None:
        gone: tuple[str, ...] = ()
        match request:
            case requests.Spawn(name=name, lifetime=lifetime):
                self.bodies.setdefault(name, None)
                if lifetime > 0:
                    self.bodies[name] = step + max(1, math.ceil(lifetime * 240.0 - 1e-9))
            case requests.Delete(name=name):
                gone = (name,)
            case requests.DeleteBodies(names=names):
                gone = names
            case requests.DeleteAll(namespace=None):
                gone = tuple(self.bodies)
            case requests.DeleteAll(namespace=space):
                gone = tuple(name for name in self.bodies if name.split('/')[0] == space)
        for name in gone:
            del self.bodies[name]

    def go_on(self, step: int, lost: tuple[str, ...]) -> None:
        for name, expires in list(self.bodies.items()):
            if name in lost or (expires is not None and expires <= step):
                del self.bodies[name]


def begun() -> tuple[World, Model]:
    """Return a world with a few bodies, and what is known of it."""
    world, model = World(settings=WorldSettings(bounds=(-9.0, -9.0, 9.0, 9.0))), Model()
    world.reports_contacts = True
    for number, name in enumerate(NAMES[:3]):
        pose = (3.0 * number - 3.0, 0.0, 0.0)
        request = requests.Spawn(name=name, shape=Disc(radius=1.0), pose=pose)
        world.apply(request)
        model.apply(request, 0)
    return world, model


def assert_sound(world: World, model: Model) -> None:
    snapshot = world.snapshot()
    contacts = world.contacts(snapshot)
    assert snapshot.scene.names == tuple(model.bodies)
    assert len(world) == len(model.bodies)
    for numbers in (snapshot.poses, snapshot.twists, snapshot.forces, contacts.impulses):
        assert np.isfinite(numbers).all()
    assert np.isfinite(snapshot.kinetic_energy)
    anchored = [body.anchored for body in snapshot.scene.bodies]
    assert not snapshot.twists[anchored].any()
    assert (contacts.pairs < len(world)).all()


def carry_out(world: World, ask: Ask) -> requests.Request | None:
    """Carry out a request, or assert that its refusal has changed nothing and return None."""
    before = world.digest()
    try:
        request = ask(world)
        if isinstance(request, requests.Cut):
            # A cut may be refused when it is half done; `histories` has the world rebuilt then.
            return None
        world.apply(request)
    except Refusal:
        assert world.digest() == before
        return None
    return request


@pytest.mark.parametrize('seed', SEEDS)
def test_any_sequence_of_requests_leaves_a_sound_world(seed):
    (world, model), wild = begun(), Wild(seed)
    for _ in range(wild.randint(8, 20)):
        request = carry_out(world, wild.ask)
        if request is not None:
            model.apply(request, world.step_count)
        assert_sound(world, model)
        lost = world.step(FRAME)
        model.go_on(world.step_count, lost)
        assert_sound(world, model)


@pytest.mark.parametrize('seed', SEEDS)
def test_any_sequence_gives_the_same_digests_and_a_state_that_is_restored(seed):
    worlds = [begun()[0] for _ in range(2)]
    for world in worlds:
        wild = Wild(seed)
        for _ in range(wild.randint(6, 12)):
            carry_out(world, wild.ask)
            world.step(FRAME)
    assert worlds[0].digest() == worlds[1].digest()
    if len(worlds[0]) > worlds[0].settings.max_bodies:
        # Bodies stay when their greatest number becomes less; a state with them is beyond it.
        return

    state = worlds[0].save()
    for world in worlds:
        world.apply(requests.Restore(state=state))
        assert world.save() == state
    assert worlds[0].digest() == worlds[1].digest()
    for world in worlds:
        world.step(3 * FRAME)
    assert worlds[0].digest() == worlds[1].digest()
