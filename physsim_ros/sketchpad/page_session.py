# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The session of one page, on the world's thread: its person and hand, and its requests.

Law: a session changes nothing itself; it submits requests, and every message has an answer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache, partial
import time
from typing import Any, NamedTuple

from physsim_ros.drawing import submit_told
from physsim_ros.files import OwnWorlds
from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Busy, Frozen, PhysSimError, Refusal
from physsim_ros.model.preview import NO_PREVIEW, Preview
from physsim_ros.model.requests import HandRequest, KeepHand, LetGo, Request
from physsim_ros.model.snapshot import Frame
from physsim_ros.model.translation import NOTHING, Text, verbatim
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.runtime.slices import in_slices, Sliced
from physsim_ros.simulation.entries import Origin, Wait
from physsim_ros.sketchpad.autosave import Autosave
from physsim_ros.sketchpad.body_pasts import BodyPasts
from physsim_ros.sketchpad.contacts import touches_content
from physsim_ros.sketchpad.file_work import FileWork
from physsim_ros.sketchpad.inbox import Opened
from physsim_ros.sketchpad.locks import check_locked, check_locked_in_turn, check_unchanged
from physsim_ros.sketchpad.message import answer_content, asker_key, Content, Message, request_of
from physsim_ros.sketchpad.past_contacts import PastContacts
from physsim_ros.sketchpad.person import author_of, Person
from physsim_ros.sketchpad.results import Results
from physsim_ros.sketchpad.rights import check_right, Right
from physsim_ros.sketchpad.world_control import WorldControl

# Time from one request of a resting hand to the next [s]; a hand without requests lets go after
# 5 s.
HAND_PERIOD = 2.0


class Shared(NamedTuple):
    """
    What all pages of a world share.

    :ivar control: of the world that they draw in
    :ivar send: sends a message to the page of a number, or to all
    :ivar pasts: of bodies that pages plot
    :ivar past_contacts: contacts of the past that pages ask for
    :ivar own_worlds: of the user
    :ivar autosave: of the world
    :ivar results: of lessons in the world
    :ivar file_work: that messages ask for
    :ivar list_worlds: sends the list of worlds to the page of a number, or to all
    :ivar ask_to_leave: asks the pupils who have come until now to leave
    """

    control: WorldControl
    send: Callable[[Content, int | None], None]
    pasts: BodyPasts
    past_contacts: PastContacts
    own_worlds: OwnWorlds
    autosave: Autosave
    results: Results
    file_work: FileWork
    list_worlds: Callable[[int | None], None]
    ask_to_leave: Callable[[], None]


