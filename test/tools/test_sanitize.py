# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`make sanitize` finds defects of the core where the laws hold in spite of them."""

import os
import shutil
import subprocess
import sys

import pytest

from ..source_tree import copy_source

OVERFLOW = 'AddressSanitizer: heap-buffer-overflow'
STEP = 'world->age++;'
OBSERVED = 'void core_observe(World *world, Pose *poses, Twist *twists) {'
# The report, the file, what the defect follows there, and the defect: behind memory of the core,
# behind an array of Python, and of arithmetic.
DEFECTS = [
    (OVERFLOW, 'step.c', STEP, 'TAKE(&world->own->arena, volatile char, 3)[3] = 0;'),
    (OVERFLOW, 'half_step.c', OBSERVED, 'twists[world->body_count - 1] = twists[0];'),
    (
        'runtime error: shift exponent',
        'step.c',
        STEP,
        '{ volatile int places = 40; places = 1 << places; }',
    ),
]


def _sanitized(tree):
    return subprocess.run(
        [sys.executable, '-m', 'tools.sanitize', 'test/laws/test_flight.py', '-k', 'projectile'],
        cwd=tree,
        env=os.environ | {'PYTHONPATH': str(tree)},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.slow
@pytest.mark.skipif(shutil.which('gcc') is None, reason='gcc is not installed')
@pytest.mark.parametrize(('report', 'name', 'place', 'defect'), DEFECTS)
def test_a_defect_ends_the_run_with_its_report(report, name, place, defect, tmp_path):
    tree = copy_source(tmp_path / 'source')
    path = tree / 'physsim_ros/engine/core' / name
    text = path.read_text(encoding='utf-8')
    assert place in text
    path.write_text(text.replace(place, f'{place} {defect}'), encoding='utf-8')

    done = _sanitized(tree)

    assert done.returncode == 1, done.stderr
    assert report in done.stdout
    assert f'physsim_ros/engine/core/{name}' in done.stdout
    assert done.stdout.splitlines()[-1] == (
        'sanitize: the core has a defect of memory or arithmetic; its report is above'
    )
