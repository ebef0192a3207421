# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The size of the page: what a pupil's telephone has to read."""

from __future__ import annotations

import gzip
from pathlib import Path

from physsim_ros import sketchpad

PAGE = Path(sketchpad.__file__).parent / 'page'
# What a browser never asks for.
OF_EDITORS = {'types.d.ts', 'tsconfig.json'}
# Greatest size of all files, compressed together [bytes].
GREATEST = 90_000


def test_the_page_is_light() -> None:
    files = [each for each in PAGE.rglob('*.*') if each.is_file() and each.name not in OF_EDITORS]
    assert len(files) > 40
    whole = b''.join(each.read_bytes() for each in sorted(files))
    assert len(gzip.compress(whole)) <= GREATEST
