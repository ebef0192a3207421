# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Maps of Tiled as JSON: objects become bodies, and tiles anchored boxes, one tile wide a metre.

An object is anchored unless a property of its own says otherwise. Custom properties with the names
of properties of bodies are those.
"""

from __future__ import annotations

import base64
from collections.abc import Sequence
import math
from pathlib import Path
import zlib

import numpy as np
from numpy.typing import NDArray
from physsim_ros.convert.content import BadContent, Content
from physsim_ros.convert.conversion import Conversion, disc_outline, line_shape, MOST_BODIES
from physsim_ros.files import PROPERTIES
from physsim_ros.maps import MOST_CELLS, rectangles_of
from physsim_ros.model.transform import local_to_world, Point

# Keys of a map, a layer, an object and a property that only the editor needs.
_OF_THE_EDITOR = (
    *('version', 'tiledversion', 'type', 'propertytype', 'id', 'nextlayerid', 'nextobjectid'),
    *('renderorder', 'draworder', 'compressionlevel', 'infinite', 'encoding', 'opacity'),
    *('x', 'y', 'width', 'height', 'startx', 'starty', 'visible', 'name'),
)
# Window bits of zlib for data with the header of gzip or of zlib (zlib.h, `inflateInit2`).
_ANY_HEADER = zlib.MAX_WBITS | 32


def convert(content: Content, _folder: Path) -> Conversion:
    """Return the world of a map of Tiled."""
    if (orientation := content.text('orientation', 'orthogonal')) != 'orthogonal':
        raise BadContent(f'orientation {orientation} has no like here')
    conversion = Conversion()
    content.skip(*_OF_THE_EDITOR)
    _add_layers(conversion, content, content.entries('layers'), (0.0, 0.0))
    return conversion


def _add_layers(
    conversion: Conversion, tiled: Content, layers: Sequence[Content], offset: Point
) -> None:
    for layer in layers:
        x, y = layer.number('offsetx', 0.0), layer.number('offsety', 0.0)
        place = offset[0] + x, offset[1] + y
        if 'visible' in layer and not layer.is_set('visible'):
            conversion.leave_out(layer, 'a hidden layer')
            continue
        layer.skip(*_OF_THE_EDITOR)
        match layer.text('type'):
            case 'group':
                _add_layers(conversion, tiled, layer.entries('layers'), place)
            case 'objectgroup':
                for each in layer.entries('objects'):
                    _add_object(conversion, tiled, each, place)
            case 'tilelayer':
                _add_tiles(conversion, tiled, layer, place)
            case other:
                conversion.leave_out(layer, f'a layer of type {other}')


def _add_object(conversion: Conversion, tiled: Content, each: Content, offset: Point) -> None:
    scale = 1.0 / tiled.divisor('tilewidth')
    if each.is_set('point') or 'text' in each:
        conversion.leave_out(each, f'a {"text" if "text" in each else "point"}')
        return
    each.skip(*_OF_THE_EDITOR)
    # Tiled has y down, the origin of an object at its upper left corner, of a tile at its lower.
    corner = (each.number('x') + offset[0]) * scale, _up(tiled, each.number('y') + offset[1])
    pose = *corner, -math.radians(each.number('rotation', 0.0))
    shape, center = _shape_of(each, scale)
    properties: dict[str, object] = {}
    for own in each.entries('properties'):
        if (key := own.text('name')) in PROPERTIES:
            properties[key] = own.get('value')
            own.skip(*_OF_THE_EDITOR)
        else:
            conversion.leave_out(own, f'property {key}')
    if not properties.keys() & {'anchored', 'kinematic', 'mass', 'density', 'velocity', 'spin'}:
        properties['anchored'] = True
    name = next((key for key in ('name', 'class', 'type') if each.is_set(key)), '')
    at = *local_to_world(center, pose), pose[2]
    conversion.add_body(each.text(name, 'object'), shape, at, **properties)


def _shape_of(each: Content, scale: float) -> tuple[dict[str, object], Point]:
    """
    Return the shape of an object, and its origin from that of the object [m].

    :param scale: metres a pixel
    """
    if key := next((key for key in ('polygon', 'polyline') if each.is_set(key)), ''):
        points = [
            (point.number('x') * scale, -point.number('y') * scale) for point in each.entries(key)
        ]
        if key == 'polyline':
            return line_shape(points), (0.0, 0.0)
        return {'polygon': [[x, y] for x, y in points]}, (0.0, 0.0)
    width, height = (each.number(key, 0.0) * scale for key in ('width', 'height'))
    center = width / 2, height / 2 if 'gid' in each else -height / 2
    if not each.is_set('ellipse'):
        return {'box': {'width': width, 'height': height}}, center
    if math.isclose(width, height, rel_tol=0.01):
        return {'circle': {'radius': width / 2}}, center
    outline = disc_outline((width / 2, height / 2))
    return {'polygon': [list(point) for point in outline.vertices]}, center


def _add_tiles(conversion: Conversion, tiled: Content, layer: Content, offset: Point) -> None:
    across, down = tiled.divisor('tilewidth'), tiled.divisor('tileheight')
    for chunk in layer.entries('chunks') or [layer]:
        tiles = _tiles_of(chunk, layer.text('compression', ''))
        x, y = (chunk.number(key, 0.0) for key in ('x', 'y'))
        for top, left, bottom, right in rectangles_of(tiles != 0, MOST_BODIES).tolist():
            size = float(right - left), (bottom - top) * down / across
            middle = (
                (left + right) / 2 + x + offset[0] / across,
                _up(tiled, ((top + bottom) / 2 + y) * down + offset[1]),
            )
            box = {'box': {'width': size[0], 'height': size[1]}}
            conversion.add_body(layer.text('name'), box, (*middle, 0.0), anchored=True)


def _tiles_of(chunk: Content, compression: str) -> NDArray[np.uint32]:
    """Return the numbers of the tiles of a chunk, (rows, columns) uint32; 0 is none."""
    rows, columns = (max(chunk.whole(key), 0) for key in ('height', 'width'))
    if rows * columns > MOST_CELLS:
        raise BadContent(f'a layer has more than {MOST_CELLS:,} tiles')
    if isinstance(data := chunk.get('data'), str):
        packed = _unpacked(data, compression, 4 * rows * columns)
    else:
        numbers = np.array(chunk.numbers('data'))
        if not ((numbers >= 0.0) & (numbers < 2.0**32)).all():
            raise BadContent(f'{chunk.place("data")} has a number that no tile has')
        packed = numbers.astype('<u4').tobytes()
    if len(packed) != 4 * rows * columns:
        raise BadContent(f'{chunk.place("data")} has no {rows} x {columns} tiles')
    return np.frombuffer(packed, '<u4').reshape(rows, columns)


def _unpacked(data: str, compression: str, size: int) -> bytes:
    """Return the bytes that a text in base64 stands for; a byte beyond a size tells of more."""
    try:
        packed = base64.b64decode(data)
        if not compression:
            return packed
        if compression not in {'zlib', 'gzip'}:
            raise BadContent(f'compression {compression} has no like here')
        # A small file may unfold to gigabytes.
        return zlib.decompressobj(_ANY_HEADER).decompress(packed, size + 1)
    except (ValueError, zlib.error) as error:
        raise BadContent(f'the data of a layer cannot be read: {error}') from error


def _up(tiled: Content, y: float) -> float:
    """Return the height above the lower edge of the map [m] of a y downward [pixels]."""
    height = tiled.number('height') * tiled.divisor('tileheight')
    return (height - y) / tiled.divisor('tilewidth')
