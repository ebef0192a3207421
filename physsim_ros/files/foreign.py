# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Kinds of files that are no world files, told from their content."""

from __future__ import annotations

from collections.abc import Mapping
import re
from typing import Any

from physsim_ros.model.translation import Text

# Keys of the files of map_server, of flatland, ir-sim, Tiled and R.U.B.E.: all of a row are there.
_KEYS = {
    'map': ('image', 'resolution', 'origin'),
    'flatland': ('layers', 'models'),
    'ir-sim': ('world', 'robot'),
    'Tiled': ('tilewidth', 'tileheight', 'layers'),
    'R.U.B.E.': ('gravity', 'body'),
    'drawing': ('strokes',),
}
# Names of elements at the root of XML.
_ROOTS = {
    'sdf': 'SDF, of Gazebo',
    'robot': 'URDF',
    'mujoco': 'MJCF, of MuJoCo',
    'map': 'XML of Tiled; export the map as JSON',
    'svg': 'SVG',
}
# The first element of XML, behind declarations and comments. Nothing is tried twice, so that no
# text takes more than linear time.
_ROOT = re.compile(r'\s*+(?:<[?!][^>]*+>\s*+)*+<([A-Za-z][\w:-]*)')
CONVERTED = ('flatland', 'ir-sim', 'Tiled', 'R.U.B.E.')


def kind_of(content: Mapping[Any, Any]) -> str:
    """Return the kind of file whose keys a mapping has; '' for any other."""
    if 'format' in content:
        return ''
    if isinstance(content.get('world'), Mapping) and 'obstacle' in content:
        return 'ir-sim'
    kinds = (kind for kind, keys in _KEYS.items() if all(key in content for key in keys))
    return next(kinds, '')


def advice_on(content: Mapping[Any, Any]) -> Text | None:
    """Return the kind of a mapping that is no world, with advice on its use; None if unknown."""
    kind = kind_of(content)
    if kind in CONVERTED:
        template = (
            'this is a world of {kind}: python -m physsim_ros.convert makes a world file of it'
        )
        return Text(template, kind=kind)
    if kind == 'map':
        return Text('this is a map: name it as `map:` in a world file')
    return Text('this is a drawing: examples/draw.py draws it') if kind == 'drawing' else None


def advice_on_xml(text: str) -> Text | None:
    """Return the kind of a text that is XML, as a message; None where it is not."""
    found = _ROOT.match(text[:10_000])
    if found is None:
        return None
    return Text('this is {kind}, and a world file is YAML', kind=_ROOTS.get(found[1], 'XML'))
