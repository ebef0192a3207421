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

"""The README tells what to install."""

import ast
from pathlib import Path
import re

import pytest

ROOT = Path(__file__).parents[2]
README = (ROOT / 'README.md').read_text(encoding='utf-8')


@pytest.mark.linter
def test_what_pip_is_to_bring_is_what_the_package_asks_for():
    tree = ast.parse((ROOT / 'setup.py').read_text(encoding='utf-8'))
    (asked,) = (
        ast.literal_eval(keyword.value)
        for call in ast.walk(tree)
        if isinstance(call, ast.Call)
        for keyword in call.keywords
        if keyword.arg == 'install_requires'
    )
    (line,) = re.findall(r'^pip install (.*)$', README, re.MULTILINE)

    # rosdep knows that one.
    assert {word.strip("'") for word in line.split()} == set(asked) - {'PyYAML'}
