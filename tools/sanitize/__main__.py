# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`make sanitize`: tests and random histories with a core that checks its memory and arithmetic.

The core is compiled by gcc in a copy of the source tree, with AddressSanitizer and
UndefinedBehaviorSanitizer. What the core is handed are arrays of NumPy, which takes each from the
heap, so that their ends are known, too. The first defect ends the run with the report of the
sanitizer, and the exit code is 1.

The tests are the laws and those of the engine, but for slow ones, and for those that measure
memory or CPU time: AddressSanitizer keeps for a while what is freed, and checks take time.
`HISTORIES=40 make sanitize` chooses the number of histories, which is 200, and
`make sanitize ARGS='test/drawing -k time'` other tests; those over ROS do not run there.
"""

from __future__ import annotations

import os
from pathlib import Path
import shutil
import subprocess
import sys
from tempfile import TemporaryDirectory, TemporaryFile
from test.source_tree import compile_core, copy_source, ROOT

CHECKS = '-fsanitize=address,undefined,float-cast-overflow'
FLAGS = f'-O1 -g -fno-omit-frame-pointer {CHECKS} -fno-sanitize-recover=all'
TESTS = ['test/laws', 'test/engine', 'test/simulation/test_histories.py']
# How reports of the sanitizers begin.
REPORTS = ('ERROR: AddressSanitizer', 'runtime error: ')
CORE = Path('physsim_ros/engine/core')


def libraries() -> list[str]:
    """
    Return the paths of the sanitizers' own libraries, which are loaded before all others.

    :raises SystemExit: this machine does not have them
    """
    if shutil.which('gcc') is None:
        sys.exit('sanitize: gcc is not installed')
    names = ('libasan.so', 'libubsan.so')
    paths = [_output('gcc', f'-print-file-name={name}') for name in names]
    # gcc repeats a name that it does not find.
    if missing := [name for name, path in zip(names, paths, strict=True) if name == path]:
        sys.exit(f'sanitize: gcc has no {" and no ".join(missing)} here')
    return paths


def _output(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


def environment(tree: Path) -> dict[str, str]:
    """Return the variables with which the tests of a tree run."""
    return os.environ | {
        'PYTHONPATH': str(tree),
        # The wheels of ROS start Python anew, but for this mark.
        '_ROS_WHEELS_BOOTSTRAP_COMPLETE': '1',
        'LD_PRELOAD': ' '.join(libraries()),
        # Python frees little at its end. Segmentation faults are the sanitizer's to report.
        'ASAN_OPTIONS': 'detect_leaks=0:handle_segv=2',
        'UBSAN_OPTIONS': 'print_stacktrace=1',
        'HISTORIES': os.environ.get('HISTORIES') or '200',
    }


def run_tests(tree: Path, words: list[str]) -> tuple[int, str]:
    """Run tests of a tree; return the exit code, and what was written to the standard error."""
    pytest = [sys.executable, '-m', 'pytest', '-p', 'no:faulthandler', '--exitfirst']
    # A worker that is ended has no time to hand over what pytest has captured.
    pytest += ['--capture=sys', '--numprocesses=auto', '--maxprocesses=8', '--dist=worksteal']
    pytest += ['--max-worker-restart=0', '-m', 'not slow and not cost']
    with TemporaryFile(mode='w+', errors='replace') as errors:
        done = subprocess.run(
            [*pytest, *words], cwd=tree, env=environment(tree), stderr=errors, check=False
        )
        errors.seek(0)
        return done.returncode, errors.read()


def main(words: list[str]) -> int:
    """Run tests; return 0 where they pass and nothing is reported."""
    libraries()
    with TemporaryDirectory(prefix='sanitize_') as place:
        tree = copy_source(Path(place) / 'source')
        shutil.copy(ROOT / 'tools/sanitize/arena.c', tree / CORE / 'arena.c')
        compile_core(tree, CC='gcc', CFLAGS=FLAGS, LDFLAGS=CHECKS)
        code, errors = run_tests(tree, words or TESTS)
    print(errors)
    if any(word in errors for word in REPORTS):
        print('sanitize: the core has a defect of memory or arithmetic; its report is above')
        return 1
    if code:
        print('sanitize: nothing is reported, but the tests do not pass')
        return code
    print('sanitize: no defect of memory or arithmetic')
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
