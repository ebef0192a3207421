# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Noise: normal numbers by seed, name and step, the same on every machine and in every replay.

Counter-based: the words of Philox4x64-10 (J. K. Salmon and others, Parallel random numbers: as
easy as 1, 2, 3, 2011), whose key is seed and name, and whose counter is the step. NumPy keeps the
words of its bit generators for ever, but no distribution; a normal number here is a sum of twelve
uniform ones (Irwin-Hall), in integers.

Law: a number depends on seed, name, step and its place alone; none is beyond six deviations.
"""

from __future__ import annotations

from functools import lru_cache
import hashlib
import math
import threading

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats

# Words for a normal number, four uniform ones of 16 bits each.
_WORDS = 3
# Mean and standard deviation of the sum of twelve; each has the variance of 1 to 2^16, which is a
# twelfth of 2^32 - 1.
_MEAN = 12 * (2**16 - 1) / 2
_DEVIATION = math.sqrt(2**32 - 1)
# The lower one of each two numbers of 16 bits in a word.
_LOWER = np.uint64(0x0000_FFFF_0000_FFFF)


def normals(seed: int, name: str, step: int, count: int) -> Floats:
    """
    Return (count,) float64: independent normal numbers of mean 0 and variance 1.

    A call takes some 15 µs, and 0.1 µs a number.

    :param seed: of all noise
    :param name: of what is noisy; two names have independent numbers
    :param step: number of steps since the world began, >= 0
    """
    words = _generator(seed, name, step).random_raw(_WORDS * count)
    # Two sums in the halves of a word.
    pairs = (words & _LOWER) + (words >> 16 & _LOWER)
    sums = pairs[::3] + pairs[1::3] + pairs[2::3]
    result: Floats = ((sums & 0xFFFF_FFFF) + (sums >> 32) - _MEAN) / _DEVIATION
    return result


def uniform(seed: int, name: str, step: int) -> float:
    """
    Return a number of 0 .. 1, each equally likely, as `normals`.

    :param seed: of all noise
    :param name: of what is random; two names have independent numbers
    :param step: number of steps since the world began, >= 0
    """
    return int(_generator(seed, name, step).random_raw()) / 2**64


class _OfThread(threading.local):
    """
    A generator of each thread, which begins anew with each key and counter.

    Another one would take four times as long: NumPy asks the system for a seed, without need.
    """

    def __init__(self) -> None:
        self.generator = np.random.Philox(0)


_OF_THREAD = _OfThread()
# Words of a generator that were made and not read: none.
_BUFFER = np.zeros(4, np.uint64)


def _generator(seed: int, name: str, step: int) -> np.random.Philox:
    """Return the generator of this thread, at the words of a seed, name and step."""
    generator = _OF_THREAD.generator
    generator.state = {
        'bit_generator': 'Philox',
        'state': {'counter': np.array((0, 0, 0, step), np.uint64), 'key': _key(seed, name)},
        'buffer': _BUFFER,
        'buffer_pos': len(_BUFFER),
        'has_uint32': 0,
        'uinteger': 0,
    }
    return generator


@lru_cache(maxsize=4096)
def _key(seed: int, name: str) -> NDArray[np.uint64]:
    """Return (2,) uint64: the key of a seed and a name."""
    digest = hashlib.blake2b(f'{seed} {name}'.encode(), digest_size=16).digest()
    return np.frombuffer(digest, dtype='<u8').astype(np.uint64)
