# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Arrays that are written into files come back to the bit, or are refused."""

from __future__ import annotations

import base64
from typing import Any
import zlib

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
from physsim_ros.files import impulse_cache
from physsim_ros.files.impulse_cache import pack, unpack
from physsim_ros.model.errors import BadProperty
import pytest


@given(st.lists(st.floats(), max_size=50))
def test_numbers_come_back_to_the_bit(numbers: list[float]) -> None:
    array = np.array(numbers, dtype=np.float64)
    assert unpack(pack(array), 'it', np.float64).tobytes() == array.tobytes()


@pytest.mark.parametrize('dtype', [np.float64, np.int64, np.uint64])
def test_rows_come_back_as_rows(dtype: Any) -> None:
    array = np.arange(12, dtype=dtype).reshape(-1, 3)
    np.testing.assert_array_equal(unpack(pack(array), 'it', dtype, 3), array)


def test_nothing_comes_back_as_nothing() -> None:
    assert unpack(pack(np.empty((0, 2))), 'it', np.float64, 2).shape == (0, 2)


@pytest.mark.parametrize(
    'text',
    [
        '',
        'no base64!',
        'ä',
        None,
        7,
        base64.b64encode(b'not compressed').decode(),
        base64.b64encode(zlib.compress(b'five!')).decode(),
        base64.b64encode(zlib.compress(b'eight by')).decode(),
    ],
)
def test_what_was_not_packed_is_refused(text: object) -> None:
    with pytest.raises(BadProperty) as refused:
        unpack(text, 'impulses', np.float64, 2)
    assert refused.value.field == 'impulses'


def test_a_line_that_would_fill_the_memory_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(impulse_cache, 'MOST_BYTES', 800)
    with pytest.raises(BadProperty, match='no end'):
        unpack(pack(np.zeros(10_000)), 'it', np.float64)
