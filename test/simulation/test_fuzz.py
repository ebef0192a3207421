# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""After any requests in any order the world is sound, and a refusal changes nothing."""

from collections.abc import Callable
import math
from typing import Any

from hypothesis import assume, given, settings
from hypothesis import strategies as st
import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import Refusal
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import (
    Anchor,
    Axle,
    Command,
    Configure,
    Delete,
    DeleteAll,
    Join,
    Pin,
    Release,
    Request,
    Restore,
    Spawn,
    Unjoin,
    UnjoinAll,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon, Shape, Triangles
from physsim_ros.simulation.world import World
import pytest

FRAME = 4
MOST_BODIES = 8

# Few names, so that requests meet.
NAMES = ('a/0', 'a/1', 'b/0', 'b/1', 'b/-5')
JOINTS = st.sampled_from(('j/0', 'j/1', 'k/0'))
STRANGE = [0.0, -0.0, 1e-9, -1.0, 1e3, 1e5, -1e5, 1e7, 1e12, 1e300, 5e-324, math.inf, math.nan]

Ask = Callable[[World], Request]


class Words:
    """
    What requests are made of.

    :param names: of bodies
    :param frames: '' or names
    :param numbers: metres, radians, newtons
    :param shares: 0 .. 1
    :param lengths: of sides and radii
    :param outline: corners of a polygon
    """

    def __init__(
        self,
        names: st.SearchStrategy[str],
        frames: st.SearchStrategy[str],
        numbers: st.SearchStrategy[float],
        shares: st.SearchStrategy[float],
        lengths: st.SearchStrategy[float],
        outline: st.SearchStrategy[Any],
    ) -> None:
        self.names, self.frames = names, frames
        self.numbers, self.shares, self.lengths = numbers, shares, lengths
        self.outline = outline
        self.points = st.tuples(numbers, numbers)
        self.rows = st.tuples(numbers, numbers, numbers)


@st.composite
def stars(draw: st.DrawFn) -> tuple[tuple[float, float], ...]:
    """Corners around a centre, which may lie elsewhere: always simple, rarely convex."""
    count = draw(st.integers(3, 9))
    x, y = draw(st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0)))
    radii = [draw(st.floats(0.3, 1.5)) for _ in range(count)]
    angles = [2 * math.pi * k / count for k in range(count)]
    return tuple(
        (x + radius * math.cos(angle), y + radius * math.sin(angle))
        for radius, angle in zip(radii, angles, strict=True)
    )


SENSIBLE = Words(
    names=st.sampled_from(NAMES),
    frames=st.sampled_from(['', '', '', *NAMES]),
    numbers=st.floats(-4.0, 4.0),
    shares=st.floats(0.0, 1.0),
    lengths=st.floats(0.1, 1.5),
    outline=stars(),
)
junk = st.one_of(st.floats(-4.0, 4.0), st.sampled_from(STRANGE))
JUNK = Words(
    names=st.sampled_from([*NAMES, 'nobody/7', 'world', '']),
    frames=st.sampled_from(['', *NAMES, 'nobody/7', 'world']),
    numbers=junk,
    shares=junk,
    lengths=junk,
    outline=st.lists(st.tuples(junk, junk), max_size=6).map(tuple),
)


