# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The impulses of contacts in a world file, under `memory`: arrays as compressed base64 text.

Law: impulses are loaded as they were saved, to the bit. They are not loaded where shapes have been
added or removed since, and refused where a text is not that of an array.
"""

from __future__ import annotations

import base64
import binascii
from dataclasses import fields
from typing import Any
import zlib

import numpy as np
from numpy.typing import DTypeLike, NDArray
from physsim_ros.model.checkpoint import ImpulseCache, WorldState
from physsim_ros.model.checks import Whole
from physsim_ros.model.declarations import known_mapping
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.scene import Scene

# Greatest size of an array [bytes], far more than any world needs: a few lines of compressed text
# can expand to all the memory.
MOST_BYTES = 64 * 2**20
_COUNT = Whole(0, 2**62 - 1)
_KEYS = [each.name for each in fields(ImpulseCache)]
# Type of the numbers, and numbers in a row, of each array; those that may be empty come last.
_ARRAYS: dict[str, tuple[DTypeLike, int]] = {
    'ids': (np.int64, 1),
    'pairs': (np.int64, 2),
    'hashes': (np.uint64, 1),
    'impulses': (np.float64, 2),
    'joints': (np.float64, 2),
    'totals': (np.float64, 2),
    'pushes': (np.float64, 3),
}
_MAY_LACK = ('totals', 'pushes')


def cache_entry(cache: ImpulseCache) -> dict[str, object]:
    """Return the entry of an impulse cache: numbers, and packed arrays."""
    values = {key: getattr(cache, key) for key in _KEYS}
    return {
        key: pack(value) if key in _ARRAYS else value
        for key, value in values.items()
        if key not in _MAY_LACK or len(value)
    }


def cache_from(entry: object, state: WorldState) -> ImpulseCache | None:
    """
    Return the impulse cache of an entry; None if it does not fit the bodies.

    :param state: the bodies and settings of the file
    :raises Refusal: the entry is not what `cache_entry` has returned
    """
    values = known_mapping(entry, 'memory', _KEYS)
    walls, following = (_COUNT(values.get(key), key) for key in ('walls', 'following'))
    arrays: dict[str, NDArray[Any]] = {
        key: unpack(values.get(key), key, *of)
        for key, of in _ARRAYS.items()
        if key in values or key not in _MAY_LACK
    }
    cache = ImpulseCache(walls=walls, following=following, **arrays)
    # No other bound: the heaviest and fastest bodies make impulses of any size.
    sound = all(np.isfinite(each).all() for each in arrays.values() if each.dtype.kind == 'f')
    if not (len(cache.pairs) == len(cache.hashes) == len(cache.impulses) and sound):
        raise BadProperty('memory is not what was saved', field='memory')
    scene = Scene(bodies=tuple(each.body for each in state.bodies), settings=state.settings)
    on_floor = np.count_nonzero(scene.floor_friction)
    if len(cache.ids) != len(state.bodies) or len(cache.pushes) not in (0, on_floor):
        return None
    # The shapes of a body, and the walls, have consecutive numbers; each number occurs once.
    counts = [len(each.body.shape.form.pieces) for each in state.bodies]
    runs = [*zip(cache.ids.tolist(), counts, strict=True), (following, 0)]
    if state.settings.bounds is not None:
        runs.append((walls, state.settings.wall_count))
    end = 0
    for first, count in sorted(runs):
        if first < end:
            return None
        end = first + count
    return cache


def pack(array: NDArray[Any]) -> str:
    """Return the numbers of an array as text, little-endian, without type and shape."""
    little = array.astype(array.dtype.newbyteorder('<'))
    return base64.b64encode(zlib.compress(little.tobytes())).decode()


def unpack(text: object, name: str, dtype: DTypeLike, width: int = 1) -> NDArray[Any]:
    """
    Return the (n,) or (n, width) array of a text.

    :param name: of the field, for the refusal
    :param dtype: of the numbers
    :param width: numbers in a row
    :raises BadProperty: the text is not that of such an array
    """
    kind = np.dtype(dtype)
    if not isinstance(text, str):
        raise BadProperty('{field} is not what was saved: it is not text', field=name)
    try:
        packed = base64.b64decode(text.encode('ascii'), validate=True)
        inflater = zlib.decompressobj()
        data = inflater.decompress(packed, MOST_BYTES)
        array = np.frombuffer(data, dtype=kind.newbyteorder('<')).astype(kind)
        array = array if width == 1 else array.reshape(-1, width)
    except (ValueError, binascii.Error, zlib.error) as error:
        raise BadProperty(
            '{field} is not what was saved: {error}', field=name, error=str(error)
        ) from error
    if not inflater.eof:
        raise BadProperty('{field} is not what was saved: it has no end', field=name)
    return array
