# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Worlds written to files and loaded from them, as the tests of world files do."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from physsim_ros.files import find_world, load_world, save_world
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import BadWorldFile
from physsim_ros.model.requests import Restore
from physsim_ros.model.settings import WorldSettings
from physsim_ros.simulation.world import World
import pytest
import yaml

RATE = 240.0
COLORS = {
    'exact in hexadecimal': (1.0, 128 / 255, 0.0, 1.0),
    'see-through': (0.0, 51 / 255, 1.0, 51 / 255),
    'no hexadecimal': (0.1, 0.2, 0.3, 0.4),
}


def write(folder: Path, text: str, name: str = 'w.yaml') -> Path:
    path = folder / name
    path.write_text(text, encoding='utf-8')
    return path


def find(name: str, folder: Path, *, confined: bool = True) -> Path:
    """Return the path of a world by its name."""
    return find_world(name, world_dir=folder, confined=confined)


def load(path: Path, *, rate: float = RATE, **settings: Any) -> WorldState:
    return load_world(path, settings=WorldSettings(**settings), physics_rate=rate)


def loaded(text: str, folder: Path, **settings: Any) -> World:
    """Return a world that goes on from a file of that text."""
    return restored(load(write(folder, text), **settings))


def restored(state: WorldState) -> World:
    world = World(physics_rate=RATE)
    world.apply(Restore(state=state))
    return world


def save(world: World | WorldState, folder: Path, name: str = 'w') -> Path:
    state = world.save() if isinstance(world, World) else world
    return save_world(state, name, world_dir=folder, physics_rate=RATE)


def rewrite(path: Path, change: Callable[[dict[str, Any]], object], **load_as: Any) -> WorldState:
    """Change the content of a file, and return the state that it then has."""
    content = yaml.load(path.read_text(), yaml.CSafeLoader)
    change(content)
    path.write_text(yaml.dump(content, Dumper=yaml.CSafeDumper, sort_keys=False))
    return load(path, **load_as)


def edited(path: Path, changes: dict[str, Any], name: str = 'a/0') -> World:
    """Return a world that goes on from a file with changes of a body."""

    def change(content: dict[str, Any]) -> None:
        for entry in content['bodies']:
            if entry['name'] == name:
                entry.update(changes)

    return restored(rewrite(path, change))


def refusal_of(text: str, folder: Path, **settings: Any) -> BadWorldFile:
    with pytest.raises(BadWorldFile) as refused:
        load(write(folder, text), **settings)
    assert str(refused.value).startswith('w.yaml')
    assert len(str(refused.value)) < 1000
    return refused.value


def assert_round_trip(world: World, folder: Path) -> None:
    """Assert that a world goes on alike from its file and from itself, to the bit."""
    state = world.save()

    path = save(state, folder)
    again = load(path)

    assert again == state
    # And once more, since what is loaded may be saved.
    assert load(save(again, folder, 'again')) == state
    assert (folder / 'again.yaml').read_text() == path.read_text()
    one, other = restored(state), restored(again)
    assert one.digest() == other.digest()
    one.step(120)
    other.step(120)
    assert one.digest() == other.digest()
