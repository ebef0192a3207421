# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Docstrings are written the way of PEP 257, as ament reads it."""

from ament_pep257.main import main
import pytest

from .changed_files import changed, ROOT


@pytest.mark.slow
@pytest.mark.linter
@pytest.mark.pep257
def test_ament_pep257_finds_no_errors(monkeypatch, cache):
    monkeypatch.chdir(ROOT)
    paths, digests = changed(cache, 'ament_pep257')

    assert not paths or main(argv=paths) == 0
    cache.set('ament_pep257', digests)
