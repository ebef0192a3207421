# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sinks, which workers log frames to, and the endpoints that open them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import ClassVar, Protocol

from physsim_ros.model.snapshot import Answer, Frame
from physsim_ros.view.frame_context import FrameContext

Report = Callable[[Answer], None]


class Sink(Protocol):
    """A stream that frames are logged to."""

    def draw(self, frames: Sequence[Frame], *, context: FrameContext) -> None:
        """Log frames in order."""

    def flush(self, timeout: float) -> None:
        """
        Wait until all logged frames have been sent.

        :param timeout: longest wait [s]
        :raises TimeoutError: they have not been sent yet
        :raises ConnectionError: they cannot be sent any more
        """

    def close(self) -> None:
        """Close the stream; called once, whatever happened to it."""


class Endpoint(ABC):
    """
    The receiver of a sink: a file, a server, or a program on this machine.

    :cvar kind: name of it, for messages
    :cvar where: address of it, for messages
    :cvar code: of the event when it is lost
    :cvar period: time for which frames are gathered into a batch [s]
    :cvar capacity: greatest number of frames in the queue
    :cvar patience: time without an answer at which it is reported [s]; with `reopens`, it may
        answer later, else it is lost
    :cvar closing: longest time for the last frames [s]
    :cvar reopens: whether it may be opened again after it was lost
    """

    kind = ''
    where = ''
    code: ClassVar[str] = 'viewer_lost'
    period: ClassVar[float] = 0.1
    capacity: ClassVar[int] = 60
    patience: ClassVar[float] = 3.0
    closing: ClassVar[float] = 2.0
    reopens: ClassVar[bool] = True

    @abstractmethod
    def open_sink(self) -> Sink | None:
        """
        Return a new sink; None where the receiver is not there yet.

        :raises ConnectionError: it cannot be opened at all
        """

    @property
    def is_ready(self) -> bool:
        """Whether it takes frames now; until then they wait in the queue."""
        return True

    def check(self) -> None:  # noqa: B027  most have nothing to check
        """
        Restart or report a program that has ended; called every `CHECK_PERIOD`.

        :raises ConnectionError: the receiver is lost
        """

    def close(self) -> None:  # noqa: B027  the same
        """
        End the program, if there is one, and start none any more.

        Called more than once, and from another thread while `open_sink` or `check` runs.
        """

    def opened_answer(self) -> Answer:
        """Return the answer that reports that it was opened."""
        return Answer(topic='viewer', message=f'{self.kind}: {self.where}')

    def lost_answer(self, reason: str) -> Answer:
        """Return the answer that reports that it was lost, or is another than was asked for."""
        message = f'{self.kind}: {self.where}: {reason}'
        return Answer(topic='viewer', message=message, code=self.code)
