# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0


"""The worlds that a page offers: those that ship with the package, and the user's own."""

from __future__ import annotations

from itertools import islice
from pathlib import Path
from typing import Any

from physsim_ros.files import shipped_pictures, shipped_worlds, title_of, worlds_in

# Worlds of the user that are listed.
MOST_WORLDS = 500


def gallery_content(world_dir: Path) -> dict[str, Any]:
    """
    Return the message of all worlds.

    :param world_dir: directory of the user's worlds
    """
    shipped = [_entry(path, shipped=True) for path in worlds_in(shipped_worlds()).values()]
    files = islice(worlds_in(world_dir).values(), MOST_WORLDS)
    own = [_entry(path, shipped=False) for path in files]
    # A world of the user comes before the shipped one of its name.
    worlds = {entry['name']: entry for entry in shipped + own}
    return {'type': 'worlds', 'worlds': list(worlds.values())}


def _entry(path: Path, *, shipped: bool) -> dict[str, Any]:
    name = path.stem
    picture = shipped and (shipped_pictures() / f'{name}.png').is_file()
    return {
        'name': name,
        # A comment of the user's is nobody else's business.
        'title': title_of(path) if shipped else name,
        'picture': f'/gallery/{name}.png' if picture else '',
        'shipped': shipped,
    }
