# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Docstrings are written the way of PEP 257, as ament reads it."""

from pathlib import Path

from ament_pep257.main import main
import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.slow
@pytest.mark.linter
@pytest.mark.pep257
def test_ament_pep257_finds_no_errors(monkeypatch):
    monkeypatch.chdir(ROOT)

    assert main(argv=['physsim_ros', 'test', 'tools', 'setup.py']) == 0
