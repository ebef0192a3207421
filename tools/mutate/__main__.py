# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`make mutate`: forty mutations chosen at random, half of the core; a test has to notice each.

`SEED=7 make mutate` chooses others, `COUNT=3` fewer, and `ONLY=10:20` tries a part of those.
`make mutate ARGS=engine/core/floor` tries those of files whose path below `physsim_ros/` begins
so, as after a change of them. The exit code is 1 if more than `MOST_SURVIVORS` are not noticed.
"""

from __future__ import annotations

import itertools
import os
from pathlib import Path
from random import Random
import re
import subprocess
import sys
from tempfile import TemporaryDirectory
from test.source_tree import compile_core, copy_source, ROOT
import time

import pytest

from .likeness import by_likeness
from .mutations import Mutation, mutations_of

PACKAGE = Path('physsim_ros')
CORE = PACKAGE / 'engine/core'
# Folders of tests that are about parts of the package of another name.
FURTHER = {
    'engine': ('laws', 'relations', 'sensing', 'simulation'),
    'model': ('laws', 'simulation'),
    'sensing': ('simulation',),
}
# The files of tests are run in parts that end here, because pytest first collects all of a part.
PARTS = (3, 12)
# Survivors that forty mutations may have.
MOST_SURVIVORS = 8
# Many times what the fast tests of a folder take [s].
LONGEST = 1800


def candidates(words: list[str]) -> list[Mutation]:
    """Return the mutations of all files, or of those whose path begins with one of the words."""
    paths = (path.relative_to(ROOT) for path in sorted((ROOT / PACKAGE).rglob('*')))
    chosen = [
        path
        for path in paths
        if path.suffix in {'.c', '.js', '.py'} and path.name != '_declarations.py'
        if not words or any(str(path.relative_to(PACKAGE)).startswith(word) for word in words)
    ]
    return [
        each for path in chosen for each in mutations_of(path, (ROOT / path).read_text('utf-8'))
    ]


def choice(every: list[Mutation], count: int, seed: int) -> list[Mutation]:
    """Return mutations chosen at random, half of the core, as far as there are any."""
    core = [each for each in every if each.path.suffix == '.c']
    other = [each for each in every if each.path.suffix != '.c']
    half = min(max(count // 2, count - len(other)), len(core))
    random = Random(seed)
    return random.sample(core, half) + random.sample(other, min(count - half, len(other)))


def tests_of(mutation: Mutation) -> list[str]:
    """Return the files whose tests have to notice a mutation, the likeliest first."""
    folder = mutation.path.parts[1]
    folders = [folder] if (ROOT / 'test' / folder).is_dir() else ['.']
    folders += FURTHER.get(folder, ())
    # Limits are promised by documents, whatever folder they are of.
    found = {
        ROOT / 'test/test_limits.py',
        *itertools.chain(*((ROOT / 'test' / each).rglob('test_*.py') for each in folders)),
    }
    return [str(each.relative_to(ROOT)) for each in by_likeness(sorted(found), mutation)]


def who_notices(tree: Path, mutation: Mutation) -> str:
    """Return the compiler, or the first test that fails, or an empty text."""
    if mutation.path.suffix == '.c':
        try:
            compile_core(tree)
        except (AssertionError, subprocess.TimeoutExpired):
            return 'the compiler'
    tests = tests_of(mutation)
    # The page runs only in a browser, whose tests are slow, but for those of what everybody does.
    marks = 'slow or everyday' if mutation.path.suffix == '.js' else 'not slow'
    parts = (tests[begin:end] for begin, end in itertools.pairwise((0, *PARTS, len(tests))))
    return next(filter(None, (failed(tree, ['-m', marks, *part]) for part in parts if part)), '')


def failed(tree: Path, words: list[str]) -> str:
    """Return the first test that fails of those that words of pytest choose, or an empty text."""
    # In their order, a few to each worker.
    command = [sys.executable, '-m', 'pytest', '--exitfirst', '--quiet', '--numprocesses=auto']
    command += ['--maxprocesses=8', '--maxschedchunk=8', '--max-worker-restart=0', *words]
    try:
        done = subprocess.run(
            command,
            cwd=tree,
            env=os.environ | {'PYTHONPATH': str(tree)},
            capture_output=True,
            check=False,
            timeout=LONGEST,
            text=True,
        )
    except subprocess.TimeoutExpired:
        return 'tests that do not end'
    if done.returncode in {0, pytest.ExitCode.NO_TESTS_COLLECTED}:
        return ''
    found = re.search(r'^(?:FAILED|ERROR) (.+?)(?: - .*)?$', done.stdout, re.MULTILINE)
    return found[1] if found else 'pytest'


def main(words: list[str]) -> int:
    """Try mutations; return 1 where more survive than may, else 0."""
    every = candidates(words)
    chosen = choice(every, int(os.environ.get('COUNT') or 40), int(os.environ.get('SEED') or 0))
    begin, _, end = os.environ.get('ONLY', '').partition(':')
    chosen = chosen[slice(int(begin or 0), int(end or len(chosen)))]
    survivors = 0
    with TemporaryDirectory(prefix='mutate_') as place:
        tree = copy_source(Path(place) / 'source')
        compile_core(tree)
        (library,) = (tree / CORE).glob('_core.*')
        compiled = library.read_bytes()
        for mutation in chosen:
            text = (ROOT / mutation.path).read_bytes()
            (tree / mutation.path).write_bytes(mutation.applied(text))
            begun = time.monotonic()
            who = who_notices(tree, mutation)
            print(f'{"noticed " if who else "SURVIVES"} {mutation.told(text)}')
            print(f'  {who or "no test"}, {time.monotonic() - begun:.0f} s', flush=True)
            survivors += not who
            (tree / mutation.path).write_bytes(text)
            # A library that somebody has loaded is not written over.
            library.unlink(missing_ok=True)
            library.write_bytes(compiled)
    print(f'mutate: {survivors} of {len(chosen)} survive, of {len(every)} that there can be')
    return int(survivors > MOST_SURVIVORS)


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
