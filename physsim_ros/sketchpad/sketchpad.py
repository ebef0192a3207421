# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The sketchpad of a world: its server, and a session for each open page.

Law: the world's thread decides; it handles the messages of pages between two frames, for a bounded
time.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
import time
from typing import Any

from physsim_ros.files import OwnWorlds
from physsim_ros.model.errors import Busy
from physsim_ros.model.snapshot import Answer, Frame
from physsim_ros.simulation.deferred_calls import Wait
from physsim_ros.sketchpad.access import Role
from physsim_ros.sketchpad.autosave import Autosave
from physsim_ros.sketchpad.body_past import BodyPasts
from physsim_ros.sketchpad.frame_codec import VERSION
from physsim_ros.sketchpad.inbox import Closed, Inbox, Incoming, Opened, SERVER
from physsim_ros.sketchpad.last_contacts import LastContacts
from physsim_ros.sketchpad.page_requests import Content
from physsim_ros.sketchpad.page_session import PageSession
from physsim_ros.sketchpad.recording_handlers import Recordings
from physsim_ros.sketchpad.server import Server
from physsim_ros.sketchpad.timeline_report import timeline_content, TimelineReport
from physsim_ros.sketchpad.world_control import WorldControl

# Time for messages of pages between two frames [s]: a quarter of a frame at 60 Hz. A stroke takes
# some 3 ms.
BUDGET = 0.004


class Sketchpad:
    """
    The sketchpad of a world.

    :param world: that the pages draw in
    :param welcome: what a page is told first: frame, rate
    :param address: to listen on
    :param port: to listen on, or the first free one after it
    :param world_dir: directory of the user's worlds
    :param recordings: the viewer
    :param wake: called on the server's thread when a message has come
    :raises PhysSimError: it cannot listen there
    """

    def __init__(
        self,
        world: WorldControl,
        *,
        welcome: dict[str, Any],
        address: str,
        port: int,
        world_dir: Path,
        recordings: Recordings,
        wake: Callable[[], None],
    ) -> None:
        self._world = world
        self._welcome = welcome
        self._recordings = recordings
        self._inbox = Inbox()
        self._timeline = TimelineReport(world.simulation)
        self._contacts = LastContacts()
        self._own_worlds = OwnWorlds(world_dir)
        self._autosave = Autosave(world_dir, lambda longest: world.world_text(longest=longest))
        self._server = Server(
            address=address,
            port=port,
            world_dir=world_dir,
            autosave=self._autosave,
            recordings=recordings,
            inbox=self._inbox,
            wake=wake,
        )
        self._pasts = BodyPasts(world.simulation, self._server.send)
        self._sessions: dict[int, PageSession] = {}
        self._server_session = self._session(SERVER)
        self._told_recording = self._recording_path()

    def url(self, role: Role = Role.DRAW) -> str:
        """Return the address of a page with its token."""
        return self._server.url(role)

    @property
    def wants_contacts(self) -> bool:
        """Whether a page shows contacts."""
        return self._server.pages.wants_contacts

    def handle_messages(self) -> None:
        """Handle the messages of pages, as many as there is time for."""
        if self._recording_path() != self._told_recording:
            self._told_recording = self._recording_path()
            self._server.send({'type': 'recording', 'rerun': self._told_recording})
        now = time.monotonic()
        for session in self._sessions.values():
            session.keep_hand(now)
        self._pasts.send_due(now)
        if self._autosave.is_due(now):
            self._save_unsaved()
        deadline = now + BUDGET
        while (incoming := self._inbox.take()) is not None:
            self._handle(incoming)
            if time.monotonic() > deadline:
                return

    def show(self, frame: Frame) -> None:
        """Send a frame, its answers and the timeline to all pages; never blocks."""
        frame = self._contacts.completed(frame)
        self._autosave.note_frame(frame, drawn=bool(self._sessions))
        if not self._server.has_pages:
            # The first page to come gets this frame.
            self._server.keep(frame)
            return
        status = self._timeline.take_status(frame, time.monotonic())
        self._server.show(frame, self._timeline.ghost(frame.snapshot))
        if status is not None:
            self._server.send(timeline_content(status))

    def report(self, answers: tuple[Answer, ...]) -> None:
        """Send answers that no frame carries."""
        self._server.answer(answers)

    def close(self) -> None:
        """Close all pages, and end the server's thread."""
        self._server.close()

    def _handle(self, incoming: Incoming) -> None:
        number, request_id, message = incoming
        match message:
            case Opened(role=role):
                self._open(number, role)
            case Closed():
                session = self._sessions.pop(number, None)
                if session is not None:
                    session.close()
            case _:
                session = self._server_session if number == SERVER else self._sessions.get(number)
                if session is not None:
                    session.handle(message, request_id)

    def _save_unsaved(self) -> None:
        def save() -> list[Answer]:
            self._autosave.save()
            return []

        # Where too many requests wait, it comes later.
        with suppress(Busy):
            self._world.submit_call(save, Wait.FOR_SEEK)

    def _open(self, number: int, role: Role) -> None:
        self._sessions[number] = self._session(number)
        settings = self._world.simulation.settings
        drawing = self._world.drawing_settings
        self._server.send(
            {
                'type': 'welcome',
                'client': str(number),
                'version': VERSION,
                'physics_rate': self._world.simulation.physics_rate,
                **self._welcome,
                'rerun': self._recording_path(),
                'view_only': role is not Role.DRAW,
                'unsaved': self._autosave.unsaved_at if role is Role.DRAW else 0.0,
                'settings': {
                    'density': settings.density,
                    'friction': settings.friction,
                    'elasticity': settings.elasticity,
                    'gravity': settings.gravity,
                    'draw_velocity': drawing.draw_velocity,
                    'draw_color': drawing.draw_color,
                    'snap': drawing.snap,
                },
            },
            page=number,
        )
        self._server.send(timeline_content(self._world.simulation.status), page=number)

    def _recording_path(self) -> str:
        """Return where the recording is shown; '' where no viewer serves browsers."""
        return '/rerun/' if self._recordings.page_address else ''

    def _session(self, number: int) -> PageSession:
        def send(content: Content) -> None:
            self._server.send(content, page=number)

        return PageSession(
            self._world,
            page=number,
            send=send,
            pasts=self._pasts,
            own_worlds=self._own_worlds,
            autosave=self._autosave,
            list_worlds=self._server.list_worlds,
        )
