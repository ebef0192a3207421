# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The fixture of a world, and the report of a test that failed with it."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from physsim_ros.testing.world import PhysSim


@dataclass
class _Run:
    """
    A test with a world.

    :ivar path: of the recording, if the test fails
    :ivar failed: whether its past is to be recorded
    """

    world: PhysSim
    path: Path
    failed: bool = False


_RUN = pytest.StashKey[_Run]()


@pytest.fixture
def physsim(
    request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[PhysSim]:
    """
    Yield a world with its own context and domain, whose time the test advances.

    Where the test fails, a recording of it is kept in its `tmp_path`.
    """
    from physsim_ros.testing.context import own_context
    from physsim_ros.testing.world import PhysSim

    directory = request.path.parent
    with (
        own_context(monkeypatch) as context,
        PhysSim(context, directory=directory, world_dir=str(tmp_path)) as world,
    ):
        run = request.node.stash[_RUN] = _Run(world, tmp_path / 'failed.rrd')
        yield world
        if run.failed:
            world.record_past(run.path)
        # The items of a session live as long as that.
        del request.node.stash[_RUN]


def pytest_configure(config: pytest.Config) -> None:
    """Ignore two warnings of lark-parser 0.12, which ROS 2 Jazzy parses its interfaces with."""
    config.addinivalue_line('filterwarnings', 'ignore:module .sre_:DeprecationWarning:lark')


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Add the poses of bodies and the path of the recording to the report of a failed test."""
    report = yield
    run = item.stash.get(_RUN, None)
    if call.when == 'call' and report.failed and run is not None:
        run.failed = run.world.recording is None
        words = f'{run.world.describe_state()}\nrecording: {run.world.recording or run.path}'
        report.sections.append(('physsim', words))
    return report
