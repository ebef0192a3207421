# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The package manifest is sound."""

from pathlib import Path
import shutil

from ament_xmllint.main import main
from catkin_pkg.package import parse_package
import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.linter
@pytest.mark.xmllint
def test_the_manifest_keeps_the_rules_of_rep_149():
    warnings = []

    # Raises where the file is not XML, or not a manifest.
    parse_package(ROOT / 'package.xml', warnings=warnings)

    assert warnings == []


@pytest.mark.linter
@pytest.mark.xmllint
@pytest.mark.skipif(shutil.which('xmllint') is None, reason='xmllint is not installed')
def test_ament_xmllint_finds_no_errors(monkeypatch):
    monkeypatch.chdir(ROOT)

    assert main(argv=['package.xml']) == 0
