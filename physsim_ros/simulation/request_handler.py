# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The handler of requests: it applies those that wait, in their order, and collects the answers.

Law: every request has one answer, except moves of hands, which have one only if refused. Answers
keep the order of requests. A call that reads or replaces the world is carried out after the
requests before it, and before those after it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace

from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import (
    DriveRobot,
    Grab,
    GrabToPlace,
    HandRequest,
    KeepHand,
    LetGo,
    MoveHand,
    PlaceHand,
    Request,
)
from physsim_ros.model.snapshot import Answer, Grip
from physsim_ros.simulation.past import Past
from physsim_ros.simulation.playback import Playback
from physsim_ros.simulation.request_queue import (
    Amend,
    Call,
    RequestQueue,
    Seek,
    TakeBack,
    Unread,
    Waiting,
)

# Steady time without a request after which a hand lets go [ns]: its page is gone.
LONGEST_SILENCE = 5 * 10**9


@dataclass(slots=True)
class _Hand:
    """
    A hand that drags a body.

    :param gesture: number of the gesture of the drag
    :param silent_since: first steady time after its last request, or after a pause [ns]; None
        until then
    """

    gesture: int
    silent_since: int | None = None


class Hands:
    """
    The hands of people that drag a body at the moment that is shown.

    Laws: a drag, from the grab until the hand lets go, is one gesture; requests of a hand whose
    grip is gone, or after another moment is shown, change nothing.
    """

    def __init__(self) -> None:
        self._dragging: dict[str, _Hand] = {}

    def __contains__(self, hand: str) -> bool:
        return hand in self._dragging

    def gesture_of(self, request: HandRequest, gesture: int) -> int:
        """
        Return the gesture that a request is part of.

        :param gesture: its own, if no drag is under way
        """
        hand = self._dragging.get(request.hand)
        return gesture if hand is None or isinstance(request, Grab) else hand.gesture

    def note_request(self, request: HandRequest, gesture: int, grips: Iterable[Grip]) -> None:
        """
        Note that a request of a hand was carried out.

        :param grips: of the world now; at a grab, hands without one are dropped: their bodies are
            gone
        """
        match request:
            case Grab(hand=hand):
                self._dragging[hand] = _Hand(gesture)
                with_grip = {grip.hand for grip in grips}
                for name in self._dragging.keys() - with_grip:
                    del self._dragging[name]
            case MoveHand(hand=hand) | KeepHand(hand=hand):
                self._dragging[hand].silent_since = None
            case LetGo(hand=hand):
                self._dragging.pop(hand, None)

    def note_time(self, now_ns: int, *, paused: bool) -> None:
        """
        Drop the hands that have been silent for too long.

        :param now_ns: steady time, never going back [ns]
        :param paused: whether the world is paused; then the time does not count
        """
        for name, hand in list(self._dragging.items()):
            if paused or hand.silent_since is None:
                hand.silent_since = now_ns
            elif now_ns - hand.silent_since > LONGEST_SILENCE:
                del self._dragging[name]

    def clear(self) -> None:
        """Drop all hands, since another moment is shown."""
        self._dragging.clear()


def placing(request: HandRequest) -> HandRequest:
    """Return the request of a hand in a paused world, in which it places bodies."""
    match request:
        case GrabToPlace() | PlaceHand() | KeepHand() | LetGo():
            return request
        case Grab(hand=hand, point=point, frame=frame):
            return GrabToPlace(hand=hand, point=point, frame=frame)
        case MoveHand(hand=hand, point=point, yaw=yaw, frame=frame):
            return PlaceHand(hand=hand, point=point, yaw=yaw, frame=frame)


