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

import pytest

from .mutations import Mutation, mutations_of

PACKAGE = Path('physsim_ros')
CORE = PACKAGE / 'engine/core'
# Folders of tests that are about parts of the package of another name.
FURTHER = {
    'engine': ('laws', 'relations', 'sensing', 'simulation'),
    'model': ('laws', 'simulation'),
    'sensing': ('simulation',),
}
# Number of files that are run first, the likeliest, which notice most mutations.
FIRST = 10
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


def tests_of(path: Path) -> list[str]:
    """Return the files whose tests have to notice a mutation of a file, the likeliest first."""
    folder = path.parts[1]
    folders = [folder] if (ROOT / 'test' / folder).is_dir() else ['.']
    folders += FURTHER.get(folder, ())
    # The stems of words, so that `measures` is like `measuring`.
    words = [word[:6] for part in path.with_suffix('').parts[2:] for word in part.split('_')]

    def unlikeness(test: Path) -> tuple[int, int, Path]:
        named = sum(word in test.stem for word in words)
        text = test.read_text(encoding='utf-8')
        return -named, -sum(len(re.findall(rf'\b{word}', text)) for word in words), test

    # Limits are promised by documents, whatever folder they are of.
    found = {
        ROOT / 'test/test_limits.py',
        *itertools.chain(*((ROOT / 'test' / each).rglob('test_*.py') for each in folders)),
    }
    return [str(each.relative_to(ROOT)) for each in sorted(found, key=unlikeness)]


def is_noticed(tree: Path, path: Path) -> bool:
    """Return whether the core does not compile any more, or not soon, or a test fails."""
    if path.suffix == '.c':
        try:
            compile_core(tree)
        except (AssertionError, subprocess.TimeoutExpired):
            return True
    tests = tests_of(path)
    # The page runs in a browser only, whose tests are all slow.
    words = [] if path.suffix == '.js' else ['-m', 'not slow']
    return any(fails(tree, [*each, *words]) for each in (tests[:FIRST], tests[FIRST:]) if each)


def fails(tree: Path, words: list[str]) -> bool:
    """Return whether a test of those that words of pytest choose fails, or does not end."""
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
        )
    except subprocess.TimeoutExpired:
        return True
    return done.returncode not in {0, pytest.ExitCode.NO_TESTS_COLLECTED}


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
            noticed = is_noticed(tree, mutation.path)
            print(f'{"noticed " if noticed else "SURVIVES"} {mutation.told(text)}', flush=True)
            survivors += not noticed
            (tree / mutation.path).write_bytes(text)
            # A library that somebody has loaded is not written over.
            library.unlink(missing_ok=True)
            library.write_bytes(compiled)
    print(f'mutate: {survivors} of {len(chosen)} survive, of {len(every)} that there can be')
    return int(survivors > MOST_SURVIVORS)


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
