# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fixtures of the tests over ROS, imported late: the core's tests run where there is no ROS."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from physsim_ros.testing import PhysSim

    from .client import Client
    from .outside import Outside


@pytest.fixture
def client(physsim: PhysSim) -> Client:
    """Give a test a client of its world."""
    from .client import Client  # noqa: PLC0415 - see above

    return Client(physsim)


@pytest.fixture(scope='module')
def outside(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Outside]:
    """Give a module processes of its own, on a domain of their own."""
    from .outside import Outside, own_domain  # noqa: PLC0415 - see above

    with own_domain() as domain, ExitStack() as closing:
        yield Outside(tmp_path_factory.mktemp('outside'), domain, closing)
