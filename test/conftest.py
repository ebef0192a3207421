# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Fixtures of the tests over ROS, which tests are slow, an end to tests that hang, and the core.

What needs ROS is imported late: the core's tests run where there is no ROS.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager, ExitStack
import faulthandler
import os
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, TYPE_CHECKING

import pytest

from .leftovers import Open
from .source_tree import compile_core, is_compiled, ROOT

if TYPE_CHECKING:
    from physsim_ros.testing import PhysSim

    from .client import Client
    from .outside import Outside

# Fixtures that start other processes: a test that asks for one is slow, unless it is `everyday`.
PROCESSES = {'chromium', 'outside', 'server'}
# Fixtures that have a world over ROS in this process.
WORLDS = {'physsim', 'start'}
# For setup, call and teardown of a test each [s]: ten times what the slowest may take.
LONGEST = 300.0
STDERR = pytest.StashKey[int]()

# `colcon test` runs the source tree, in which `colcon build` has compiled nothing. Not in a hook:
# what other folders' conftest.py import needs it.
if not is_compiled():
    compile_core(ROOT)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        starts = PROCESSES.intersection(getattr(item, 'fixturenames', ()))
        if starts and not item.get_closest_marker('everyday'):
            item.add_marker(pytest.mark.slow)


def pytest_configure(config: pytest.Config) -> None:
    # A test's own stderr is captured, and lost with its process.
    config.stash[STDERR] = os.dup(2)
    # Worlds that a node keeps by itself are not to lie among those of the person who runs tests.
    data = TemporaryDirectory(prefix='physsim_test_')
    config.add_cleanup(data.cleanup)
    os.environ['XDG_DATA_HOME'] = data.name


@contextmanager
def _ended(item: pytest.Item) -> Iterator[None]:
    """
    End the process after `LONGEST` and show where it hangs; xdist starts another and goes on.

    The watchdog is a thread in C. That of pytest-timeout is one in Python: it never comes while C
    code keeps the interpreter, and like pytest's own it stops watching when a test has failed, so
    that the teardown of such a test could hang for ever.
    """
    faulthandler.dump_traceback_later(LONGEST, exit=True, file=item.config.stash[STDERR])
    try:
        yield
    finally:
        faulthandler.cancel_dump_traceback_later()


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> Generator[None, object, object]:
    with _ended(item):
        return (yield)


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None, object, object]:
    with _ended(item):
        return (yield)


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_runtest_teardown(item: pytest.Item) -> Generator[None, object, object]:
    with _ended(item):
        return (yield)


@pytest.fixture(autouse=True)
def nothing_left(request: pytest.FixtureRequest) -> Iterator[None]:
    """Check that a test with a world leaves no thread, no connection and no participant of DDS."""
    if not WORLDS.intersection(request.fixturenames):
        yield
        return
    before = Open()
    yield
    before.check_same()


@pytest.fixture
def client(physsim: PhysSim) -> Client:
    """Give a test a client of its world."""
    from .client import Client  # noqa: PLC0415 - see above

    return Client(physsim)


@pytest.fixture
def flat(physsim: PhysSim) -> PhysSim:
    """Give a world that is seen from above."""
    from .client import set_parameter  # noqa: PLC0415 - see above

    set_parameter(physsim, 'gravity', [0.0, 0.0])
    return physsim


@pytest.fixture
def start(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., PhysSim]]:
    """Give a test a function that starts a world with parameters, which ends with the test."""
    from physsim_ros.testing import own_context, PhysSim  # noqa: PLC0415 - see above

    monkeypatch.setenv('XDG_STATE_HOME', str(tmp_path))
    with ExitStack() as closing:

        def started(**parameters: Any) -> PhysSim:
            context = closing.enter_context(own_context(monkeypatch))
            world = PhysSim(context, **{'world_dir': str(tmp_path), **parameters})
            return closing.enter_context(world)

        yield started


@pytest.fixture(scope='module')
def outside(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Outside]:
    """Give a module processes of its own, on a domain of their own."""
    from physsim_ros.testing.domain import own_domain  # noqa: PLC0415 - see above

    from .outside import Outside  # noqa: PLC0415 - see above

    with own_domain() as domain, ExitStack() as closing:
        yield Outside(tmp_path_factory.mktemp('outside'), domain, closing)
