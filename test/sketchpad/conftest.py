# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

from collections.abc import Callable, Generator, Iterator
from contextlib import closing, ExitStack
from typing import Any

from physsim_ros.sketchpad.server import server, website
from physsim_ros.testing import PhysSim
import pytest
import yaml

from .browser import Browser
from .chromium import launched_chromium, OpenSheet, Sheet, started_world, WORLD
from ..outside import Outside, PATIENCE


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    call: pytest.CallInfo[None],
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Add the states of its pages to the report of a test that failed, and close them."""
    report = yield
    if call.when != 'teardown' and report.failed:
        for sheet in Sheet.opened:
            report.sections.append(('page', sheet.state()))
            # The next test would share the world with it.
            sheet.context.close()
    if call.when != 'setup' or report.failed:
        Sheet.opened.clear()
    return report


@pytest.fixture(autouse=True)
def patient_server(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have servers in this process wait for pages that a busy machine stops, or a test itself."""
    monkeypatch.setattr(server, 'PING_PERIOD', PATIENCE)
    for name in ('idle_connection_timeout', 'body_timeout'):
        monkeypatch.setitem(website.LIMITS, name, PATIENCE)


@pytest.fixture
def browse(start: Callable[..., PhysSim]) -> Iterator[Callable[..., Browser]]:
    """Give a function that starts a world with parameters, and gives clients of its page."""
    with ExitStack() as ending:

        def started(**parameters: Any) -> Browser:
            world = start(sketchpad='serve', sketchpad_port=0, **parameters)
            return ending.enter_context(closing(Browser(world)))

        yield started


@pytest.fixture
def browser(browse: Callable[..., Browser]) -> Browser:
    """Give clients of the page of a world, whose time the test advances."""
    return browse()


@pytest.fixture(scope='module')
def chromium() -> Iterator[Any]:
    """Give a module one browser."""
    sync_api = pytest.importorskip('playwright.sync_api', reason='playwright is not installed')
    with sync_api.sync_playwright() as playwright:
        browser = launched_chromium(playwright)
        yield browser
        browser.close()


@pytest.fixture(scope='module')
def address(outside: Outside, request: pytest.FixtureRequest) -> str:
    """Give a module the address of one world: that of its `WORLD`, if it has one."""
    return started_world(outside, world=getattr(request.module, 'WORLD', WORLD))[1]


@pytest.fixture
def open_sheet(chromium: Any, request: pytest.FixtureRequest) -> Iterator[OpenSheet]:
    """Give a test a function that opens pages, by default of the world of its module."""
    sheets: list[Sheet] = []

    def opened(address: str = '', **options: Any) -> Sheet:
        address = address or request.getfixturevalue('address')
        sheets.append(Sheet(chromium, address, **options))
        return sheets[-1]

    yield opened
    for sheet in sheets:
        sheet.close()


@pytest.fixture
def sheet(open_sheet: OpenSheet, request: pytest.FixtureRequest) -> Sheet:
    """Give a test a page, and the world of its module from its beginning, paused."""
    world = yaml.safe_load(getattr(request.module, 'WORLD', WORLD))
    return open_sheet().begin(len(world['bodies']))
