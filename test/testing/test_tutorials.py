# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pages about tests do what they say: their files are written and run as a reader would."""

from __future__ import annotations

from pathlib import Path
import re

import pytest

pytest_plugins = ['pytester']
DOCS = Path(__file__).resolve().parents[2] / 'docs'
# A name of a file, and behind it the first block of Python.
FILE = re.compile(r'^`(\w+\.py)`.*?^```python\n(.*?)^```', re.MULTILINE | re.DOTALL)


@pytest.mark.slow
@pytest.mark.parametrize(
    ('page', 'passed'),
    [
        ('tutorials/test_your_robot', 3),
        ('tutorials/rewind_to_the_crash', 1),
        ('another_process', 2),
    ],
)
def test_its_tests_pass(pytester: pytest.Pytester, page: str, passed: int) -> None:
    files = FILE.findall((DOCS / f'{page}.md').read_text(encoding='utf-8'))
    for file, text in files:
        (pytester.path / file).write_text(text, encoding='utf-8')
    result = pytester.runpytest_subprocess('-p', 'no:cacheprovider', '-p', 'no:xdist', timeout=200)
    result.assert_outcomes(passed=passed)