@st.composite
def shapes(draw: st.DrawFn, words: Words) -> Callable[[], Shape]:
    """Shapes are refused when they are made, so this is the promise of one."""
    length, other, outline = draw(words.lengths), draw(words.lengths), draw(words.outline)
    kinds: list[Callable[[], Shape]] = [
        lambda: Disc(radius=length),
        lambda: Box(width=length, height=other),
        lambda: Polygon(outline=outline),
        lambda: Chain(points=outline, thickness=length / 4),
        lambda: Triangles(vertices=outline[: len(outline) // 3 * 3]),
        lambda: Compound(element=Disc(radius=length), centers=outline),
        lambda: Compound(element=Box(width=length, height=other), centers=outline),
    ]
    return draw(st.sampled_from(kinds))


@st.composite
def spawns(draw: st.DrawFn, words: Words) -> Ask:
    make, name = draw(shapes(words)), draw(words.names)
    pose, frame = draw(words.rows), draw(words.frames)
    color = draw(st.one_of(st.none(), st.tuples(*[words.shares] * 4)))
    lifetime = draw(st.sampled_from([0.0, 0.0, 0.0, 1e-3, 0.03]))
    said = draw(
        st.fixed_dictionaries(
            {},
            optional={
                'mass': words.lengths,
                'friction': words.shares,
                'elasticity': words.shares,
                'group': st.integers(-2, 2),
                'sensor': st.booleans(),
                'label': st.sampled_from(['', 'm1']),
                **({'density': words.lengths, 'anchored': junk} if words is JUNK else {}),
            },
        )
    )
    motion = draw(st.sampled_from(['none', 'none', 'fast', 'anchored', 'kinematic', 'loose']))
    match motion:
        case 'fast':
            vx, vy = draw(words.points)
            said |= {'velocity': (30.0 * vx, 30.0 * vy), 'spin': draw(words.numbers)}
        case 'loose':
            said |= {'anchored': False, 'kinematic': False}
        case 'anchored' | 'kinematic':
            said[motion] = True
    return lambda _: Spawn(
        name=name,
        shape=make(),
        pose=pose,
        frame=frame,
        color=color,
        lifetime=lifetime,
        properties=Properties(**said),
    )


@st.composite
def commands(draw: st.DrawFn, words: Words) -> Ask:
    who = tuple(draw(st.lists(words.names, min_size=1, max_size=2, unique=True)))
    arrays = {
        key: tuple(draw(words.rows) for _ in who)
        for key in draw(st.sets(st.sampled_from(['poses', 'twists', 'wrenches'])))
    }
    frame = draw(words.frames)
    return lambda _: Command(names=who, frame=frame, **arrays)


@st.composite
def joins(draw: st.DrawFn, words: Words) -> Ask:
    kind = draw(st.sampled_from(list(JointKind)))
    points = tuple(draw(words.points) for _ in range(kind.points))
    number = st.one_of(words.numbers, words.lengths)
    said: dict[str, Any] = draw(
        st.dictionaries(st.sampled_from(list(kind.schema.properties)), number, max_size=3)
    )
    said.pop('collide', None)
    if draw(st.booleans()):
        said['collide'] = draw(st.booleans())
    if 'lower' in said and draw(st.booleans()):
        said['upper'] = said['lower']
    name, a, frame = draw(JOINTS), draw(words.names), draw(words.frames)
    b = draw(st.one_of(words.names, st.sampled_from(['world', ''])))
    return lambda _: Join(
        name=name,
        kind=kind,
        points=points,
        frame=frame,
        a=a,
        b=b,
        properties=JointProperties(**said),
    )


@st.composite
def configures(draw: st.DrawFn, words: Words) -> Ask:
    width = draw(words.lengths)
    changes = draw(
        st.fixed_dictionaries(
            {},
            optional={
                'gravity': words.points,
                'damping': words.shares,
                'iterations': st.integers(0 if words is JUNK else 1, 30),
                'bounds': st.sampled_from([None, (-9 * width, -9 * width, 9 * width, 9 * width)]),
                'density': words.lengths,
                'friction': words.shares,
                'elasticity': words.shares,
                'command_timeout': words.shares,
                'max_bodies': st.integers(3, MOST_BODIES),
                **({'speed': words.numbers} if words is JUNK else {}),
            },
        )
    )
    return lambda _: Configure(changes=changes)


def asking(words: Words) -> st.SearchStrategy[Ask]:
    """Return requests of any kind, made of these words."""
    pointing = st.tuples(words.points, words.frames)
    return st.one_of(
        spawns(words),
        spawns(words),
        spawns(words),
        commands(words),
        commands(words),
        words.names.map(lambda name: lambda _: Delete(name=name)),
        st.sampled_from(['a', 'b', 'c']).map(lambda ns: lambda _: DeleteAll(namespace=ns)),
        pointing.map(lambda at: lambda _: Anchor(point=at[0], frame=at[1])),
        pointing.map(lambda at: lambda _: Release(point=at[0], frame=at[1])),
        joins(words),
        joins(words),
        pointing.map(lambda at: lambda _: Pin(point=at[0], frame=at[1])),
        pointing.map(lambda at: lambda _: Axle(point=at[0], frame=at[1])),
        JOINTS.map(lambda name: lambda _: Unjoin(name=name)),
        st.sampled_from(['j', 'joint']).map(lambda ns: lambda _: UnjoinAll(namespace=ns)),
        configures(words),
        st.just(lambda world: Restore(state=world.save())),
    )


requests = st.one_of(asking(SENSIBLE), asking(SENSIBLE), asking(SENSIBLE), asking(JUNK))
# Few numbers, so that they coincide, and allowed ones that are as great and as small as can be.
EDGES = st.sampled_from([0.0, 0.0, 1.0, -1.0, 0.5, 2.0, 1e-3, 1e5, 1e12])
EXTREME = Words(
    names=st.sampled_from(NAMES[:3]),
    frames=st.just(''),
    numbers=EDGES,
    shares=st.floats(0.0, 1.0),
    lengths=EDGES,
    outline=stars(),
)
extremes = st.one_of(joins(EXTREME), joins(EXTREME), commands(EXTREME), spawns(EXTREME))
ASKED = (requests, extremes)


class Model:
    """Which bodies there should be: in spawn order, each with the step at which it goes."""

    def __init__(self) -> None:
        self.bodies: dict[str, int | None] = {}

    def apply(self, request: Request, step: int) -> None:
        match request:
            case Spawn(name=name, lifetime=lifetime):
                self.bodies.setdefault(name, None)
                if lifetime > 0:
                    self.bodies[name] = step + max(1, math.ceil(lifetime * 240.0 - 1e-9))
            case Delete(name=name):
                del self.bodies[name]
            case DeleteAll(namespace=None):
                self.bodies.clear()
            case DeleteAll(namespace=namespace):
                for name in [name for name in self.bodies if name.split('/')[0] == namespace]:
                    del self.bodies[name]

    def go_on(self, step: int, lost: tuple[str, ...]) -> None:
        for name, expires in list(self.bodies.items()):
            if name in lost or (expires is not None and expires <= step):
                del self.bodies[name]


def begun(*, most: int = MOST_BODIES) -> tuple[World, Model]:
    """Return a world with a few bodies, and what is known of it."""
    world = World(settings=WorldSettings(bounds=(-9.0, -9.0, 9.0, 9.0), max_bodies=most))
    world.reports_contacts = True
    model = Model()
    for number, name in enumerate(NAMES[:3]):
        request = Spawn(name=name, shape=Disc(radius=1.0), pose=(3.0 * number - 3.0, 0.0, 0.0))
        world.apply(request)
        model.apply(request, 0)
    return world, model


def assert_sound(world: World, model: Model) -> None:
    snapshot = world.snapshot()
    assert snapshot.scene.names == tuple(model.bodies)
    assert len(world) == len(model.bodies)
    assert np.isfinite(snapshot.poses).all()
    assert np.isfinite(snapshot.twists).all()
    assert np.isfinite(snapshot.kinetic_energy)
    assert np.isfinite(snapshot.forces).all()
    for row, body in enumerate(snapshot.scene.bodies):
        if body.anchored:
            assert snapshot.twists[row].tolist() == [0.0, 0.0, 0.0]
    contacts = world.contacts(snapshot)
    assert np.isfinite(contacts.impulses).all()
    assert (contacts.pairs < len(world)).all()


def carry_out(world: World, make: Callable[[World], Request]) -> Request | None:
    """Carry out a request, or assert that its refusal has changed nothing and return None."""
    before = world.digest()
    try:
        request = make(world)
        world.apply(request)
    except Refusal:
        request = None
    if request is None:
        assert world.digest() == before
    return request


@pytest.mark.slow
@settings(deadline=None, max_examples=150)
@given(sequence=st.one_of(*(st.lists(each, min_size=4, max_size=12) for each in ASKED)))
def test_any_sequence_of_requests_leaves_a_sound_world(sequence):
    world, model = begun()

    for make in sequence:
        request = carry_out(world, make)
        if request is not None:
            model.apply(request, world.step_count)
        assert_sound(world, model)
        lost = world.step(FRAME)
        model.go_on(world.step_count, lost)
        assert_sound(world, model)


@settings(deadline=None, max_examples=60)
@given(sequence=st.lists(requests, min_size=4, max_size=8))
def test_any_sequence_gives_the_same_digests_and_a_state_that_is_restored(sequence):
    worlds = [begun()[0] for _ in range(2)]
    for world in worlds:
        for make in sequence:
            carry_out(world, make)
            world.step(FRAME)
    assert worlds[0].digest() == worlds[1].digest()
    # Bodies stay when their greatest number becomes less; a state with them is beyond it.
    assume(len(worlds[0]) <= worlds[0].settings.max_bodies)

    before = worlds[0].digest()
    state = worlds[0].save()
    for world in worlds:
        world.apply(Restore(state=state))
    assert worlds[0].digest() == worlds[1].digest() == before
    for world in worlds:
        world.step(3 * FRAME)
    assert worlds[0].digest() == worlds[1].digest()
