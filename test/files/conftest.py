# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fixtures of the tests in this folder."""

from pathlib import Path

import pytest


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return an empty world directory, which has something beside it."""
    folder = tmp_path / 'worlds'
    folder.mkdir()
    return folder
