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

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from physsim_ros.testing import own_context, PhysSim
import pytest

from .browser import Browser
from .chromium import launched_chromium, started_world
from ..outside import Outside


@pytest.fixture
def browser(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Browser]:
    """Give clients of the page of a world, whose time the test advances."""
    monkeypatch.setenv('XDG_STATE_HOME', str(tmp_path))
    values = {'world_dir': str(tmp_path), 'sketchpad': 'serve', 'sketchpad_port': 0}
    with own_context(monkeypatch) as context, PhysSim(context, **values) as physsim:
        browser = Browser(physsim)
        yield browser
        browser.close()


@pytest.fixture(scope='module')
def chromium() -> Iterator[Any]:
    """Give a module one browser."""
    sync_api = pytest.importorskip('playwright.sync_api', reason='playwright is not installed')
    with sync_api.sync_playwright() as playwright:
        browser = launched_chromium(playwright)
        yield browser
        browser.close()


@pytest.fixture(scope='module')
def address(outside: Outside) -> str:
    """Give a module the address of one world."""
    return started_world(outside)[1]
