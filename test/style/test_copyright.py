# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Every source file says whose it is, and under which licence, in its first two lines.

ament_copyright (0.17) compares the full text of notices and knows no SPDX identifiers, so it is no
test here.
"""

import re

import pytest

from .sources import ROOT, sources

HEAD = re.compile(
    r'# Copyright \d{4}(-\d{4})? physsim_ros maintainers\n# SPDX-License-Identifier: Apache-2.0\n'
)


@pytest.mark.linter
def test_every_source_file_begins_with_the_licence():
    texts = {path.relative_to(ROOT): path.read_text(encoding='utf-8') for path in sources()}

    assert [str(path) for path, text in texts.items() if text and not HEAD.match(text)] == []
