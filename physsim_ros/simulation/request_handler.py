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

from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import (
    DriveRobot,
    Grab,
    HandRequest,
    KeepHand,
    LetGo,
    MoveHand,
    Request,
)
from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.hands import Hands, placing
from physsim_ros.simulation.past import Past
from physsim_ros.simulation.playback import Playback
from physsim_ros.simulation.request_queue import Amend, Call, RequestQueue, Seek, Waiting
from physsim_ros.simulation.world import Done


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
        self._apply(self._queue.take())

    def apply_up_to_seek(self, is_spent: Callable[[], bool] = lambda: False) -> None:
        """
        Apply the requests that wait up to a seek; those after it wait for its end.

        :param is_spent: whether there is no time for a further request, which waits, too
        """
        self._apply(self._queue.take(lambda: self._playback.is_there, is_spent))

    def _apply(self, entries: Iterator[Waiting]) -> None:
        for waiting in entries:
            try:
                self.answers += self._carry_out(waiting)
            except Refusal as refusal:
                self.answers.append(_refused(refusal, waiting, waiting.subject))

    def _carry_out(self, waiting: Waiting) -> Iterable[Answer]:
        """Carry out an entry of the queue, and return its answers."""
        match waiting.request:
            case Answer() as answer:
                return [answer]
            case Refusal() as refusal:
                self._playback.changed = True
                raise refusal
            case Call(call=call):
                return call()
            case Amend(gestures=gestures, requests=requests):
                self._playback.seek_shown()
                results = self._past.amend(gestures, requests, waiting.author)
                self._playback.note_jump()
                return [_answer(result, waiting) for result in results]
            case Seek(stamp=stamp):
                return [_answer(Done('', self.seek(stamp)), waiting)]
            case request:
                self._playback.changed = True
                done = self.apply(request, waiting.gesture, waiting.author)
                # Moves and drives come at the rate of frames.
                told = not isinstance(request, DriveRobot | MoveHand | KeepHand)
                return [_answer(done, waiting)] if told else []

    def apply(self, request: Request, gesture: int, author: str = '') -> Done:
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
                return Done('', f'{request.hand} holds no body')
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
                message = f'{grip.hand} is silent and has let go of {grip.body}'
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


def _answer(result: Done | Refusal, waiting: Waiting) -> Answer:
    """Return the answer to a request that waited, with its result."""
    if isinstance(result, Refusal):
        return _refused(result, waiting, subject='')
    return Answer(
        topic=waiting.topic,
        subject=result.subject,
        message=result.message,
        asker=waiting.asker,
    )


def _refused(refusal: Refusal, waiting: Waiting, subject: str) -> Answer:
    return Answer.refused(
        refusal, topic=waiting.topic, subject=subject, field=waiting.field, asker=waiting.asker
    )
