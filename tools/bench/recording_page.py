# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
How far the recording beside the page is behind, in Chromium without a graphics card.

The page says which batch it shows; a batch is as old as the frame that was the last when it was
sent, but for its encoding (some 20 ms). A picture is oldest just before the next one replaces it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
import statistics
import subprocess
import sys
import time

from physsim_ros.ros.node import PhysSimNode
from physsim_ros.testing.domain import own_domain
from physsim_ros.view import Viewer
from physsim_ros.view.sinks.page_endpoint import PageEndpoint, Send
import rclpy
from rclpy.logging import LoggingSeverity
from rclpy.parameter import Parameter

from .bodies import fill, SETTLE
from .pages import PERIOD

# Before the page is opened, and while it is watched from its first picture on [s].
LATE, WATCHED = 5.0, 20.0
# Until the first picture [s].
PATIENCE = 120.0
SIZE = (1200, 800)
# Opens the page, and keeps it open.
BROWSER = """
import sys
from playwright.sync_api import sync_playwright
from test.sketchpad.chromium import launched_chromium, SOFTWARE_GL

with sync_playwright() as playwright:
    browser = launched_chromium(playwright, SOFTWARE_GL)
    width, height = int(sys.argv[2]), int(sys.argv[3])
    page = browser.new_page(viewport={'width': width, 'height': height})
    page.goto(sys.argv[1])
    page.goto(sys.argv[1].partition('/login')[0] + '/rerun/')
    page.wait_for_timeout(1e6)
"""


class Watch:
    """
    The ages of the pictures that a page shows.

    :param node: of the world
    :param viewer: of the node, that the page has its recording from
    """

    def __init__(self, node: PhysSimNode, viewer: Viewer) -> None:
        self._node = node
        # Of pictures when they are shown, and when they are replaced [s].
        self.young: list[float] = []
        self.old: list[float] = []
        # Simulation time of the batch that was sent last, and of the one that is shown [s].
        self._sent: float | None = None
        self._shown: float | None = None
        self._open = viewer.open_page
        viewer.open_page = self._open_page  # type: ignore[method-assign]

    @property
    def _now(self) -> float:
        """Return the simulation time of the last frame [s]."""
        frame = self._node.frame
        return 0.0 if frame is None else frame.snapshot.stamp * 1e-9

    def _open_page(self, send: Send) -> PageEndpoint:
        def send_noted(batch: bytes, recorded: int) -> None:
            self._sent = self._now
            send(batch, recorded)

        page = self._open(send_noted)
        page.note_shown = partial(self._note, page.note_shown)  # type: ignore[method-assign]
        return page

    def _note(self, note_shown: Callable[[int], None], recorded: int) -> None:
        if self._shown is not None:
            self.old.append(self._now - self._shown)
        assert self._sent is not None
        self._shown = self._sent
        self.young.append(self._now - self._shown)
        note_shown(recorded)


def measure(bodies: int, *, late: float = LATE) -> None:
    """Print the row of a count of bodies."""
    values = {'viewer': 'web', 'sketchpad': 'serve', 'sketchpad_port': 0}
    node = PhysSimNode(
        parameter_overrides=[Parameter(name, value=value) for name, value in values.items()]
    )
    node.get_logger().set_level(LoggingSeverity.WARN)
    fill(node.simulation.world, bodies, settle=SETTLE)
    watch = Watch(node, node.outputs.viewer)
    browser = None
    try:
        node.start()
        begun = time.monotonic()
        end = begun + late + PATIENCE
        while (now := time.monotonic()) < end:
            node.tick(time.monotonic_ns())
            if browser is None and now > begun + late:
                assert node.outputs.sketchpad is not None
                address = node.outputs.sketchpad.url()
                browser = subprocess.Popen(
                    [sys.executable, '-c', BROWSER, address, *map(str, SIZE)]
                )
            if len(watch.young) == 1 and not watch.old:
                end = now + WATCHED
            time.sleep(max(0.0, now + PERIOD - time.monotonic()))
        median, greatest = statistics.median(watch.old), max(watch.old)
        print(
            f'{bodies:6} {late:14.0f} {statistics.median(watch.young[1:]):13.2f} {median:17.2f}'
            f' {greatest:12.2f} {len(watch.old) / WATCHED:9.1f}',
            flush=True,
        )
    finally:
        if browser is not None:
            browser.terminate()
            browser.wait()
        node.destroy_node()


def table() -> None:
    """Print how far the recording is behind."""
    with own_domain() as domain:
        rclpy.init(domain_id=domain)
        print(
            f'\nThe recording beside the page, {SIZE[0]} x {SIZE[1]} pixels, no graphics card [s]'
        )
        print('bodies  opened after  age when shown  when replaced  greatest  pictures/s')
        for bodies in (100, 1000):
            measure(bodies)
        rclpy.shutdown()
