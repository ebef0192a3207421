# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
