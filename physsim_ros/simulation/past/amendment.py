# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Amendment: requests of the past are replaced, and the world is simulated again up to its moment.

Laws: later requests are carried out again in their order, each at its step; the future of the
moment is dropped. Between two slices of the work the line in force counts as reached up to that
moment, though not all of it is simulated yet.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from dataclasses import replace

from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import InPast, NotAlone, OutOfHistory, Refusal
from physsim_ros.model.requests import Request
from physsim_ros.model.translation import Text
from physsim_ros.simulation.past.line import Line
from physsim_ros.simulation.past.past import Past

# Greatest simulation time that is simulated again [s].
LONGEST_AGAIN = 60.0


def amend(
    past: Past, gestures: Sequence[int], requests: Sequence[Request], author: str = ''
) -> Generator[None, None, list[Answer | Refusal]]:
    """
    Replace the requests of earlier gestures, and simulate again up to this moment, in slices.

    :param gestures: their numbers, at least one; those that changed nothing or are no longer kept
        are ignored, and without any other the requests are applied now
    :param requests: that replace theirs, at their first step
    :param author: name of the person who did it; '' is nobody
    :return: for each request its answer, or its refusal
    :raises NotAlone: too much would be simulated again; nothing is changed
    """
    amendment = _Amendment(past, gestures, requests, author)
    before = yield from amendment.carry_out()
    past.tree.drop(before)
    return amendment.done


def take_back(past: Past, author: str) -> Generator[None, None, list[Answer | Refusal]]:
    """
    Take back the last gesture of a person, and simulate again up to this moment, in slices.

    What others have done since is done again as it was asked.

    :param author: name of the person
    :return: the answer
    :raises InPast: the past is shown
    :raises OutOfHistory: the person has done nothing that is kept
    :raises NotAlone: what was done since needs it, or is too much to be done again; nothing is
        changed
    """
    if not past.cursor.is_newest:
        raise InPast('the past is shown; go to its end first', field='history')
    first = past.line.last_gesture_of(author)
    if first is None:
        raise OutOfHistory(
            'there is nothing by {person} to undo', field='history', person=author.strip()
        )
    before = yield from _Amendment(past, (first.gesture,), stands_alone=True).carry_out()
    words = first.phrase(1)
    past.tree.undone.append(replace(before, words=words))
    return [Answer(message=Text('undid {gesture}', gesture=words))]


class _Amendment:
    """
    The replacement of the requests of earlier gestures, up to the moment of the cursor.

    Gestures that changed nothing or are no longer kept are ignored; without any other, the
    requests are applied now.

    :param past: with the gestures
    :param gestures: their numbers, at least one; the requests get the first number
    :param requests: that replace theirs, at their first step
    :param author: name of the person who did it; '' is nobody
    :param stands_alone: whether it ends where a later request is refused, which else is dropped

    :ivar done: for each new request its answer or its refusal
    """

    def __init__(
        self,
        past: Past,
        gestures: Sequence[int],
        requests: Sequence[Request] = (),
        author: str = '',
        *,
        stands_alone: bool = False,
    ) -> None:
        self._past, self._line, self._cursor = past, past.line, past.cursor
        self._requests, self._gesture, self._author = requests, gestures[0], author
        line, (self._end, serial) = self._line, self._cursor.moment
        starts = [line.moment_before_gesture(each, serial) for each in gestures]
        # The first step that differs, and the serial before it.
        self._step, self._serial = min(
            (start for start in starts if start is not None),
            key=lambda start: start[1],
            default=(self._end, serial),
        )
        # Commands of robots join the gesture before them, whose author is another one.
        self._later = [
            each
            for each in line.nodes_between(self._serial, serial)
            if each.gesture not in gestures or each.author != line.node(each.gesture_start).author
        ]
        self._stands_alone = stands_alone
        self.done: list[Answer | Refusal] = []

    def carry_out(self) -> Generator[None, None, Line]:
        """
        Carry it out; yield after each frame and each request, and where a frame takes long.

        While others act, the line ends where it will end, as the time line and seeks have it.
        Where it fails, the line before is in force again.

        :return: the line before
        :raises NotAlone: too much would be simulated again, or a later request is refused, and it
            is to stand alone
        """
        past, tree = self._past, self._past.tree
        if self._end - self._step > past.steps_in(LONGEST_AGAIN):
            template = 'that was more than {time:g} s ago; delete it instead'
            raise NotAlone(template, time=LONGEST_AGAIN)
        before, told = tree.line_left_at(self._cursor.moment), len(past.reports)
        try:
            for _ in self._simulate():
                with self._line.reaching(self._end):
                    yield
        except Exception:
            # Reports of the way were given the first time.
            del past.reports[told:]
            left, _ = past.go_to(before)
            tree.drop(left)
            raise
        tree.drop_undone()
        past.frames.drop_from(self._step)
        return before

    def _simulate(self) -> Iterator[None]:
        cursor = self._cursor
        start = self._step, self._serial
        cursor.follow(self._line.node(self._serial), self._step, start)
        yield from cursor.slices_of_work()
        for request in self._requests:
            self.done.append(self._apply(request, self._gesture, self._author))
            # The world may have to be rebuilt.
            yield from cursor.slices_of_work()
            yield
        for node in self._later:
            yield from self._advance(node.step)
            answer = self._apply(node.request, node.gesture, node.author)
            if self._stands_alone and isinstance(answer, Refusal):
                raise NotAlone('somebody has used it since; delete it instead')
            yield from cursor.slices_of_work()
            yield
        yield from self._advance(self._end)
        cursor.arrive().clear_contacts()

    def _advance(self, step: int) -> Iterator[None]:
        cursor, frame_steps = self._cursor, self._past.frame_steps
        while (at := cursor.moment.step) < step:
            yield from cursor.slices_of_advance(min(step, at + frame_steps))
            yield

    def _apply(self, request: Request, gesture: int, author: str) -> Answer | Refusal:
        cursor = self._cursor
        try:
            change = self._past.carry_out(request)
        except Refusal as refusal:
            return refusal
        if change.has_changed:
            cursor.log(request, change, gesture, author)
        return change.answer
