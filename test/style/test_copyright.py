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

"""Every source file says whose it is, and under which licence."""

from importlib.util import find_spec
from pathlib import Path
import re

import pytest

ROOT = Path(__file__).parents[2]
PATHS = ['physsim_ros', 'test', 'setup.py']

# The notice is the one that this file itself begins with; years may differ.
COPYRIGHT = re.compile(r'# Copyright \d{4}(-\d{4})? \S.*')
NOTICE = Path(__file__).read_text(encoding='utf-8').split('\n\n')[0].splitlines()[1:]


def _has_the_notice(path):
    text = path.read_text(encoding='utf-8')
    first, *rest = [*text.split('\n\n')[0].splitlines(), '']
    return not text or (COPYRIGHT.fullmatch(first) and rest[:-1] == NOTICE)


@pytest.mark.copyright
@pytest.mark.linter
def test_every_source_file_begins_with_the_licence_notice():
    sources = [ROOT / 'setup.py', *ROOT.glob('physsim_ros/**/*.py'), *ROOT.glob('test/**/*.py')]

    without = [str(path.relative_to(ROOT)) for path in sources if not _has_the_notice(path)]

    assert without == []


@pytest.mark.copyright
@pytest.mark.linter
@pytest.mark.skipif(
    find_spec('ament_copyright') is None,
    reason='ament_copyright comes with ROS and has no wheel',
)
def test_ament_copyright_finds_no_errors(monkeypatch):
    from ament_copyright.main import main  # noqa: PLC0415  only where ROS is

    monkeypatch.chdir(ROOT)

    assert main(argv=[*PATHS, 'LICENSE', 'CONTRIBUTING.md']) == 0
