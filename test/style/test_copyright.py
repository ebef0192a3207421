# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every source file says whose it is, and under which licence, in its first two lines."""

from pathlib import Path
import re

import pytest

from .changed_files import GENERATED

ROOT = Path(__file__).parents[2]
HEAD = re.compile(
    r'# Copyright \d{4}(-\d{4})? physsim_ros maintainers\n# SPDX-License-Identifier: Apache-2.0\n'
)


@pytest.mark.linter
def test_every_source_file_begins_with_the_licence():
    folders = ('physsim_ros', 'test', 'tools', 'launch')
    sources = [
        ROOT / 'setup.py',
        *(path for name in folders for path in ROOT.glob(f'{name}/**/*.py')),
    ]

    without = [
        str(path.relative_to(ROOT))
        for path in sources
        if path != GENERATED
        and (text := path.read_text(encoding='utf-8'))
        and not HEAD.match(text)
    ]

    assert without == []
