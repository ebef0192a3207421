# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The applier takes entries from the queue of requests, and applies them at the moment that is shown.

Laws: entries are applied in the order of their arrival, and each is answered once, but moves of
hands and drives only if refused. A seek, or a call that sends the world elsewhere, is answered
when the moment is reached, or when the world is sent elsewhere before. An entry waits for the end

- of a seek, if it is a request that reads or changes the world;
- of an amendment, unless it is an answer;
- of a call in slices; if that has read the world and only writes, other calls alone wait.

`docs/architecture.md` has a table of all that applies requests, moves the cursor or makes frames.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial

from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import (
    CommandMotors,
    DriveRobot,
    HandRequest,
    KeepHand,
    MoveHand,
    Request,
)
from physsim_ros.model.translation import NOTHING, Text
from physsim_ros.runtime.slices import Sliced
from physsim_ros.simulation.arrival import Arrival
from physsim_ros.simulation.calls_under_way import CallsUnderWay
from physsim_ros.simulation.drives import Drives
from physsim_ros.simulation.entries import (
    Amend,
    Call,
    Entry,
    Origin,
    Seek,
    TakeBack,
    UNKNOWN,
    Unread,
    Wait,
)
from physsim_ros.simulation.hands import Hands
from physsim_ros.simulation.past import amend, Past, take_back
from physsim_ros.simulation.playback import Playback
from physsim_ros.simulation.request_queue import RequestQueue


