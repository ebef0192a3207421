# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A saved world that was edited by hand: motion and impulses count where nothing was changed."""

import base64
from collections.abc import Callable
import math
from pathlib import Path
from typing import Any
import zlib

from hypothesis import given, HealthCheck, settings
from hypothesis import strategies as st
import numpy as np
from physsim_ros.files.impulse_cache import pack, unpack
from physsim_ros.model.errors import BadWorldFile
from physsim_ros.model.requests import Command, Restore
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Disc
from physsim_ros.simulation.world import World
import pytest

from .world_files import edited, load, restored, rewrite, save, write
from ..building import body, DISC, ELL, pose, spawn, stack, twist


@pytest.fixture
def flying(folder: Path) -> Path:
    """Return the file of an off-centre body in flight, with a wrench on it, and another."""
    world = World()
    spawn(world, 'a/0', ELL, (1.0, 2.0, 0.3), velocity=(3.0, 4.0), spin=5.0)
    spawn(world, 'a/1', DISC, (9.0, 2.0, 0.3), velocity=(3.0, 4.0), spin=5.0)
    world.apply(Command(names=('a/0',), wrenches=((0.5, 0.0, 0.1),)))
    world.step(24)
    return save(world, folder)


def test_a_body_that_was_moved_in_the_file_is_where_the_file_says(flying: Path) -> None:
    before = restored(load(flying))

    world = edited(flying, {'at': [7.0, 8.0, 0.9]})

    assert pose(world, 'a/0') == pytest.approx((7.0, 8.0, 0.9), abs=1e-12)
    assert twist(world, 'a/0') == pytest.approx(twist(before, 'a/0'), abs=1e-12)
    assert np.array_equal(pose(world, 'a/1'), pose(before, 'a/1'))
    # The wrench goes on for as long as it had left.
    assert world.save().bodies[0].wrench_steps == 120 - 24


def test_a_velocity_that_was_changed_in_the_file_holds(flying: Path) -> None:
    before = restored(load(flying))

    world = edited(flying, {'velocity': [0.0, 0.0], 'spin': 0.0})

    assert pose(world, 'a/0') == pytest.approx(pose(before, 'a/0'), abs=1e-12)
    assert twist(world, 'a/0') == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_a_shape_or_colour_that_was_changed_in_the_file_keeps_the_motion(flying: Path) -> None:
    before = restored(load(flying))

    world = edited(flying, {'circle': {'radius': 2.0}, 'color': '#ff0000'}, 'a/1')

    assert body(world, 'a/1').shape == Disc(radius=2.0)
    assert np.array_equal(pose(world, 'a/1'), pose(before, 'a/1'))
    assert np.array_equal(twist(world, 'a/1'), twist(before, 'a/1'))


def test_another_gravity_in_the_file_keeps_the_true_velocities(flying: Path) -> None:
    before = restored(load(flying))

    world = restored(rewrite(flying, lambda content: content.update(gravity=[5.0, 0.0])))

    assert world.snapshot().twists == pytest.approx(before.snapshot().twists, abs=1e-12)
    world.step(24)
    assert twist(world, 'a/1') == pytest.approx(twist(before, 'a/1') + np.array((0.5, 0, 0)))


def test_another_physics_rate_keeps_the_true_velocities(flying: Path) -> None:
    before = restored(load(flying))

    state = load(flying, rate=1000.0)
    world = World(physics_rate=1000.0)
    world.apply(Restore(state=state))

    assert world.snapshot().twists == pytest.approx(before.snapshot().twists, abs=1e-12)
    world.step(500)
    before.step(120)
    # The free one flies exactly, at any rate.
    assert pose(world, 'a/1') == pytest.approx(pose(before, 'a/1'), abs=1e-9)


def test_a_body_that_was_anchored_in_the_file_needs_no_more_than_that(folder: Path) -> None:
    world = World()
    spawn(world, 'a/0', DISC, (1.0, 2.0, 0.3))
    path = save(world, folder)

    again = edited(path, {'anchored': True})

    assert body(again, 'a/0').anchored
    again.step(24)
    assert pose(again, 'a/0').tolist() == [1.0, 2.0, 0.3]


