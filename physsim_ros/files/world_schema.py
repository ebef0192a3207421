# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The schema of world files: their keys, and what the entries of bodies and joints have in common.

A refusal within an entry names the body or joint, and its line.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from physsim_ros.files.yaml12 import Located
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checks import AT_WORDS, shown
from physsim_ros.model.colors import COLOR_WORDS
from physsim_ros.model.errors import BadProperty, BadWorldFile, Refusal
from physsim_ros.model.settings import LIMIT, WorldSettings
from physsim_ros.model.shapes import SHAPE_WORDS
from physsim_ros.model.texts import Words
from physsim_ros.model.transform import Point
from physsim_ros.model.translation import Text

FORMAT = 1
# Limits protect the node: files do not change them.
LIMITS = [name for name, each in WorldSettings.FIELDS.items() if LIMIT in each.notes]
SETTINGS = [name for name in WorldSettings.FIELDS if name not in LIMITS]
PROPERTIES = [*Properties.FIELDS]
# Keys of a world and of a body, with everyday words for them.
WORLD_KEYS = {
    **dict.fromkeys(('format', 'lesson', 'map', 'bodies', 'joints', 'memory'), Words()),
    **{name: WorldSettings.WORDS[name] for name in SETTINGS},
}
BODY_KEYS = {
    'name': Words(),
    **SHAPE_WORDS,
    'at': AT_WORDS,
    'color': COLOR_WORDS,
    'lifetime': Words(),
    **Properties.WORDS,
    **dict.fromkeys(('motion', 'field_lead', 'wrench', 'driven', 'acting'), Words()),
}
# Keys of a joint that the text of a marker does not have.
OWN_JOINT_KEYS = ['name', 'points', 'seat', 'command', 'coming']
# Greatest number of commands on their way to a drive or a motor: one for each step of the longest
# latency.
MOST_COMING = 100_000
# Tolerance between a saved number and the same number recomputed [m, rad, relative]: more than
# rounding means that somebody has edited the file.
ROUNDING = 1e-9


def entries_of(value: object, name: str) -> list[dict[Any, Any]]:
    """
    Return a list of mappings; None is an empty one.

    :param name: of the field, for the refusal
    :raises BadProperty: it is no list of mappings
    """
    if value is None:
        return []
    if not isinstance(value, list) or not all(isinstance(each, dict) for each in value):
        raise BadProperty('{field} must be a list of mappings', field=name)
    return value


@contextmanager
def naming(entry: Mapping[Any, Any], noun: str = 'body', count: int = 0) -> Iterator[None]:
    """
    Add the name and the line of a body or joint to a refusal.

    :param entry: of it in the file
    :param count: of it in the file, from 1, for entries without a name
    :raises BadWorldFile: a refusal was raised within
    """
    try:
        yield
    except Refusal as refusal:
        name = entry.get('name')
        which = f'number {count}' if name is None else shown(name)
        raise BadWorldFile(
            '{kind} {name}: {wrong}',
            field=refusal.field,
            kind=Text(noun),
            name=which,
            # Not in English, whose messages name the key.
            key=refusal.field and f', {refusal.field}',
            wrong=refusal.text,
            line=entry.line if isinstance(entry, Located) else None,
            cause=refusal.code,
        ) from refusal


def is_same(
    saved: Sequence[float] | Sequence[Point], written: Sequence[float] | Sequence[Point]
) -> bool:
    """Return whether numbers differ by no more than rounding."""
    return bool(np.allclose(saved, written, rtol=ROUNDING, atol=ROUNDING))
