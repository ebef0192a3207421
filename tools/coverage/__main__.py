# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`make coverage`: the share of the package's lines, in Python and in C, that the tests run.

The tests run in a copy of the source tree, whose core gcc has compiled with counters (gcov).
coverage.py counts the lines and branches of Python, in the processes that tests start, too. A
process that is killed counts nothing, and scripts of the page are not counted. The tests are those
of `make test` without the ones of style; `make coverage ARGS=test/engine` chooses others.
"""

from __future__ import annotations

import os
from pathlib import Path
import re
import shutil
import subprocess
import sys
from tempfile import TemporaryDirectory
from test.source_tree import compile_core, copy_source

TESTS = ['test', '--ignore=test/style']
CORE = Path('physsim_ros/engine/core')
# What gcov says of a source file, of which it knows the path as the compiler had it.
LINES = re.compile(r"File '(.*)'\nLines executed:([\d.]+)% of (\d+)")


def run_tests(tree: Path, words: list[str]) -> int:
    """Run tests of a tree with coverage, and return the exit code."""
    coverage = [sys.executable, '-m', 'coverage']
    # Workers of pytest-xdist end without a word to gcov.
    pytest = ['-m', 'pytest', '-p', 'no:xdist']
    variables = os.environ | {'PYTHONPATH': str(tree)}
    run = [*coverage, 'run', *pytest, '-q', '-m', 'not slow', *words]
    code = subprocess.run(run, cwd=tree, env=variables, check=False).returncode
    subprocess.run([*coverage, 'combine', '--quiet'], cwd=tree, check=True)
    subprocess.run([*coverage, 'report', '--sort=cover', '--skip-covered'], cwd=tree, check=True)
    return code


def report_core(objects: Path, tree: Path) -> None:
    """Print the share of lines of each source file of the core that was run, and of all."""
    counts = [str(path) for path in objects.rglob('*.gcda')]
    command = ['gcov', '--no-output', '--relative-only', *counts]
    told = subprocess.run(command, cwd=tree, check=True, capture_output=True, text=True).stdout
    total = ran = 0.0
    # A header is told once for each file that includes it: the greatest share counts.
    found: dict[str, tuple[float, int]] = {}
    for path, share, lines in LINES.findall(told):
        if CORE.name in Path(path).parts:
            found[path] = max(found.get(path, (0.0, 0)), (float(share), int(lines)))
    for path, (share, lines) in sorted(found.items(), key=lambda item: item[1]):
        total, ran = total + lines, ran + lines * share / 100.0
        if share < 100.0:
            print(f'{path:50} {lines:6} {share:6.1f} %')
    print(f'{"the core in C":50} {total:6.0f} {100.0 * ran / max(total, 1.0):6.1f} %')


def main(words: list[str]) -> int:
    """Print what the tests cover; return the exit code of the tests."""
    if missing := [name for name in ('gcc', 'gcov') if shutil.which(name) is None]:
        sys.exit(f'coverage: {" and ".join(missing)} is not installed')
    with TemporaryDirectory(prefix='coverage_') as place:
        objects = Path(place, 'objects')
        tree = copy_source(Path(place, 'source'))
        compile_core(tree, objects, CC='gcc', CFLAGS='--coverage', LDFLAGS='--coverage')
        code = run_tests(tree, words or TESTS)
        report_core(objects, tree)
    return code


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
