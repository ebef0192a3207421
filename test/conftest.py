# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
