# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0


"""The worlds that a page offers: those that ship with the package, and the user's own."""

from __future__ import annotations

from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import Any
from urllib.parse import quote

from physsim_ros.files import OwnWorlds, shipped_pictures, shipped_worlds, title_of, worlds_in
from physsim_ros.model.errors import Refusal

# Worlds of the user that are listed.
MOST_WORLDS = 500
# The shipped worlds, the simplest to understand first; others come last.
BY_DIFFICULTY = (
    'demo',
    'dominoes',
    'pendulums',
    'incline',
    'newtons_cradle',
    'galton',
    'car',
    'catapult',
    'gear_train',
    'bridge',
)


def gallery_content(world_dir: Path, own_worlds: OwnWorlds) -> dict[str, Any]:
    """
    Return the message of all worlds.

    :param world_dir: directory of the user's worlds
    :param own_worlds: in it
    """
    known = worlds_in(shipped_worlds())
    names = sorted(known, key=lambda name: (*BY_DIFFICULTY, name).index(name))
    shipped = [_shipped(known[name]) for name in names]
    files = islice(worlds_in(world_dir).values(), MOST_WORLDS)
    own = [_own(path, own_worlds) for path in files]
    # A world of the user comes before the shipped one of its name.
    worlds = {entry['name']: entry for entry in shipped + own}
    return {'type': 'worlds', 'worlds': list(worlds.values())}


def _shipped(path: Path) -> dict[str, Any]:
    picture = (shipped_pictures() / f'{path.stem}.png').is_file()
    return {
        'name': path.stem,
        'title': title_of(path),
        'picture': f'/gallery/{path.stem}.png' if picture else '',
        'shipped': True,
    }


def _own(path: Path, own_worlds: OwnWorlds) -> dict[str, Any]:
    # A comment of the user's is nobody else's business.
    name, picture = path.stem, ''
    # A name that a script chose may be none that a page gives.
    with suppress(Refusal, OSError):
        changed = own_worlds.picture(name).stat().st_mtime_ns
        picture = f'/picture/{quote(name)}?{changed}'
    return {'name': name, 'title': name, 'picture': picture, 'shipped': False}
