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

"""The style of ROS, as flake8 and ament's set of plugins see it."""

from pathlib import Path

from ament_flake8.main import main_with_errors
import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.flake8
@pytest.mark.linter
def test_ament_flake8_finds_no_errors(monkeypatch):
    # ament's own configuration is the default; ours is not looked at.
    monkeypatch.chdir(ROOT)

    code, errors = main_with_errors(argv=['physsim_ros', 'test', 'setup.py'])

    assert code == 0, f'{len(errors)} errors:\n' + '\n'.join(errors)