class RequestHandler:
    """
    Applies requests at the moment that is shown.

    :param past: of the world
    :param playback: the moment that is shown
    :param queue: of the requests that wait

    :ivar hands: that drag bodies
    :ivar answers: that wait for the next frame
    """

    def __init__(self, past: Past, playback: Playback, queue: RequestQueue) -> None:
        self.hands = Hands()
        self.answers: list[Answer] = []
        self._past = past
        self._playback = playback
        self._queue = queue

    def apply_waiting(self) -> None:
        """Apply the requests that wait, and collect their answers."""
        self._past.cursor.finish_amendment()
        for waiting in self._queue.take():
            self._carry_out(waiting)
            self._past.cursor.finish_amendment()

    def apply_up_to_seek(self, is_spent: Callable[[], bool] = lambda: False) -> None:
        """
        Apply the requests that wait up to a seek or an amendment; others wait for its end.

        :param is_spent: whether there is no time for a further request, which waits, too
        """
        for waiting in self._queue.take(self._is_ready, is_spent):
            self._carry_out(waiting)

    def _is_ready(self, waiting: Waiting) -> bool:
        """Return whether an entry of the queue can be carried out now, without a replay."""
        if waiting.is_for_world:
            return self._playback.is_there
        return waiting.is_answer or not self._past.cursor.is_amending

    def _carry_out(self, waiting: Waiting) -> None:
        """Carry out an entry of the queue, and collect its answers."""
        try:
            match waiting.request:
                case Answer() as answer:
                    self.answers.append(answer)
                case Refusal() as refusal:
                    self._playback.changed = True
                    self._answer(refusal, waiting)
                case Call(call=call):
                    self.answers += call()
                case Amend() | TakeBack() as change:
                    self._playback.seek_shown()
                    self._past.cursor.work(self._amend(change, waiting))
                case Seek(stamp=stamp):
                    self._answer(Answer(message=self.seek(stamp)), waiting)
                case request:
                    self._playback.changed = True
                    if isinstance(request, Unread):
                        request = request.convert()
                    done = self.apply(request, waiting.gesture, waiting.author)
                    # Moves and drives come at the rate of frames.
                    if not isinstance(request, DriveRobot | MoveHand | KeepHand):
                        self._answer(done, waiting)
        except Refusal as refusal:
            self._answer(refusal, waiting)

    def _amend(self, change: Amend | TakeBack, waiting: Waiting) -> Iterator[None]:
        """Change the past in parts, and collect the answers."""
        results: list[Answer | Refusal]
        try:
            with self._past.boundary.message(waiting.topic):
                if isinstance(change, Amend):
                    results = yield from self._past.amend(
                        change.gestures, change.requests, waiting.author
                    )
                else:
                    phrase = yield from self._past.take_back(waiting.author)
                    results = [Answer(message=f'undid {phrase}')]
        except Refusal as refusal:
            results = [refusal]
        self._playback.note_jump()
        for result in results:
            self._answer(result, waiting)

    def _answer(self, result: Answer | Refusal, waiting: Waiting) -> None:
        """Collect the answer to a request that waited."""
        if isinstance(result, Refusal):
            result = Answer.refused(result, topic='', subject=waiting.subject, field=waiting.field)
        self.answers.append(replace(result, topic=waiting.topic, asker=waiting.asker))

    def apply(self, request: Request, gesture: int, author: str = '') -> Answer:
        """
        Apply a request now.

        :param gesture: its gesture; requests of a drag have that of the grab
        :param author: name of the person who did it; '' is nobody
        :raises Refusal: and nothing is changed
        """
        cursor = self._past.cursor
        before = cursor.moment
        if isinstance(request, HandRequest):
            if request.hand not in self.hands and not isinstance(request, Grab):
                # Grips of a past moment belong to no present hand.
                return Answer(message=f'{request.hand} holds no body')
            if self._playback.speed == 0.0:
                request = placing(request)
            gesture = self.hands.gesture_of(request, gesture)
        self._playback.seek_shown()
        done = self._past.apply(request, gesture, author)
        if isinstance(request, HandRequest):
            self.hands.note_request(request, gesture, cursor.world.grips)
        if cursor.moment != before:
            # On a new course, grips of the past have no hand.
            self.release_grips()
        return done

    def seek(self, stamp: int) -> str:
        """
        Go to a simulation time [ns] now, and return a message about it.

        :raises OutOfHistory: the time is no longer kept, or in the future
        """
        self._playback.seek(stamp)
        self.hands.clear()
        return f'at {self._playback.time}'

    def release_grips(self) -> None:
        """Remove the grips of hands that are gone, unless the history has their release ahead."""
        cursor = self._past.cursor
        if self._playback.is_frame_cached or not cursor.world.grips or not cursor.is_newest:
            return
        for grip in cursor.world.grips:
            if grip.hand not in self.hands:
                # In the gesture of the request before, so that they are undone together.
                gesture = self._past.tree.node(cursor.serial).gesture or self._queue.gesture
                self._past.apply(LetGo(hand=grip.hand), gesture)
                message = f'released {grip.body}: no message from {grip.hand}'
                self.answers.append(
                    Answer(topic='~/drag/feedback', subject=grip.body, message=message)
                )

    def take_answers(self) -> tuple[Answer, ...]:
        """Return the answers that wait, and drop them."""
        answers = tuple(self.answers)
        self.answers.clear()
        return answers

    def report_oldest(self, more: str = '') -> None:
        """Add the event that the moment that is shown is the oldest."""
        message = f'{self._playback.time} is the oldest that is kept{more}'
        self.answers.append(Answer(topic='history', message=message))