@pytest.fixture(scope='module')
def rested(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Return the text of a stack at rest, with what the engine remembers of its contacts."""
    world = World(settings=WorldSettings(bounds=(-8.0, 0.0, 8.0, 30.0)))
    stack(world, 5)
    world.step(960)
    return save(world, tmp_path_factory.mktemp('rested')).read_text()


@pytest.fixture
def resting(rested: str, folder: Path) -> Path:
    """Return a file of that text."""
    return write(folder, rested)


def packed(*rows: object, kind: type = np.int64) -> str:
    return pack(np.array(rows, dtype=kind))


def with_memory(**changes: Any) -> Callable[[dict[str, Any]], object]:
    return lambda content: content['memory'].update(changes)


@pytest.mark.parametrize(
    ('changes', 'field'),
    [
        ({'walls': -1}, 'walls'),
        ({'walls': 2.5}, 'walls'),
        ({'walls': True}, 'walls'),
        ({'following': 2**62}, 'following'),
        ({'following': 'many'}, 'following'),
        ({'ids': 'none of them'}, 'ids'),
        ({'ids': base64.b64encode(zlib.compress(b'five!')).decode()}, 'ids'),
        ({'pairs': packed(1, 2, 3)}, 'pairs'),
        ({'pairs': packed(1, 2)}, 'memory'),
        ({'hashes': packed(1)}, 'memory'),
        ({'impulses': packed((1.0, 2.0), kind=np.float64)}, 'memory'),
        ({'impulses': packed(*[(math.nan, 0.0)] * 10, kind=np.float64)}, 'memory'),
        ({'impulses': packed(*[(math.inf, 0.0)] * 10, kind=np.float64)}, 'memory'),
        ({'ids': [1, 2]}, 'ids'),
        ({'impulse': packed(1)}, 'impulse'),
    ],
)
def test_a_memory_that_is_none_is_refused(
    changes: dict[str, Any], field: str, resting: Path
) -> None:
    assert load(resting).memory is not None
    with pytest.raises(BadWorldFile) as refused:
        rewrite(resting, with_memory(**changes))
    assert refused.value.field == field


@pytest.mark.parametrize('key', ['ids', 'walls', 'following', 'pairs', 'hashes', 'impulses'])
def test_a_memory_without_one_of_its_keys_is_refused(key: str, resting: Path) -> None:
    with pytest.raises(BadWorldFile) as refused:
        rewrite(resting, lambda content: content['memory'].pop(key))
    assert refused.value.field == key


def moved(content: dict[str, Any]) -> None:
    content['bodies'][0]['at'] = [3.0, 3.0, 0.0]


def in_pieces(content: dict[str, Any]) -> None:
    """Make a chain of the lowest body, as wide, as high and as heavy at both ends."""
    lowest = content['bodies'][0]
    width, height = lowest.pop('box').values()
    points = [[share * width, 0.0] for share in (-0.4, -0.2, 0.0, 0.2, 0.4)]
    lowest['chain'] = {'points': points, 'thickness': height}


OF_OTHERS = [(), (1, 2), (-1, 0, 1, 2, 3), (0, 1, 2, 3, 10**9), (20, 20, 21, 22, 23)]
WITHOUT: dict[str, Callable[[dict[str, Any]], object]] = {
    **{f'ids {ids}': with_memory(ids=packed(*ids)) for ids in OF_OTHERS},
    'walls and bodies share numbers': lambda content: content['memory'].update(
        walls=int(unpack(content['memory']['ids'], 'ids', np.int64)[0])
    ),
    'deleted': lambda content: content.pop('memory'),
    'a body is gone': lambda content: content['bodies'].pop(),
    'a body was moved': moved,
    'a body is in pieces': in_pieces,
}


@pytest.mark.parametrize('change', WITHOUT.values(), ids=WITHOUT)
def test_without_a_memory_of_just_these_bodies_the_world_goes_on(
    change: Callable[[dict[str, Any]], object], resting: Path
) -> None:
    state = rewrite(resting, change)
    assert state.memory is None
    assert change is moved or all(each.motion is not None for each in state.bodies)
    restored(state).step(10)


@settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    ids=st.lists(st.integers(0, 20), min_size=5, max_size=5, unique=True),
    pairs=st.lists(
        st.tuples(st.integers(-(2**63), 2**63 - 1), st.integers(0, 30)), min_size=8, max_size=8
    ),
    impulses=st.lists(
        st.tuples(st.floats(-1e9, 1e9), st.floats(-1e9, 1e9)), min_size=8, max_size=8
    ),
    walls=st.integers(21, 36),
)
def test_whatever_is_remembered_the_world_goes_on(
    ids: list[int],
    pairs: list[tuple[int, int]],
    impulses: list[tuple[float, float]],
    walls: int,
    resting: Path,
) -> None:
    state = rewrite(
        resting,
        with_memory(
            ids=packed(*ids),
            pairs=packed(*pairs),
            hashes=packed(*range(8), kind=np.uint64),
            impulses=packed(*impulses, kind=np.float64),
            walls=walls,
            following=40,
        ),
    )
    assert state.memory is not None
    going = restored(state)
    going.step(20)
    assert np.isfinite(going.snapshot().poses).all()
