# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tutorials do what they say: their files, edits and commands are those of a reader."""

from __future__ import annotations

from pathlib import Path
import re
import shutil
import subprocess
import sys

import pytest

from ..outside import Outside
from ..source_tree import blocks_of, copy_source, ROOT

pytest_plugins = ['pytester']
DOCS = ROOT / 'docs'
# A name of a file, and behind it the first block of Python.
FILE = re.compile(r'^.*?`(\w+\.py)`.*?^```python\n(.*?)^```', re.MULTILINE | re.DOTALL)
# A line of a file, the file, and a block of Python that is written above that line.
EDIT = re.compile(r'(?ims)above `([^`]+)` in `([^`]+)`:\n\n```python\n(.*?)^```')
# Columns of a measured law without its error, which is one of rounding.
MEASURED = 78


def page(name: str) -> str:
    return (DOCS / f'{name}.md').read_text(encoding='utf-8')


@pytest.mark.slow
@pytest.mark.parametrize(
    ('name', 'passed'),
    [
        ('tutorials/test_your_robot', 3),
        ('tutorials/rewind_to_the_crash', 1),
        ('tutorials/teach_free_fall', 1),
        ('tutorials/record_and_look', 1),
        ('another_process', 2),
    ],
)
def test_its_tests_pass(pytester: pytest.Pytester, name: str, passed: int) -> None:
    for file, text in FILE.findall(page(name)):
        (pytester.path / file).write_text(text, encoding='utf-8')
    result = pytester.runpytest_subprocess('-p', 'no:cacheprovider', '-p', 'no:xdist', timeout=200)
    result.assert_outcomes(passed=passed)


@pytest.mark.slow
def test_free_fall_is_measured_again_and_again(outside: Outside) -> None:
    program = outside.directory / 'fall.py'
    program.write_text(dict(FILE.findall(page('tutorials/teach_free_fall')))['fall.py'], 'utf-8')
    (printed,) = blocks_of('docs/tutorials/teach_free_fall.md', 'text')
    with outside.start_world(bounds='[-10.0, 0.0, 10.0, 12.0]') as world:
        world.wait_for('ready')
        for _ in range(4):
            with outside.start(sys.executable, program) as fall:
                # The last time that it prints.
                fall.wait_for(printed.splitlines()[-1].partition('  ')[0])
                assert fall.finish() == 0, ''.join(fall.lines)
        assert world.interrupt() == 0


@pytest.mark.slow
def test_the_path_of_a_body_is_written_as_a_table(outside: Outside) -> None:
    program = outside.directory / 'path.py'
    program.write_text(dict(FILE.findall(page('tutorials/record_and_look')))['path.py'], 'utf-8')
    with (
        outside.start_world(gravity='[0.0, 0.0]') as world,
        outside.start(sys.executable, program, 'my/1') as path,
    ):
        path.wait_for('t [s],x [m],y [m],vx [m/s],vy [m/s]')
        # The body of README, which flies straight where there is no gravity.
        (first,) = (block for block in blocks_of('README.md', 'python') if 'create_node' in block)
        (outside.directory / 'first.py').write_text(first, 'utf-8')
        with outside.start(sys.executable, outside.directory / 'first.py') as ball:
            assert ball.finish() == 0, ''.join(ball.lines)
        rows = [[float(word) for word in path.wait_for(',').split(',')] for _ in range(9)]
        assert path.interrupt() == 0, ''.join(path.lines)
        assert world.interrupt() == 0
    for time, *place in rows:
        passed = time - rows[0][0]
        expected = [rows[0][1] - 3.0 * passed, rows[0][2] + 2.0 * passed, -3.0, 2.0]
        # Stamps have nanoseconds.
        assert place == pytest.approx(expected, abs=1e-8)


@pytest.mark.slow
def test_a_kind_of_joint_is_added_in_the_steps_of_its_tutorial(tmp_path: Path) -> None:
    tree = copy_source(tmp_path / 'clone')
    core = Path('physsim_ros/engine/core')
    for built in (*(ROOT / core).glob('*.so'), ROOT / core / '_declarations.py'):
        shutil.copy(built, tree / core)
    edits = EDIT.findall(page('tutorials/add_a_joint_kind'))
    assert len(edits) == 6
    for line, file, block in edits:
        text = (tree / file).read_text(encoding='utf-8')
        assert text.count(line) == 1, line
        (tree / file).write_text(text.replace(line, block + line), encoding='utf-8')
    for block in blocks_of('docs/tutorials/add_a_joint_kind.md', 'console'):
        run_as_told(block, tree)


def run_as_told(block: str, tree: Path) -> None:
    """Run the commands of a block in a source tree, and check that they print what it says."""
    printed = ''
    for line in block.splitlines():
        if line.startswith('$ '):
            words = line.removeprefix('$ ').split()
            assert words[0] == '.venv/bin/python'
            done = subprocess.run(
                [sys.executable, *words[1:]],
                cwd=tree,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                check=False,
            )
            printed = done.stdout
            assert done.returncode == 0, printed
        else:
            assert line[:MEASURED] in printed
