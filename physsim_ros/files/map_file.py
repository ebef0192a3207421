# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Maps as map_server of Nav2 reads and writes them: a YAML file, and an image beside it.

An image has its first row at the top. A cell is occupied where it is darker than
`occupied_thresh`, transparency left aside, as in the server's mode `trinary`.

Law: nothing is decoded before the image's size in pixels is known to fit.
"""

from __future__ import annotations

from collections.abc import Mapping
import io
from pathlib import Path
from typing import Any, TYPE_CHECKING
import warnings

import numpy as np
from numpy.typing import NDArray
from physsim_ros.files.regular_file import read_bytes, read_file
from physsim_ros.files.world_schema import entries_of
from physsim_ros.files.yaml12 import load_mapping
from physsim_ros.maps import Grid, MOST_CELLS, walls_of
from physsim_ros.model.arrays import Flags
from physsim_ros.model.checks import must_be, number, Numbers, shown, Within
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.shapes import LARGEST, SMALLEST
from physsim_ros.model.translation import Text

if TYPE_CHECKING:
    from PIL import Image

# Greatest size of the YAML file [bytes].
_MOST_TEXT = 2**16
# Greatest size of the image [bytes]: a PGM of MOST_CELLS has a quarter.
_MOST_BYTES = 64 * 2**20
# Pillow's names of PGM and PNG.
_FORMATS = ('PPM', 'PNG')
_NEEDED = ('image', 'resolution', 'origin', 'negate', 'occupied_thresh', 'free_thresh')
_SHARE = Within(0.0, 1.0)
# x, y [m], yaw [rad].
_ORIGIN = Numbers((number, number, number))


def with_map_walls(content: Mapping[Any, Any], folder: Path, most: int) -> dict[Any, Any]:
    """
    Return the content of a world file with the walls of its map as its first bodies, `map/0` ...

    :param content: with the key `map`
    :param folder: in which the world file lies
    :param most: greatest number of walls
    :raises Refusal: the map cannot be read, or has too many cells or walls
    """
    walls = walls_of(load_map(content['map'], folder), 'map', most)
    entries = [
        {
            'name': wall.name,
            wall.shape.KEY: wall.shape.entry(),
            'at': list(wall.pose),
            'color': list(wall.color or ()),
            'anchored': True,
        }
        for wall in walls
    ]
    bodies = entries + entries_of(content.get('bodies'), 'bodies')
    return {**{key: content[key] for key in content if key != 'map'}, 'bodies': bodies}


def load_map(name: object, folder: Path) -> Grid:
    """
    Return the map of a file.

    :param name: of the YAML file, below the folder
    :param folder: below which both files lie, as paths without symbolic links
    :raises BadProperty: there is no such file, or a value is missing or of the wrong kind
    :raises Malformed: it is not YAML, a number is not finite, or the origin has not three
    :raises BadSize: cells or the whole are too small or too large
    :raises WorldFull: it has too many cells
    """
    path = _file_in(folder.resolve(), name, 'map')
    try:
        text = read_file(path, _MOST_TEXT)
    except (OSError, UnicodeDecodeError) as error:
        raise _unreadable(path, error, 'map') from error
    content = load_mapping(text, field='map')
    for key in _NEEDED:
        if content.get(key) is None:
            raise BadProperty('the map {file} has no {field}', field=key, file=path.name)
    if content.get('mode', 'trinary') != 'trinary':
        raise BadProperty(
            'mode is trinary, not {value}', field='mode', value=shown(content['mode'])
        )
    resolution = Within(SMALLEST, LARGEST, 'm')(content['resolution'], 'resolution')
    thresholds = [_SHARE(content[key], key) for key in ('free_thresh', 'occupied_thresh')]
    if thresholds[0] > thresholds[1]:
        raise BadProperty('free_thresh is above occupied_thresh', field='free_thresh')
    image = _file_in(path.parent, content['image'], 'image', root=folder.resolve())
    return Grid(
        occupied=_occupied(image, negate=_negate(content), threshold=thresholds[1]),
        resolution=resolution,
        origin=_ORIGIN(content['origin'], 'origin'),
    )


def _file_in(folder: Path, name: object, field: str, *, root: Path | None = None) -> Path:
    """Return the path of a file below a root, the folder itself by default."""
    if not isinstance(name, str):
        raise must_be('the name of a file', name, field)
    try:
        path = (folder / name).resolve()
    except (OSError, RuntimeError, ValueError) as error:
        raise BadProperty(
            '{field} {value} is not a path', field=field, value=shown(name)
        ) from error
    if not path.is_relative_to(root or folder):
        template = '{field} {value} is neither beside the world file nor below it'
        raise BadProperty(template, field=field, value=shown(name))
    return path


def _unreadable(path: Path, error: Exception | Text, field: str) -> BadProperty:
    reason = error if isinstance(error, Text) else str(getattr(error, 'strerror', '') or error)
    return BadProperty('cannot read {name}: {reason}', field=field, name=path.name, reason=reason)


def _negate(content: Mapping[Any, Any]) -> bool:
    negate = content['negate']
    if negate not in (0, 1):
        raise BadProperty('negate is 0 or 1, not {negate}', field='negate', negate=shown(negate))
    return bool(negate)


def _occupied(path: Path, *, negate: bool, threshold: float) -> Flags:
    """Return (rows, columns) bool: the occupied cells of an image, the lowest row first."""
    from PIL import Image, UnidentifiedImageError  # noqa: PLC0415 - few worlds have a map

    try:
        data = read_bytes(path, _MOST_BYTES)
        with warnings.catch_warnings():
            # Its size is checked here.
            warnings.simplefilter('ignore', Image.DecompressionBombWarning)
            with Image.open(io.BytesIO(data), formats=_FORMATS) as image:
                _check_pixels(path, *image.size)
                sums, most = _brightness(image)
    except UnidentifiedImageError as error:
        raise _unreadable(path, Text('it is neither a PGM nor a PNG'), 'image') from error
    except BadProperty:
        raise
    except Exception as error:
        # Decoders of Pillow raise whatever they stumble over.
        raise _unreadable(path, error, 'image') from error
    shades = np.arange(most + 1) / most
    dark = (shades if negate else 1.0 - shades) > threshold
    occupied: Flags = dark[sums][::-1]
    return occupied


def _check_pixels(path: Path, width: int, height: int) -> None:
    if width * height > MOST_CELLS:
        raise BadProperty(
            '{file} has {width} by {height} pixels; at most {most} are allowed',
            field='image',
            file=path.name,
            width=width,
            height=height,
            most=MOST_CELLS,
        )


def _brightness(image: Image.Image) -> tuple[NDArray[Any], int]:
    """Return the sum of the colours of each pixel, and the greatest that there can be."""
    if image.mode.startswith('I'):
        # 16 bits a pixel.
        return np.clip(np.asarray(image, dtype=np.int64), 0, 2**16 - 1), 2**16 - 1
    if image.mode in ('1', 'L', 'LA', 'La'):
        return np.asarray(image.convert('L')), 2**8 - 1
    return np.asarray(image.convert('RGB')).sum(axis=-1, dtype=np.uint16), 3 * (2**8 - 1)
