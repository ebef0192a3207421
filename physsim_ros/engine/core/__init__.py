# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The core: all that happens within a step, and the rays of readings after it, in C.

Its sources are in this folder, one file a stage; `engine/core/core.h` is what they share with
Python. Not here: what is built once for a scene, which is Python's (`engine`). Start with
`engine/core/step.c`, then `engine/core/core.h`.

It is a plain shared library without any Python in it, so that one binary serves every Python; cffi
calls it by its declarations, which `setup.py` writes (ABI mode, out of line), and lets other
threads run meanwhile.
"""

from __future__ import annotations

from functools import cache
from importlib.machinery import EXTENSION_SUFFIXES
from importlib.resources import files
from importlib.resources.abc import Traversable
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.core.sources import hash_of_sources

# The call that builds it in a source tree.
_BUILD = '`pip install --editable .`'
_HERE = files(__name__)
# Of an ELF file of 64 bits: where the table of its sections begins, and the size and number of
# their entries; the table is its end (System V ABI, 4).
_ELF = struct.Struct('<4s 36x Q 10x HH 2x')

try:
    from physsim_ros.engine.core._declarations import ffi as ffi
    from physsim_ros.engine.core._declarations import SOURCES
except ImportError as error:
    raise ImportError(f'the core of the engine has not been compiled; run {_BUILD}') from error


def _load() -> Any:
    """
    Return the library.

    :raises ImportError: it has not been built whole for this machine, or not from the sources of
        its declarations, or not from these sources
    """
    paths = [path for suffix in EXTENSION_SUFFIXES if (path := _HERE / f'_core{suffix}').is_file()]
    if not paths:
        raise ImportError(f'the core of the engine has not been compiled; run {_BUILD}')
    # A world that is freed at the very end of the interpreter calls it: it must not be unloaded
    # with this module.
    try:
        _check_whole(paths[0])
        library = ffi.dlopen(str(paths[0]), ffi.RTLD_NOW | ffi.RTLD_NODELETE)
        theirs = ffi.string(library.core_sources()).decode()
    except (ffi.error, OSError) as error:
        raise ImportError(
            f'the core of the engine cannot be loaded, {error}; remove {paths[0]} and run {_BUILD}'
        ) from error
    ours = hash_of_sources(_HERE) or theirs
    if not ours == theirs == SOURCES:
        raise ImportError(f'the core of the engine was compiled from other sources; run {_BUILD}')
    return library


def _check_whole(path: Traversable) -> None:
    """
    Refuse a part of a library, as a full disk leaves it: loading it would end the process.

    :raises OSError: the file ends before the table of its sections does
    """
    data = path.read_bytes()
    if data[:4] != b'\x7fELF':
        # Of another system, which checks it as it is loaded.
        return
    if len(data) < _ELF.size:
        raise OSError('it is cut off')
    _, begin, size, count = _ELF.unpack_from(data)
    if len(data) < begin + size * count:
        raise OSError('it is cut off')


def sub_step_of(physics_rate: float) -> float:
    """
    Return the time of each of the equal parts in which a step is made [s].

    :param physics_rate: steps a second [Hz]
    """
    return 1.0 / physics_rate / int(lib.SUB_STEPS)


def pointer(array: NDArray[Any], kind: str) -> Any:
    """
    Return the pointer to the first value of an array, which has to live as long.

    :param array: contiguous
    :param kind: of its values, as C has it
    """
    return ffi.from_buffer(_array_of(kind), array)


@cache
def _array_of(kind: str) -> Any:
    """Return the type of arrays; cffi takes five times as long by its name."""
    return ffi.typeof(f'{kind}[]')


def dtype_of(struct: str) -> np.dtype[np.void]:
    """
    Return the type of NumPy that has the fields of a struct.

    Vectors, poses and twists are arrays of float64, pointers are integers.
    """
    return _fields_of(ffi.typeof(struct))


def _fields_of(kind: Any) -> np.dtype[np.void]:
    fields = {name: (_dtype(field.type), field.offset) for name, field in kind.fields}
    return np.dtype(
        {
            'names': [*fields],
            'formats': [each for each, _ in fields.values()],
            'offsets': [offset for _, offset in fields.values()],
            'itemsize': ffi.sizeof(kind),
        }
    )


def _dtype(kind: Any) -> np.dtype[Any]:
    match kind.kind:
        case 'array':
            return np.dtype((_dtype(kind.item), (kind.length,)))
        case 'struct' if not _is_of_doubles(kind):
            return _fields_of(kind)
        case 'struct':
            return np.dtype((np.float64, (ffi.sizeof(kind) // 8,)))
        case 'pointer':
            return np.dtype(np.uintp)
    letter = 'f' if kind.cname == 'double' else 'u' if kind.cname.startswith('u') else 'i'
    return np.dtype(f'{letter}{ffi.sizeof(kind)}')


def _is_of_doubles(kind: Any) -> bool:
    """Return whether a struct has no other numbers: a vector, a pose, a twist."""
    if kind.kind == 'struct':
        return all(_is_of_doubles(field.type) for _, field in kind.fields)
    return bool(kind.cname == 'double')


lib = _load()
