# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Arrays as base64 text, compressed: numbers for programs in files that people read.

Law: an array is unpacked as it was packed, to the bit, or refused.
"""

from __future__ import annotations

import base64
import binascii
from typing import Any
import zlib

import numpy as np
from numpy.typing import DTypeLike, NDArray
from physsim_ros.model.errors import BadProperty

# Greatest size of an array [bytes], far more than any world needs: a few lines of compressed text
# can expand to all the memory.
MOST_BYTES = 64 * 2**20


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
        raise BadProperty(f'{name} is not what was saved: it is no text', field=name)
    try:
        packed = base64.b64decode(text.encode('ascii'), validate=True)
        inflater = zlib.decompressobj()
        data = inflater.decompress(packed, MOST_BYTES)
        array = np.frombuffer(data, dtype=kind.newbyteorder('<')).astype(kind)
        array = array if width == 1 else array.reshape(-1, width)
    except (ValueError, binascii.Error, zlib.error) as error:
        raise BadProperty(f'{name} is not what was saved: {error}', field=name) from error
    if not inflater.eof:
        raise BadProperty(f'{name} is not what was saved: it has no end', field=name)
    return array