class Applier:
    """
    Applies entries at the moment that is shown, and collects their answers.

    :param queue: of the entries
    :param past: of the world
    :param playback: the moment that is shown

    :ivar hands: that drag bodies
    :ivar drives: by which robots drive on
    """

    def __init__(self, queue: RequestQueue, past: Past, playback: Playback) -> None:
        self.hands = Hands(past, playback)
        self.drives = Drives(past, playback)
        # Those that wait for the next frame.
        self._answers: list[Answer] = []
        self._queue = queue
        self._past = past
        self._playback = playback
        self._is_applying = False
        # Gesture of the last request that was applied.
        self._applied = 0
        self._arrival = Arrival(playback)
        # Whether the last call has sent the world elsewhere.
        self._has_jumped = False
        self._calls = CallsUnderWay(self._end_call)

    @property
    def has_requests(self) -> bool:
        """Return whether an entry waits that is applied to the world."""
        return any(each.is_for_world for each in self._queue)

    @property
    def is_in_gesture(self) -> bool:
        """
        Return whether the next request belongs to the gesture of the last one that was applied.

        Commands of robots join a gesture for an undo alone.
        """
        following = next((each for each in self._queue if each.is_for_world), None)
        if following is None or isinstance(following.request, DriveRobot | CommandMotors):
            return False
        return following.gesture == self._applied

    @property
    def is_busy(self) -> bool:
        """Return whether requests or calls wait, or a call is under way for which they wait."""
        return self._calls.hold_requests or not all(each.is_answer for each in self._queue)

    # Entries

    def apply_ready(self, is_spent: Callable[[], bool] = lambda: False) -> bool:
        """
        Apply the entries up to the first one that has to wait, as for the end of a seek.

        :param is_spent: whether there is no time for a further entry, or slice of a call; asked
            after each
        :return: whether the world may be read now: it is at the moment that is shown, and has all
            requests
        """
        for entry in self._take(is_spent):
            try:
                if not entry.is_answer:
                    entry.origin.check()
                self._apply_entry(entry)
            except Refusal as refusal:
                self._answer(refusal, entry)
                if isinstance(entry.request, Call):
                    entry.request.on_told()
        return self._playback.is_there and not self.is_busy

    def apply_all(self) -> None:
        """Apply all entries, and finish the seeks, calls and amendments that they wait for."""
        if self._queue:
            self.apply_ready()
        while (self._queue or self._calls.hold_requests) and not self._is_applying:
            self._calls.wait_for_any()
            self._playback.arrive()
            self.apply_ready()
        self._past.cursor.finish_amendment()
        self.tell_arrival()

    def _take(self, is_spent: Callable[[], bool]) -> Iterator[Entry]:
        """
        Remove and yield the entries that need not wait.

        A call among them that has entries applied, too, finds none: they come after it.
        """
        if self._is_applying:
            return
        self._is_applying = True
        try:
            while self._calls.go_on():
                if is_spent():
                    return
            while (first := self._queue.first) and self._is_ready(first):
                self.tell_arrival()
                entry = self._queue.take()
                if entry.is_for_world:
                    self._applied = entry.gesture
                yield entry
                if is_spent():
                    return
        finally:
            self._is_applying = False

    def _is_ready(self, entry: Entry) -> bool:
        """Return whether an entry need not wait for a seek, a call or an amendment."""
        if self._calls.hold_requests:
            return False
        if isinstance(entry.request, Call) and self._calls.are_reading:
            return False
        if entry.is_for_world:
            return self._playback.is_there
        return entry.is_answer or not self._past.cursor.is_amending

    def _apply_entry(self, entry: Entry) -> None:
        """
        Apply an entry whose turn has come, and collect its answer, or begin what has it later.

        :raises Refusal: and nothing is changed
        """
        match entry.request:
            case Answer() as answer:
                self._answers.append(answer)
            case Refusal() as refusal:
                self._playback.changed = True
                self._answer(refusal, entry)
            case Call() as call:
                self._has_jumped = False
                self._calls.begin(call)
            case Amend() | TakeBack() as change:
                self._playback.send_cursor()
                self._past.cursor.begin_amendment(self._amend(change, entry))
            case Seek(stamp=stamp):
                message = self.seek(stamp)
                self._arrival.expect(partial(self._answer_seek, entry.origin, message))
            case request:
                self._playback.changed = True
                if isinstance(request, Unread):
                    request = request.convert()
                answer = self.apply_one(request, entry.gesture, entry.origin.author)
                # Moves and drives come at the rate of frames.
                if not isinstance(request, DriveRobot | MoveHand | KeepHand):
                    self._answer(answer, entry)

    def apply_one(self, request: Request, gesture: int, author: str = '') -> Answer:
        """
        Apply a request now, before the entries that wait, and return its answer.

        :param gesture: its gesture; requests of a drag have that of the grab
        :param author: name of the person who did it; '' is nobody
        :raises Refusal: and nothing is changed
        """
        if isinstance(request, HandRequest):
            return self.hands.use(request, gesture, author)
        self._playback.send_cursor()
        return self._past.apply(request, gesture, author)

    def _amend(self, change: Amend | TakeBack, entry: Entry) -> Iterator[None]:
        """Change the past in slices, and collect the answers."""
        past, author = self._past, entry.origin.author
        results: list[Answer | Refusal]
        try:
            with past.boundary.refusing(entry.origin.topic):
                if isinstance(change, Amend):
                    results = yield from amend(past, change.gestures, change.requests, author)
                else:
                    results = yield from take_back(past, author)
        except Refusal as refusal:
            results = [refusal]
        self._playback.show_cursor()
        for result in results:
            self._answer(result, entry)

    # Calls

    def make_call(
        self,
        call: Sliced[Sequence[Answer]],
        wait: Wait,
        on_told: Callable[[], object] = lambda: None,
        origin: Origin = UNKNOWN,
    ) -> None:
        """
        Make a call now, or add it to the requests.

        :param call: may have slices
        :param wait: the time at which it is called
        :param on_told: called when its answers are told
        :param origin: the message from which it comes
        :raises Busy: too many requests wait
        """
        entry = Call(call, wait, on_told)
        if wait is Wait.NONE:
            self._calls.begin(entry)
        else:
            self._queue.submit_call(entry, origin)

    def continue_calls(self) -> None:
        """Go on with the calls for which no request waits, also during a seek."""
        self._calls.go_on_beside_requests()

    def _end_call(self, call: Call, answers: Sequence[Answer]) -> None:
        """Collect the answers to a call that has ended."""
        if call.wait is Wait.NONE:
            # In the order of entries.
            for answer in answers:
                self._queue.tell(answer)
            call.on_told()
        elif call.wait.holds_requests and self._has_jumped and not self._playback.has_arrived:
            self._arrival.expect(partial(self._answer_call, call, answers))
        else:
            self._answer_call(call, answers)

    # Other moments

    def seek(self, stamp: int) -> Text:
        """
        Go to a simulation time [ns], before the entries that wait; return a message about it.

        :raises OutOfHistory: the time is no longer kept, or in the future
        """
        self.tell_arrival()
        self._playback.seek(stamp)
        self.let_go()
        self._arrival.supersede('seek')
        return Text('at {time}', time=self._playback.time)

    def show_jump(self) -> None:
        """Show the moment to which something else than a seek has sent the cursor."""
        self._playback.drop_frames()
        self._playback.show_cursor()
        self._has_jumped = True
        self._arrival.supersede('jump')

    def let_go(self) -> None:
        """End drags and drives, since another moment or world is shown."""
        self.hands.clear()
        self.drives.commands.clear()

    def release_grips(self) -> None:
        """Remove the grips of hands that are gone, unless their release lies ahead."""
        if events := self.hands.release_grips():
            self._answers += events
            self._playback.changed = True

    # Answers

    @property
    def has_answers(self) -> bool:
        """Return whether answers wait for the next frame."""
        return bool(self._answers)

    def take_answers(self) -> tuple[Answer, ...]:
        """Return the answers that wait, and drop them."""
        self.tell_arrival()
        answers, self._answers = self._answers, []
        return tuple(answers)

    def tell_arrival(self) -> None:
        """Collect the answer to the last seek, if its moment is reached."""
        self._arrival.tell_if_there()

    def _answer(self, result: Answer | Refusal, entry: Entry) -> None:
        """Collect the answer to a request that waited."""
        topic, field, asker, *_ = entry.origin
        if isinstance(result, Refusal):
            result = Answer.refused(result, topic=topic, subject=entry.subject, field=field)
        self._answers.append(replace(result, topic=topic, asker=asker))

    def _answer_call(self, call: Call, answers: Sequence[Answer], _: Text = NOTHING) -> None:
        """Collect the answers to a call, which is done, be its moment reached or superseded."""
        self._answers += answers
        call.on_told()

    def _answer_seek(self, origin: Origin, message: Text, superseded: Text) -> None:
        """Collect the answer to a seek."""
        told = superseded or message
        self._answers.append(Answer(topic=origin.topic, message=told, asker=origin.asker))
