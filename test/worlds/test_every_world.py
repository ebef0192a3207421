# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every world that comes with the package loads, is saved, and is shown."""

from math import inf
from pathlib import Path

from physsim_ros.files import load_world, save_world, shipped_worlds
from physsim_ros.model.requests import Restore
from physsim_ros.model.settings import WorldSettings
from physsim_ros.simulation.world import World
import pytest

from .film import RATE, simulation, state_of
from ..building import check_begins_alike

ROOT = Path(__file__).resolve().parents[2]
FAMOUS = (
    'newtons_cradle', 'pendulums', 'incline', 'dominoes', 'bridge', 'car', 'gear_train',
    'catapult', 'galton',
)  # fmt: skip
WORLDS = sorted(path.stem for path in shipped_worlds().glob('*.yaml'))


def world_of(state):
    world = World(physics_rate=RATE)
    world.apply(Restore(state=state))
    return world


def test_the_famous_ones_are_there():
    assert set(FAMOUS) <= set(WORLDS)


@pytest.mark.parametrize('name', WORLDS)
def test_it_is_saved_and_loaded_to_the_bit(name, tmp_path):
    world = world_of(state_of(name))
    world.step(30)
    state = world.save()

    path = save_world(state, 'saved', world_dir=tmp_path, physics_rate=RATE)
    again = load_world(path, settings=WorldSettings(), physics_rate=RATE)

    assert again == state
    one, other = world_of(state), world_of(again)
    one.step(30)
    other.step(30)
    assert one.digest() == other.digest()


@pytest.mark.parametrize('name', WORLDS)
def test_it_begins_alike_at_any_step_whether_it_was_built_ahead_or_is_built_then(name):
    saved = simulation(name)
    saved.run(0.1)
    check_begins_alike(saved.save(), RATE)


@pytest.mark.parametrize('name', WORLDS)
def test_it_begins_inside_its_bounds_if_it_has_any(name):
    snapshot = simulation(name).world.snapshot()
    left, bottom, right, top = snapshot.scene.settings.bounds or (-inf, -inf, inf, inf)

    x, y = snapshot.poses[:, :2].T
    assert ((left <= x) & (x <= right) & (bottom <= y) & (y <= top)).all()


@pytest.mark.parametrize('name', FAMOUS)
def test_the_page_of_worlds_shows_it(name):
    page = (ROOT / 'docs' / 'worlds.md').read_text(encoding='utf-8')

    assert f'config/worlds/{name}.yaml' in page
    assert f'(worlds/{name}.png)' in page
    assert (ROOT / 'docs' / 'worlds' / f'{name}.png').stat().st_size < 100_000
