# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The sketchpad of a world: its server, and a session for each open page.

Law: messages of pages are carried out on the world's thread, between two frames, for a bounded
time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
import time

from physsim_ros.files import DirectoryLock, OwnWorlds, text_of
from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Refusal
from physsim_ros.model.snapshot import Frame
from physsim_ros.model.translation import Text
from physsim_ros.runtime.slices import Sliced, with_checks
from physsim_ros.simulation.entries import Origin, Wait
from physsim_ros.sketchpad.autosave import Autosave
from physsim_ros.sketchpad.body_pasts import BodyPasts
from physsim_ros.sketchpad.contacts import LastContacts
from physsim_ros.sketchpad.file_work import FileWork
from physsim_ros.sketchpad.inbox import Closed, Entry, Inbox, Opened, Upload, UPLOADERS
from physsim_ros.sketchpad.locks import check_moment
from physsim_ros.sketchpad.message import answer_content, asker_key, Message
from physsim_ros.sketchpad.page_session import answers_of, PageSession, Shared
from physsim_ros.sketchpad.past_contacts import PastContacts
from physsim_ros.sketchpad.people import People
from physsim_ros.sketchpad.results import Results, results_file
from physsim_ros.sketchpad.rights import check_right, Right, Role
from physsim_ros.sketchpad.server.frame_codec import VERSION
from physsim_ros.sketchpad.server.server import Server
from physsim_ros.sketchpad.timeline import timeline_content, TimelineReport
from physsim_ros.sketchpad.world_control import open_content, WorldControl

# Time for messages of pages between two frames [s]: a quarter of a frame at 60 Hz. A stroke takes
# some 3 ms.
BUDGET = 0.004


