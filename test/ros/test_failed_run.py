# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A run of a sweep that has failed opens in the node, at the moment before."""

from pathlib import Path

from physsim_ros.sweeps import Case, save_failures
from physsim_ros.testing import PhysSim

from ..sweeps.followers import experiment


def test_a_failed_run_opens_in_the_node_and_fails_again(physsim: PhysSim, tmp_path: Path) -> None:
    run = experiment().run(Case(seed=3, parameters={'gain': 0.0}))
    (path,) = save_failures([run], tmp_path)

    physsim.load(path)

    robot = physsim.find_robot('robot/0')
    assert not robot.bumped
    physsim.run(0.5, until=lambda: robot.bumped)
    assert robot.bumped
