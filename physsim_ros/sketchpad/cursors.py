# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The cursors of people, from each page to all, on the server's thread; no world knows of them.

Law: a period has one message for a page, whatever the number of pages that move.
"""

from __future__ import annotations

from asyncio import AbstractEventLoop

from physsim_ros.model.transform import Point
from physsim_ros.sketchpad.open_pages import OpenPages
from physsim_ros.sketchpad.scene_codec import compact

# Time in which moves are collected [s].
PERIOD = 0.1


class Cursors:
    """
    Cursors that have moved.

    :param loop: of the server's thread
    :param pages: that are open
    """

    def __init__(self, loop: AbstractEventLoop, pages: OpenPages) -> None:
        self._loop = loop
        self._pages = pages
        self._moved: dict[int, Point] = {}

    def move(self, page: int, point: Point) -> None:
        """
        Note a move, and send it after a while.

        :param page: number of the page
        :param point: of the world [m]
        """
        if not self._moved:
            self._loop.call_later(PERIOD, self._send)
        self._moved[page] = point

    def _send(self) -> None:
        moved, self._moved = self._moved, {}
        cursors = [[page, *point] for page, point in moved.items()]
        self._pages.send(compact({'type': 'cursors', 'cursors': cursors}))
