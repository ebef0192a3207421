# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The error boundary: an error that nobody expected ends one message or one output, not the world.

It stands where something enters the node or leaves it: topics, services, parameters, pages, files,
outputs. Laws: a refusal passes it where something enters. Any other exception is logged with its
traceback and a number, once for each place where it arises, and counted; a message is answered
`failed` with that number.
An error inside of a step is no `Exception` (`StepFailed`): it passes, and ends the world.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Coroutine, Generator, Iterator
from contextlib import AbstractContextManager, contextmanager
from itertools import count
import traceback
from types import coroutine
from typing import TypeVar

from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Failed, PhysSimError
from physsim_ros.model.texts import abbreviated

# Length of a line of the log [characters], and number of events that wait.
_LONGEST_LINE, _MOST_EVENTS = 500, 100
_Awaited = TypeVar('_Awaited')
_Result = TypeVar('_Result')
# Type of an error, and the lines of code by which it came, each once: a recursion has few.
_Place = tuple[type, frozenset[tuple[str, int]]]


class ErrorBoundary:
    """
    The boundary of a node; its methods may be called on any thread.

    :param log: takes the traceback of an error; without it, errors pass the boundary
    :param clock: returns the CPU time of the thread that calls it [s]

    :ivar failures: number of unexpected errors
    :ivar on_error: called with each unexpected error, as a test wants to be
    """

    def __init__(
        self,
        log: Callable[[str], object] | None = None,
        clock: Callable[[], float] = lambda: 0.0,
    ) -> None:
        self.failures = 0
        self.on_error: Callable[[BaseException], object] = lambda _: None
        self._log = log
        self._clock = clock
        self._counter = count(1)
        # Number of the first error of each place.
        self._numbers: dict[_Place, int] = {}
        self._events: deque[Answer] = deque(maxlen=_MOST_EVENTS)
        self._longest = '', 0.0

    @contextmanager
    def message(self, name: str) -> Iterator[None]:
        """
        Carry out a message on the world's thread in the block, and measure it.

        :param name: of its topic, service or parameter
        :raises Failed: in place of an unexpected error
        """
        began = self._clock()
        try:
            with self.refusing(name):
                yield
        finally:
            took = self._clock() - began
            if took > self._longest[1]:
                self._longest = name, took

    @coroutine
    def slices_of_message(
        self, name: str, slices: Coroutine[_Awaited, None, _Result]
    ) -> Generator[_Awaited, None, _Result]:
        """Carry out a message in slices, each as `message` does."""
        while True:
            with self.message(name):
                try:
                    awaited = slices.send(None)
                except StopIteration as end:
                    result: _Result = end.value
                    return result
            yield awaited

    @contextmanager
    def refusing(self, name: str) -> Iterator[None]:
        """
        Refuse in place of an unexpected error in the block, on any thread.

        :param name: of the topic, service, parameter or file that is refused
        :raises Failed: in place of that error
        """
        try:
            yield
        except PhysSimError:
            raise
        except Exception as error:
            raise self.failed(name, error) from error

    def containing(self, name: str) -> AbstractContextManager[None, bool]:
        """Contain an unexpected error in the block: it ends the block alone, and is an event."""
        # A dozen a frame: a generator takes five times as long.
        return _Containing(self, name)

    def note_contained(self, name: str, error: Exception) -> None:
        """Note an unexpected error that has ended its block alone."""
        number, is_new = self._note(name, error)
        if is_new:
            self._events.append(Answer.refused(_failed(number), topic=name))

    def failed(self, name: str, error: BaseException) -> Failed:
        """Note an unexpected error, and return the refusal of its message."""
        number, _ = self._note(name, error)
        return _failed(number)

    def take_events(self) -> tuple[Answer, ...]:
        """Return the events about contained errors since the last call."""
        return tuple(self._events.popleft() for _ in range(len(self._events)))

    def take_longest(self) -> tuple[str, float]:
        """Return the message that took the longest since the last call, and its CPU time [s]."""
        longest, self._longest = self._longest, ('', 0.0)
        return longest

    def _note(self, name: str, error: BaseException) -> tuple[int, bool]:
        """Count an error; log it and return its number, and whether it is the first there."""
        if self._log is None:
            raise error
        self.failures = current = next(self._counter)
        lines = traceback.walk_tb(error.__traceback__)
        place = type(error), frozenset((each.f_code.co_filename, line) for each, line in lines)
        number = self._numbers.setdefault(place, current)
        if number == current:
            # Its message may repeat a stranger's text.
            text = ''.join(traceback.format_exception(error)).splitlines()
            shown = '\n'.join(abbreviated(each, _LONGEST_LINE) for each in text)
            self._log(f'failure {number}, {name}:\n{shown}')
        self.on_error(error)
        return number, number == current


class _Containing:
    """
    A block that contains its unexpected error.

    :param boundary: of it
    :param name: by which an error is told
    """

    __slots__ = ('_boundary', '_name')

    def __init__(self, boundary: ErrorBoundary, name: str) -> None:
        self._boundary = boundary
        self._name = name

    def __enter__(self) -> None:
        pass

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: object
    ) -> bool:
        if not isinstance(error, Exception):
            return False
        self._boundary.note_contained(self._name, error)
        return True


def _failed(number: int) -> Failed:
    return Failed(
        'an unexpected error; failure {number} in the log of the node has its cause', number=number
    )
