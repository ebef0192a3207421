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
Arrays as text: what a program has written for programs, in files that people read.

Law: what is unpacked is what was packed, to the bit, or it is refused.
"""

from __future__ import annotations

import base64
import binascii
from typing import Any
import zlib

import numpy as np
from numpy.typing import DTypeLike, NDArray
from physsim_ros.model.errors import BadProperty

# Far more than any world needs [bytes]: a few lines of text could unfold to all the memory.
MOST = 64 * 2**20


def pack(array: NDArray[Any]) -> str:
    """Return the numbers of an array as text, little-endian; type and shape are not in it."""
    little = array.astype(array.dtype.newbyteorder('<'))
    return base64.b64encode(zlib.compress(little.tobytes())).decode()


def unpack(text: object, name: str, dtype: DTypeLike, width: int = 1) -> NDArray[Any]:
    """
    Return the (n,) or (n, width) array that a text holds.

    :param name: of the field, for the refusal
    :raises BadProperty: it holds none
    """
    kind = np.dtype(dtype)
    if not isinstance(text, str):
        raise BadProperty(f'{name} is not what was saved: it is no text', field=name)
    try:
        packed = base64.b64decode(text.encode('ascii'), validate=True)
        unfolding = zlib.decompressobj()
        numbers = unfolding.decompress(packed, MOST)
        array = np.frombuffer(numbers, dtype=kind.newbyteorder('<')).astype(kind)
        array = array if width == 1 else array.reshape(-1, width)
    except (ValueError, binascii.Error, zlib.error) as error:
        raise BadProperty(f'{name} is not what was saved: {error}', field=name) from error
    if not unfolding.eof:
        raise BadProperty(f'{name} is not what was saved: it has no end', field=name)
    return array
