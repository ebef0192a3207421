# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The newest frame on its way to the pages, on the server's thread.

Laws: a frame is encoded once for all pages that show the same parts; a page gets the newest frame
only, after its scene, and no frame while it is busy.
"""

from __future__ import annotations

from asyncio import AbstractEventLoop
from dataclasses import replace
import time

from physsim_ros.appearance import LaserScans
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.sensing import read_battery
from physsim_ros.sketchpad.server.frame_codec import encode_frame, Show
from physsim_ros.sketchpad.server.open_pages import OpenPage, OpenPages
from physsim_ros.sketchpad.server.scene_codec import compact, SceneCodec
from tornado.websocket import WebSocketHandler

# Rate of new scenes for all pages together [bytes/s]. Where bodies come and go in each frame, a
# scene of many bodies is sent less often than the frames are due.
SCENE_RATE = 20e6
# The message of the end of a ghost.
NO_GHOST = compact({'type': 'ghost', 'epoch': 0, 'bodies': []})


class FrameFeed:
    """
    The newest frame, and its parts that are encoded already.

    :param loop: of the server's thread

    :ivar pages: that are open
    :ivar newest: frame, and ghost beside it
    """

    def __init__(self, loop: AbstractEventLoop) -> None:
        self.pages = OpenPages(loop)
        self._loop = loop
        self.newest: tuple[Frame, Snapshot | None] | None = None
        self._codec = SceneCodec()
        self._frame: Frame | None = None
        self._number = 0
        # By the parts that a page shows, and the robot.
        self._encoded: dict[tuple[Show, str], bytes] = {}
        self._scene_text = ''
        self._lasers = LaserScans()
        self._ghost_codec = SceneCodec()
        self._ghost_text = ''
        self._ghost_frame = b''
        self._scene_due = 0.0

    def add_page(self, socket: WebSocketHandler, person: int | None) -> OpenPage:
        """
        Begin to send frames to the page of a socket, from the next one on.

        :param person: number of the person at it; None for a new one
        """
        page = self.pages.add(socket, person, self.update_page)
        # The newest may be old: while no page was open, no frame has come.
        page.frame = self._number
        return page

    def show_parts(self, page: OpenPage, show: Show, robot: str) -> None:
        """
        Send a page the newest frame again, and later ones, with other parts.

        :param robot: name of that whose laser is shown; '' is none
        """
        page.show, page.robot = show, robot
        self._read_lasers()
        self.pages.note_parts()
        page.frame = 0
        self.update_page(page)

    def send_frame(self) -> None:
        """Send the newest frame to the pages that are not busy; the others get it later."""
        if not len(self.pages) or self.newest is None or self.newest[0] is self._frame:
            return
        frame, ghost = self.newest
        if frame.snapshot.scene is not self._codec.scene:
            wait = self._scene_due - time.monotonic()
            if wait > 0.0:
                # Other frames may come until then; the newest is sent.
                self._loop.call_later(wait, self.send_frame)
                return
            self._scene_text = self._codec.encode(frame.snapshot.scene)
            cost = len(self._scene_text) * len(self.pages) / SCENE_RATE
            self._scene_due = time.monotonic() + cost
        self._frame = frame
        self._number += 1
        self._encoded.clear()
        self._encode_ghost(frame, ghost)
        self._read_lasers()
        for page in self.pages:
            self.update_page(page)

    def _send_battery(self, page: OpenPage, snapshot: Snapshot) -> None:
        """Tell a page the charge of its robot, where it has a battery and that has changed."""
        row = snapshot.scene.row_of.get(page.robot, -1)
        battery = None if row < 0 else read_battery(snapshot, row)
        if battery is None:
            return
        level, current = round(battery.level, 3), round(battery.current, 3)
        told = {'type': 'battery', 'name': page.robot, 'level': level, 'current': current}
        if told != page.battery:
            page.battery = told
            page.send_part(compact(told))

    def _read_lasers(self) -> None:
        """Read the lasers that pages show."""
        if self._frame is not None:
            robots = {page.robot for page in self.pages if page.robot}
            self._lasers.read(self._frame.snapshot, robots)

    def _encode_ghost(self, frame: Frame, ghost: Snapshot | None) -> None:
        if ghost is None:
            self._ghost_frame = b''
            return
        codec = self._ghost_codec
        if ghost.scene is not codec.scene:
            self._ghost_text = codec.encode(ghost.scene, kind='ghost')
        shown = replace(frame, snapshot=ghost, contacts=None, answers=())
        self._ghost_frame = encode_frame(shown, epoch=codec.epoch, show=Show.GHOST)

    def update_page(self, page: OpenPage) -> None:
        """Send the newest frame, and its scene, to a page that has not got it and is not busy."""
        if page.is_busy or self._frame is None or page.frame == self._number:
            return
        now = time.monotonic()
        if page.period:
            if now < page.due:
                # A frame that no other follows is sent then.
                self._loop.call_later(page.due - now, self.update_page, page)
                return
            page.due = now + page.period
        if page.epoch != self._codec.epoch:
            page.epoch = self._codec.epoch
            page.send_part(self._scene_text)
        page.frame = self._number
        parts = page.show, page.robot
        if parts not in self._encoded:
            self._encoded[parts] = encode_frame(
                self._frame,
                epoch=self._codec.epoch,
                show=page.show,
                scan=self._lasers.points(page.robot),
            )
        page.send_part(self._encoded[parts])
        self._send_battery(page, self._frame.snapshot)
        if self._ghost_frame:
            if page.ghost_epoch != self._ghost_codec.epoch:
                page.ghost_epoch = self._ghost_codec.epoch
                page.send_part(self._ghost_text)
            page.send_part(self._ghost_frame)
        elif page.ghost_epoch:
            page.ghost_epoch = 0
            page.send_part(NO_GHOST)
