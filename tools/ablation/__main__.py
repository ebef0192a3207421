# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`make ablate`: the tests that fail without each stage of a step, and what the stage costs.

The tests are those of laws, worlds and the engine. `make ablate ARGS='floor edges'` chooses stages
by words in their names; all take an hour on two processors.
"""

from __future__ import annotations

from collections import Counter
import os
import re
import subprocess
import sys

from .cost import share
from .plugin import LEFT_OUT
from .stages import Stage, STAGES

TESTS = ('test/laws', 'test/worlds', 'test/engine')
# Of a line about a case that has failed, its test.
FAILED = re.compile(r'^FAILED test/([^\s[]+)', re.MULTILINE)


def failures(stage: Stage) -> Counter[str]:
    """Return the tests that fail without a stage, each with the number of its cases that do."""
    command = [sys.executable, '-m', 'pytest', '-p', 'tools.ablation.plugin', '-rf', '--tb=no']
    command += ['--numprocesses=auto', '--maxprocesses=8', '-m', 'not slow and not cost', *TESTS]
    environment = os.environ | {LEFT_OUT: stage.name}
    done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True, check=False)
    return Counter(FAILED.findall(done.stdout))


def main(words: list[str]) -> None:
    """Print the cost of the chosen stages, or of all, and the tests that fail without each."""
    chosen = [each for each in STAGES if not words or any(word in each.name for word in words)]
    if not chosen:
        sys.exit(f'no stage with {" or ".join(words)}')
    for stage in chosen:
        cost = f', {share(stage):.1%} of a step' if stage.mask else ''
        print(f'{stage.name}{cost}', flush=True)
        for test, cases in failures(stage).most_common():
            print(f'{cases:6}  {test}', flush=True)


if __name__ == '__main__':
    main(sys.argv[1:])
