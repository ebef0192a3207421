# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Maps of Tiled as JSON: objects become bodies, and tiles anchored boxes, one tile wide a metre.

An object is anchored unless a property of its own says otherwise. Custom properties with the names
of properties of bodies are those.
"""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
import math
from pathlib import Path
from typing import Any
import zlib

import numpy as np
from numpy.typing import NDArray
from physsim_ros.convert.conversion import (
    Circle,
    Conversion,
    disc_outline,
    line_shape,
    MOST_BODIES,
    moved,
)
from physsim_ros.files import PROPERTIES
from physsim_ros.maps import MOST_CELLS, rectangles_of
from physsim_ros.model.transform import Point

Content = Mapping[str, Any]

# Window bits of zlib for data with the header of gzip or of zlib (zlib.h, `inflateInit2`).
_ANY_HEADER = zlib.MAX_WBITS | 32


def convert(content: Content, _folder: Path) -> Conversion:
    """Return the world of a map of Tiled."""
    if content.get('orientation', 'orthogonal') != 'orthogonal':
        raise ValueError(f'orientation {content["orientation"]}')
    conversion = Conversion()
    _add_layers(conversion, content, content['layers'], (0.0, 0.0))
    return conversion


def _add_layers(
    conversion: Conversion, tiled: Content, layers: Sequence[Content], offset: Point
) -> None:
    for layer in layers:
        place = offset[0] + layer.get('offsetx', 0.0), offset[1] + layer.get('offsety', 0.0)
        if not layer.get('visible', True):
            conversion.leave_out('left out: a hidden layer')
        elif layer['type'] == 'group':
            _add_layers(conversion, tiled, layer['layers'], place)
        elif layer['type'] == 'objectgroup':
            for each in layer['objects']:
                _add_object(conversion, tiled, each, place)
        elif layer['type'] == 'tilelayer':
            _add_tiles(conversion, tiled, layer, place)
        else:
            conversion.leave_out(f'left out: a layer of type {layer["type"]}')


def _add_object(conversion: Conversion, tiled: Content, each: Content, offset: Point) -> None:
    scale = 1.0 / tiled['tilewidth']
    if each.get('point') or 'text' in each:
        conversion.leave_out(f'left out: a {"text" if "text" in each else "point"}')
        return
    width, height = (float(each.get(key, 0.0)) * scale for key in ('width', 'height'))
    # Tiled has y down, the origin of an object at its upper left corner, of a tile at its lower.
    corner = (each['x'] + offset[0]) * scale, _up(tiled, each['y'] + offset[1])
    pose = *corner, -math.radians(each.get('rotation', 0.0))
    shape: dict[str, object]
    center = 0.0, 0.0
    if points := each.get('polygon') or each.get('polyline'):
        places = [(point['x'] * scale, -point['y'] * scale) for point in points]
        shape = line_shape(places) if 'polyline' in each else {'polygon': [*map(list, places)]}
    else:
        center = width / 2, height / 2 if 'gid' in each else -height / 2
        if not each.get('ellipse'):
            shape = {'box': {'width': width, 'height': height}}
        elif math.isclose(width, height, rel_tol=0.01):
            shape = {'circle': {'radius': width / 2}}
        else:
            outline = disc_outline(Circle(width / 2), flat=height / width)
            shape = {'polygon': [list(point) for point in outline.points]}
    properties: dict[str, object] = {}
    for own in each.get('properties') or ():
        if own['name'] in PROPERTIES:
            properties[own['name']] = own['value']
        else:
            conversion.leave_out(f'left out: property {own["name"]}')
    if not properties.keys() & {'anchored', 'kinematic', 'mass', 'density', 'velocity', 'spin'}:
        properties['anchored'] = True
    name = each.get('name') or each.get('class') or each.get('type') or 'object'
    conversion.add_body(str(name), shape, (*moved(pose, center), pose[2]), **properties)


def _add_tiles(conversion: Conversion, tiled: Content, layer: Content, offset: Point) -> None:
    for chunk in layer.get('chunks') or [layer]:
        tiles = _tiles_of(chunk, layer)
        across, down = tiled['tilewidth'], tiled['tileheight']
        x, y = (chunk.get(key, 0) for key in ('x', 'y'))
        for top, left, bottom, right in rectangles_of(tiles != 0, MOST_BODIES).tolist():
            size = float(right - left), (bottom - top) * down / across
            middle = (
                (left + right) / 2 + x + offset[0] / across,
                _up(tiled, ((top + bottom) / 2 + y) * down + offset[1]),
            )
            box = {'box': {'width': size[0], 'height': size[1]}}
            conversion.add_body(str(layer['name']), box, (*middle, 0.0), anchored=True)


def _tiles_of(chunk: Content, layer: Content) -> NDArray[np.uint32]:
    """Return the numbers of the tiles of a chunk, (rows, columns) uint32; 0 is none."""
    data, size = chunk['data'], (chunk['height'], chunk['width'])
    if math.prod(size) > MOST_CELLS:
        raise ValueError(f'a layer of more than {MOST_CELLS:,} tiles')
    if not isinstance(data, str):
        return np.array(data, np.uint32).reshape(size)
    packed = base64.b64decode(data)
    match layer.get('compression', ''):
        case '':
            tiles = packed
        case 'zlib' | 'gzip':
            # A small file may unfold to gigabytes; a byte too many is an error of numpy's.
            most = 4 * math.prod(size) + 1
            tiles = zlib.decompressobj(_ANY_HEADER).decompress(packed, most)
        case other:
            raise ValueError(f'compression {other}')
    return np.frombuffer(tiles, '<u4').reshape(size)


def _up(tiled: Content, y: float) -> float:
    """Return the height above the lower edge of the map [m] of a y downward [pixels]."""
    return float(tiled['height'] * tiled['tileheight'] - y) / float(tiled['tilewidth'])
