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
