# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The style of ROS, as flake8 and ament's set of plugins see it."""

import subprocess
import sys

import pytest

from .changed_files import changed, ROOT

# Looks at files in processes that it forks, which may hang where other tests have started threads:
# so it runs in one of its own.
AMENT_FLAKE8 = 'import sys; from ament_flake8.main import main; sys.exit(main(sys.argv[1:]))'


@pytest.mark.slow
@pytest.mark.flake8
@pytest.mark.linter
def test_ament_flake8_finds_no_errors(cache):
    paths, digests = changed(cache, 'ament_flake8')
    if paths:
        command = [sys.executable, '-c', AMENT_FLAKE8, *paths]
        # ament's own configuration is the default; ours is not looked at.
        seen = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
        assert seen.returncode == 0, seen.stdout + seen.stderr
    cache.set('ament_flake8', digests)