class PageSession:
    """
    The session of one page.

    :param number: of the page
    :param opened: who is at it, with which rights
    :param person: at it
    :param shared: with other pages

    :ivar control: of the world that it draws in
    :ivar role: its rights
    :ivar watches: whether a teacher watches a class with it, and is nobody in this world
    :ivar hand: name of its hand in the world
    :ivar driven: name of the robot that it drives, '' is none; and the gesture of that
    :ivar followed: names of the bodies whose touches it is told of
    """

    def __init__(self, number: int, opened: Opened, person: Person, shared: Shared) -> None:
        self.number = number
        self.person = person
        self.shared = shared
        self.control = shared.control
        self.role = opened.role
        self.watches = opened.watches
        self.hand = f'page {number}'
        self.driven = '', 0
        self.followed: frozenset[str] = frozenset()
        self._preview: Preview = NO_PREVIEW
        # Steady time of the last request of the hand [s]; None while it holds nothing.
        self._hand_used: float | None = None

    def handle(self, message: Message) -> None:
        """Carry out a message."""
        self.person.drawing.settings = self.control.drawing_settings
        kind = message.kind
        asker = asker_key(self.number, message.request)
        origin = Origin(kind.topic, asker=asker, author=author_of(self.person.name, self.role))
        if kind.right is Right.CHANGE:
            locked = self.control.locked_bodies
            check = partial(check_unchanged, self.role, locked, self.control)
            origin = origin._replace(check=check)
        try:
            with self.control.boundary.message(kind.topic):
                check_right(kind.right, self.role, frozen=self.control.values['sketchpad_frozen'])
                kind.handle(self, origin, **message.arguments)
        except Refusal as refusal:
            self.refuse(origin, refusal)
        self._send_preview()

    def keep_hand(self, now: float) -> None:
        """
        Keep the grip of a resting hand while the page is open, and its body not locked.

        :param now: steady time [s]
        """
        if self._hand_used is None or now - self._hand_used <= HAND_PERIOD:
            return
        keep = KeepHand(hand=self.hand)
        try:
            check_locked(self.role, (keep,), self.control)
        except Frozen:
            self._hand_used = None
            self._submit_unasked(LetGo(hand=self.hand))
        else:
            self._hand_used = now
            self._submit_unasked(keep)

    def tell_touches(self, frame: Frame) -> None:
        """Tell the page which of the bodies that it follows were touched in a frame, and when."""
        if self.followed:
            rate = self.control.simulation.physics_rate
            content = touches_content(frame.snapshot, frame.contacts, self.followed, rate)
            if content is not None:
                self.send(content)

    def close(self) -> None:
        """Let go with the hand of the page, and forget the pasts that it has asked for."""
        self.shared.pasts.forget(self.number)
        self.shared.past_contacts.forget(self.number)
        if self._hand_used is not None:
            self._submit_unasked(LetGo(hand=self.hand))

    # Requests

    def submit(
        self,
        origin: Origin,
        requests: Iterable[Request],
        *,
        message: Text = NOTHING,
        gesture: int | None = None,
    ) -> int:
        """
        Submit requests that are undone together, and return the number of their gesture.

        :param message: that is answered first; '' is none
        :param gesture: number of an earlier gesture that they are in, too
        :raises Frozen: one of them concerns a locked body; none is submitted
        """
        requests = tuple(requests)
        check_locked(self.role, requests, self.control)
        simulation, origin = self.control.simulation, self.checked_in_turn(origin, requests)
        return submit_told(simulation, requests, origin, message=message, gesture=gesture)

    def use_hand(self, origin: Origin, request: HandRequest) -> None:
        """
        Submit a request of the page's hand.

        :raises Frozen: it grabs a locked body
        """
        check_locked(self.role, (request,), self.control)
        origin = self.checked_in_turn(origin, (request,))
        self.control.simulation.requests.submit(request, origin)
        self._hand_used = None if isinstance(request, LetGo) else time.monotonic()

    def checked_in_turn(self, origin: Origin, requests: Sequence[Request]) -> Origin:
        """Have locks be checked again in the turn of the first of requests, for all of them."""

        @cache
        def refusal() -> Refusal | None:
            try:
                check_locked_in_turn(self.role, requests, self.control)
            except Refusal as refusal:
                return refusal
            return None

        def check() -> None:
            origin.check()
            if (found := refusal()) is not None:
                raise found

        return origin._replace(check=check)

    # Answers

    def send(self, content: Content) -> None:
        """Send the page a message."""
        self.shared.send(content, self.number)

    def send_all(self, content: Content) -> None:
        """Send all pages a message."""
        self.shared.send(content, None)

    def refuse(self, origin: Origin, refusal: Refusal) -> None:
        """Queue the refusal of a message."""
        self.control.simulation.requests.refuse(refusal, origin)

    def answer_page(self, origin: Origin, message: Text, **details: Any) -> None:
        """
        Answer this page alone and at once: the answer concerns no other page.

        :param details: other fields of the answer
        """
        answer = Answer(topic='page', message=message, **details)
        self.send(answer_content(answer, request_of(origin)))

    def answer_from_thread(self, origin: Origin, work: Callable[[], Text]) -> None:
        """
        Have a thread do what a slow disk delays, and answer this page alone.

        :param work: returns the message of the answer; raises a Refusal
        """

        async def answer() -> tuple[Answer, ...]:
            done = self.shared.file_work.do(work)
            try:
                message = await self.control.boundary.slices_of_message(origin.topic, done)
            except Refusal as refusal:
                self.refuse(origin, refusal)
            else:
                self.answer_page(origin, message)
            return ()

        self.call(origin, answer, Wait.NONE)

    def perform(self, origin: Origin, action: Sliced[Text], wait: Wait = Wait.NONE) -> None:
        """
        Perform an action at its time, and queue its answer.

        :param action: returns a message about it; raises a PhysSimError where it is refused
        :param wait: time of the action
        """
        boundary = self.control.boundary
        self.call(origin, partial(answers_of, origin, action, boundary), wait)

    def call(self, origin: Origin, call: Sliced[Sequence[Answer]], wait: Wait) -> None:
        """Make a call at its time, or refuse it where too many wait."""
        try:
            self.control.loop.make_call(call, wait, origin=origin)
        except Busy as refusal:
            self.refuse(origin, refusal)

    def _submit_unasked(self, request: HandRequest) -> None:
        """Submit a request of the hand that no message asks for."""
        self.control.simulation.requests.submit(request, topic='~/drag/feedback')

    def _send_preview(self) -> None:
        """Send the page its unfinished gesture, if that has changed."""
        preview = self.person.drawing.preview
        if preview == self._preview:
            return
        self._preview = preview
        lines = [*preview.lines, *([preview.points] if preview.points else [])]
        self.send({'type': 'preview', 'lines': lines, 'label': preview.label})


async def answers_of(
    origin: Origin, action: Sliced[Text], boundary: ErrorBoundary
) -> tuple[Answer]:
    """Perform an action; return the one answer, with its message or with its refusal."""
    topic, asker = origin.topic, origin.asker
    try:
        message = await boundary.slices_of_message(topic, in_slices(action))
    except Refusal as refusal:
        return (Answer.refused(refusal, topic=topic, asker=asker),)
    except PhysSimError as error:
        return (Answer(topic=topic, message=verbatim(str(error)), code='refused', asker=asker),)
    return (Answer(topic=topic, message=message, asker=asker),)