class Sketchpad:
    """
    The sketchpad of a world.

    :param control: of the world that the pages draw in
    :param directory: of the user's worlds
    :param lessons: directory of the user's lessons
    :param address: to listen on
    :param port: to listen on, or the first free one after it
    :param wake: called on another thread when a message has come, or a file is written
    :raises PhysSimError: it cannot listen there

    :ivar name: of the output
    """

    name = 'page'

    def __init__(
        self,
        control: WorldControl,
        *,
        directory: Path,
        lessons: Path,
        address: str,
        port: int,
        wake: Callable[[], None],
    ) -> None:
        self._control = control
        self._boundary = control.boundary
        self._simulation = simulation = control.simulation
        self._inbox = Inbox(wake)
        self._timeline = TimelineReport(simulation)
        self._contacts = LastContacts(simulation.forces_now)
        self._sessions: dict[int, PageSession] = {}
        self._people = People(control, self._sessions)
        own_worlds, results = OwnWorlds(directory, lessons), results_file(directory)
        self._file_work, self._lock = FileWork(wake), DirectoryLock(directory)
        self._autosave = Autosave(
            directory, self._lock, self._file_work, self._world_text, self._people.chosen_names
        )
        try:
            self._server = Server(
                address=address,
                port=port,
                own_worlds=own_worlds,
                autosave=self._autosave,
                results=results,
                inbox=self._inbox,
                boundary=self._boundary,
            )
        except Exception:
            # A server that cannot listen leaves the directory to the next one.
            self._lock.release()
            raise
        self._shared = Shared(
            control=control,
            send=self._server.send,
            pasts=BodyPasts(simulation, self._server.send),
            past_contacts=PastContacts(simulation, self._server.send),
            own_worlds=own_worlds,
            autosave=self._autosave,
            results=Results(results, self._lock),
            file_work=self._file_work,
            list_worlds=self._server.list_worlds,
            ask_to_leave=self._server.ask_to_leave,
        )
        # The last one; None before the first.
        self._frame: Frame | None = None
        self._sent_recording = control.recording_address
        if self.autosave_failure is not None:
            simulation.requests.tell(self.autosave_failure)

    def url(self, role: Role = Role.DRAW) -> str:
        """Return the address of a page with its token."""
        return self._server.url(role)

    @property
    def is_read(self) -> bool:
        """Whether a page is open."""
        return bool(self._sessions)

    @property
    def autosave_failure(self) -> Answer | None:
        """Return the event that what was drawn could not be saved; None where it is saved."""
        return self._autosave.failure

    @property
    def wants_contacts(self) -> bool:
        """Whether a page shows contacts, or follows bodies."""
        return self._server.wants_contacts or any(
            session.followed for session in self._sessions.values()
        )

    def handle_messages(self) -> None:
        """Carry out messages of pages for a bounded time, between the periodic work and sends."""
        now = time.monotonic()
        with self._boundary.containing('page'):
            self._simulation.applier.continue_calls()
            self._keep_hands(now)
            self._send_pasts(now)
            with self._boundary.containing('autosave'):
                self._save_if_due(now)
            self._send_recording_address()
        self._handle_until(now + BUDGET)
        with self._boundary.containing('page'):
            if (people := self._people.take_list()) is not None:
                self._server.send(people)

    def _handle_until(self, end: float) -> None:
        """Carry out messages until a steady time [s]."""
        while (entry := self._inbox.take()) is not None:
            with self._boundary.containing('page'):
                self._handle(*entry)
            if time.monotonic() > end:
                return

    def _handle(self, page: int, entry: Entry) -> None:
        match entry:
            case Opened():
                self._open(page, entry)
            case Closed():
                if (session := self._sessions.pop(page, None)) is not None:
                    session.close()
            case Upload():
                self._replace_world(entry)
            case Message():
                self._sessions[page].handle(entry)

    def show(self, frame: Frame) -> None:
        """Send a frame, its answers and the timeline to all pages; never blocks."""
        self._frame = frame = self._contacts.completed(frame)
        self._autosave.note_frame(frame, drawn=bool(self._sessions))
        if not self._sessions:
            # The server's thread sleeps until a page is opened.
            return
        status = self._timeline.take_status(frame, time.monotonic())
        for session in self._sessions.values():
            session.tell_touches(frame)
        self._server.show(
            frame,
            self._timeline.ghost(frame.snapshot),
            timeline_content(status) if status is not None else None,
        )

    def report(self, answers: tuple[Answer, ...]) -> None:
        """Send answers that no frame carries."""
        self._server.answer(answers)

    def close(self) -> None:
        """Close all pages, end the server's thread, and release the lock after the last file."""
        self._server.close()
        self._file_work.submit(self._lock.release)

    def _keep_hands(self, now: float) -> None:
        for session in self._sessions.values():
            session.keep_hand(now)

    def _send_pasts(self, now: float) -> None:
        self._shared.pasts.send_due(now)
        self._shared.past_contacts.send_due()

    def _save_if_due(self, now: float) -> None:
        """Tell how the last autosave has ended, and begin the next one where it is due."""
        if (event := self._autosave.note_end()) is not None:
            self._simulation.requests.tell(event)
        if self._autosave.is_due(now) and self._simulation.playback.is_there:
            self._autosave.save()

    def _send_recording_address(self) -> None:
        """Tell all pages the address of the viewer, if it changed."""
        if self._control.recording_address != self._sent_recording:
            self._sent_recording = self._control.recording_address
            self._server.send({'type': 'recording', 'rerun': self._sent_recording})

    def _world_text(self) -> Callable[[int], str]:
        """Return a function that returns the world as text, of at most a length [characters]."""
        saved, rate = self._simulation.world.saver(), self._simulation.physics_rate
        return lambda longest: text_of(saved(), rate, longest=longest)

    def _replace_world(self, upload: Upload) -> None:
        """Replace the world by an uploaded one, and tell the answer to the uploader too."""
        origin = Origin('~/load_world', asker=asker_key(UPLOADERS, ''))
        simulation = self._simulation

        async def answers() -> tuple[Answer]:
            load: Sliced[Text] = partial(open_content, simulation, upload.content)
            check = partial(check_moment, upload.role, self._control)
            call = partial(with_checks, load, check)
            (answer,) = await answers_of(origin, call, self._boundary)
            upload.reply(answer)
            return (answer,)

        try:
            with self._boundary.message(origin.topic):
                frozen = self._control.values['sketchpad_frozen']
                check_right(Right.CHANGE, upload.role, frozen=frozen)
                self._control.loop.make_call(answers, Wait.FOR_SEEK)
        except Refusal as refusal:
            upload.reply(Answer.refused(refusal, topic=origin.topic))
            simulation.requests.refuse(refusal, origin)

    def _open(self, number: int, opened: Opened) -> None:
        """Begin the session of a page, and welcome it."""
        role = opened.role
        person = self._people.person_at(opened)
        self._sessions[number] = PageSession(number, opened, person, self._shared)
        simulation, settings = self._simulation, self._simulation.settings
        drawing = self._control.drawing_settings
        self._server.send(
            {
                'type': 'welcome',
                'client': str(number),
                'person': opened.key,
                'received': opened.received,
                'version': VERSION,
                'physics_rate': simulation.physics_rate,
                'frame_id': self._control.values['frame_id'],
                'rate': self._control.values['publish_rate'],
                'rerun': self._control.recording_address,
                'view_only': not role.draws,
                'teacher': role is Role.TEACH,
                'unsaved': self._autosave.unsaved_at if role.draws else 0.0,
                'unsaved_by': self._autosave.unsaved_by if role.draws else [],
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
            number,
        )
        # To all: what is not sent again is what all pages have got.
        self._server.send(timeline_content(self._timeline.status_to_send(time.monotonic())))
        self._server.list_worlds(number)
        if (failure := self.autosave_failure) is not None:
            self._server.send(answer_content(failure, ''), number)
        if self._frame is not None:
            frame = replace(self._frame, answers=())
            self._server.show(frame, self._timeline.ghost(frame.snapshot))
        self._people.forget_taken()
