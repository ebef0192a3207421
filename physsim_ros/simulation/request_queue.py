# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The queue of requests: they wait for the next frame, and are applied there in their order.

Laws: entries are applied in the order of their arrival, and each is answered once, but moves of
hands and drives only if refused. A seek, or a call that sends the world elsewhere, is answered
when the moment is reached, or when the world is sent elsewhere before. Requests that read or
change the world wait for the end of a seek; all but answers wait for the end of an amendment, and
all for that of a call in slices, unless that has read the world and only writes: then other calls
wait. `waiting_entries` has what replaces a waiting entry, and how many may wait; `calls_under_way`
the calls.
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
from physsim_ros.model.translation import Text
from physsim_ros.runtime.slices import Sliced
from physsim_ros.simulation.calls_under_way import CallsUnderWay
from physsim_ros.simulation.entries import (
    Amend,
    Call,
    Entry,
    Origin,
    Seek,
    size_of,
    TakeBack,
    Unread,
    Wait,
)
from physsim_ros.simulation.hands import Hands
from physsim_ros.simulation.past import amend, Past, take_back
from physsim_ros.simulation.playback import Playback
from physsim_ros.simulation.waiting_entries import WaitingEntries


class RequestQueue:
    """
    The entries that wait, and what applies them at the moment that is shown.

    :param past: of the world
    :param playback: the moment that is shown

    :ivar gesture: number of the last gesture
    :ivar hands: that drag bodies
    :ivar driving: the commands with which robots drive on, by the names of their bodies
    """

    def __init__(self, past: Past, playback: Playback) -> None:
        self.gesture = 0
        self.hands = Hands(past, playback)
        self.driving: dict[str, DriveRobot] = {}
        # Those that wait for the next frame.
        self._answers: list[Answer] = []
        self._past = past
        self._playback = playback
        self._waiting = WaitingEntries()
        self._is_applying = False
        # Gesture of the last request that was applied.
        self._applied = 0
        # Answers the seek under way, or the call that began it; its argument tells by what it is
        # superseded, '' by nothing.
        self._answer_arrival: Callable[[str], object] | None = None
        # Whether the last call has sent the world elsewhere.
        self._has_jumped = False
        self._calls = CallsUnderWay(self._end_call)

    # Submitting

    def __len__(self) -> int:
        return len(self._waiting)

    def begin_gesture(self) -> int:
        """Return the number of a new gesture."""
        self.gesture += 1
        return self.gesture

    def submit(
        self,
        request: Request | Unread | Amend | TakeBack,
        origin: Origin | None = None,
        *,
        topic: str = '',
        joined: bool = False,
    ) -> None:
        """
        Add a request; the next frame applies and answers it.

        :param origin: the message from which it comes; None is one of `topic`
        :param topic: its source, where nothing else is known of the message
        :param joined: whether it is in the gesture of the entry before, and is undone with it
        """
        if isinstance(request, MoveHand) and self._waiting.replace_move(request):
            return
        gesture = self.gesture if joined else None
        self.submit_gesture((request,), origin or Origin(topic), gesture)

    def submit_gesture(
        self,
        requests: Sequence[Request | Unread | Amend | TakeBack],
        origin: Origin,
        gesture: int | None = None,
    ) -> int:
        """
        Add requests that are undone together, and return the number of their gesture.

        Where they are too many beside those that wait, each of them is refused.

        :param requests: at least one
        :param gesture: number of an earlier gesture that they are in, whatever came between
        """
        gesture = self.begin_gesture() if gesture is None else gesture
        sizes = [size_of(each) for each in requests]
        busy = self._waiting.busy(sum(sizes), len(sizes))
        for request, size in zip(requests, sizes, strict=True):
            subject = request.subject if isinstance(request, Request | Unread) else ''
            entry = Entry(request, origin, subject, gesture, size)
            if busy:
                self._waiting.add_answer(replace(entry, request=busy, size=0))
            else:
                self._waiting.add(entry)
        return gesture

    def submit_seek(self, stamp: int, origin: Origin) -> None:
        """Add a seek to a simulation time [ns], in place of one that is the last entry."""
        if busy := self._waiting.busy():
            self.refuse(busy, origin)
            return
        seek = Seek(stamp)
        self._waiting.add_seek(Entry(seek, origin, '', self.gesture), seek)

    def submit_call(
        self,
        call: Sliced[Sequence[Answer]],
        wait: Wait,
        on_told: Callable[[], object] = lambda: None,
    ) -> None:
        """
        Make a call now, or add it to the requests.

        :param call: may have slices
        :param wait: the time at which it is called
        :param on_told: called when its answers are told
        :raises Busy: too many requests wait
        """
        if wait is Wait.NONE:
            self._calls.begin(Call(call, wait, on_told))
            return
        if busy := self._waiting.busy():
            raise busy
        # Its answers have their own topics.
        entry = Entry(Call(call, wait, on_told), Origin(''), '', self.begin_gesture())
        self._waiting.add(entry)

    def refuse(self, refusal: Refusal, origin: Origin, *, subject: str = '') -> None:
        """
        Add the refusal of a message that is no request.

        :param subject: name of the body or joint that the message names, or ''
        """
        self._waiting.add_answer(Entry(refusal, origin, subject, self.gesture))

    def tell(self, answer: Answer) -> None:
        """Add an answer without a request, in the order of entries."""
        entry = Entry(answer, Origin(answer.topic), answer.subject, self.gesture)
        self._waiting.add_answer(entry)

    # Applying

    @property
    def has_requests(self) -> bool:
        """Return whether an entry waits that is applied to the world."""
        return any(each.is_for_world for each in self._waiting)

    @property
    def is_in_gesture(self) -> bool:
        """
        Return whether the next request belongs to the gesture of the last one that was applied.

        Commands of robots join a gesture for an undo alone.
        """
        following = next((each for each in self._waiting if each.is_for_world), None)
        if following is None or isinstance(following.request, DriveRobot | CommandMotors):
            return False
        return following.gesture == self._applied

    @property
    def is_busy(self) -> bool:
        """Return whether requests or calls wait, or a call is under way for which they wait."""
        return self._calls.hold_requests or not all(each.is_answer for each in self._waiting)

    def apply_waiting(self) -> None:
        """Apply all entries, and finish the seeks, calls and amendments that others wait for."""
        if self._waiting:
            self.apply_up_to_seek()
        while (self._waiting or self._calls.hold_requests) and not self._is_applying:
            self._calls.wait_for_any()
            self._playback.arrive()
            self.apply_up_to_seek()
        self._past.cursor.finish_amendment()
        self.note_arrival()

    def settle(self) -> Past:
        """
        Apply all entries, and return the past, its cursor sent to the moment that is shown.

        A cached frame may be shown while the cursor is elsewhere: what acts on the past, or reads
        the world, calls this first.
        """
        self.apply_waiting()
        self._playback.seek_shown()
        return self._past

    def continue_calls(self) -> None:
        """Go on with the calls for which no request waits, also during a seek."""
        self._calls.go_on_beside_requests()

    def finish_calls(self) -> None:
        """Apply all entries, and finish the calls that have read the world, too."""
        self.apply_waiting()
        while self._calls.are_reading:
            self._calls.wait_for_any()
            self.continue_calls()
            self.apply_waiting()

    def apply_up_to_seek(self, is_spent: Callable[[], bool] = lambda: False) -> bool:
        """
        Apply the entries up to a seek or an amendment; those after it wait for its end.

        :param is_spent: whether there is no time for a further entry, or slice of a call; asked
            after each
        :return: whether no seek and no call is under way, and no request waits
        """
        for entry in self._take(is_spent):
            try:
                match entry.request:
                    case Answer() as answer:
                        self._answers.append(answer)
                    case Refusal() as refusal:
                        self._playback.note_change()
                        self._answer(refusal, entry)
                    case Call() as call:
                        self._has_jumped = False
                        self._calls.begin(call)
                    case Amend() | TakeBack() as change:
                        entry.origin.check()
                        self._playback.seek_shown()
                        self._past.cursor.begin_amendment(self._amend(change, entry))
                    case Seek(stamp=stamp):
                        message = self.seek(stamp)
                        self._answer_arrival = partial(self._answer_seek, entry.origin, message)
                    case request:
                        self._playback.note_change()
                        entry.origin.check()
                        if isinstance(request, Unread):
                            request = request.convert()
                        answer = self.apply_now(request, entry.gesture, entry.origin.author)
                        # Moves and drives come at the rate of frames.
                        if not isinstance(request, DriveRobot | MoveHand | KeepHand):
                            self._answer(answer, entry)
            except Refusal as refusal:
                self._answer(refusal, entry)
        return self._playback.is_there and not self.is_busy

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
            while (first := self._waiting.first) and self._is_ready(first):
                self.note_arrival()
                entry = self._waiting.take()
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

    def _end_call(self, call: Call, answers: Sequence[Answer]) -> None:
        """Collect the answers to a call that has ended."""
        if call.wait is Wait.NONE:
            # In the order of entries.
            for answer in answers:
                self.tell(answer)
            call.on_told()
        elif call.wait.holds_requests and self._has_jumped and not self._playback.has_arrived:
            self._answer_arrival = partial(self._answer_call, call, answers)
        else:
            self._answer_call(call, answers)

    def _answer_call(self, call: Call, answers: Sequence[Answer], _: str = '') -> None:
        """Collect the answers to a call, which is done, be its moment reached or superseded."""
        self._answers += answers
        call.on_told()

    def _answer_seek(self, origin: Origin, message: str, superseded: str) -> None:
        """Collect the answer to a seek."""
        told = superseded or message
        self._answers.append(Answer(topic=origin.topic, message=told, asker=origin.asker))

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
        self._playback.note_jump()
        for result in results:
            self._answer(result, entry)

    def _answer(self, result: Answer | Refusal, entry: Entry) -> None:
        """Collect the answer to a request that waited."""
        topic, field, asker, *_ = entry.origin
        if isinstance(result, Refusal):
            result = Answer.refused(result, topic=topic, subject=entry.subject, field=field)
        self._answers.append(replace(result, topic=topic, asker=asker))

    def apply_now(self, request: Request, gesture: int, author: str = '') -> Answer:
        """
        Apply a request now.

        :param gesture: its gesture; requests of a drag have that of the grab
        :param author: name of the person who did it; '' is nobody
        :raises Refusal: and nothing is changed
        """
        if isinstance(request, HandRequest):
            return self.hands.use(request, gesture, author)
        self._playback.seek_shown()
        return self._past.apply(request, gesture, author)

    def seek(self, stamp: int) -> str:
        """
        Go to a simulation time [ns] now, and return a message about it.

        :raises OutOfHistory: the time is no longer kept, or in the future
        """
        self.note_arrival()
        self._playback.seek(stamp)
        self.let_go()
        self._supersede('seek')
        return Text('at {time}', time=self._playback.time)

    def let_go(self) -> None:
        """End drags and drives, since another moment or world is shown."""
        self.hands.clear()
        self.driving.clear()

    def note_jump(self) -> None:
        """Show the moment to which something else than a seek has sent the cursor."""
        self._playback.drop_frames()
        self._playback.note_jump()
        self._has_jumped = True
        self._supersede('jump')

    def note_arrival(self) -> None:
        """Collect the answer to the last seek, if its moment is reached."""
        if self._answer_arrival is not None and self._playback.has_arrived:
            self._tell_arrival()

    def _supersede(self, by: str) -> None:
        """Answer the seek that was under way, in whose place the cursor went elsewhere."""
        time = self._playback.time
        self._tell_arrival(Text('superseded by a {by} to {time}', by=by, time=time))

    def _tell_arrival(self, superseded: str = '') -> None:
        if self._answer_arrival is not None:
            answer, self._answer_arrival = self._answer_arrival, None
            answer(superseded)

    def release_grips(self) -> None:
        """Remove the grips of hands that are gone, unless their release lies ahead."""
        if events := self.hands.release_grips():
            self._answers += events
            self._playback.note_change()

    @property
    def has_answers(self) -> bool:
        """Return whether answers wait for the next frame."""
        return bool(self._answers)

    def take_answers(self) -> tuple[Answer, ...]:
        """Return the answers that wait, and drop them."""
        self.note_arrival()
        answers, self._answers = self._answers, []
        return tuple(answers)

    def report_oldest(self, more: str = '') -> None:
        """Add the event that the moment that is shown is the oldest."""
        message = Text(
            '{time} is the oldest that is kept{more}', time=self._playback.time, more=more
        )
        self._answers.append(Answer(topic='history', message=message))
