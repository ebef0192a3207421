# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Sinks, to which workers log frames, and the endpoints that open them.

A sink is a recording stream of Rerun: to a file, to a server, or to memory.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from contextlib import suppress
import os
from typing import ClassVar, TYPE_CHECKING

from physsim_ros.model.snapshot import Answer, Frame
from physsim_ros.view.frame_context import FrameContext
from physsim_ros.view.recording_list import RECORDING_LIST

if TYPE_CHECKING:
    import rerun as rr

Report = Callable[[Answer], None]
# Application id of the recordings in Rerun.
NAME = 'physsim'
# Period of Rerun's batcher [s].
TICK = 0.1
# Rerun (0.41) warns of each `FileSink` that writes no footer, and `FileEndpoint` says why none
# does. It reads this as it is imported; 'warn' is its own default. To go with a setting of the
# sink.
os.environ.setdefault('RUST_LOG', 'warn,re_log_encoding::rrd::file_sink=error')


class Sink:
    """
    A recording stream of Rerun, and the recorder of frames on it.

    :param sinks: of Rerun, to which the stream is connected; empty for another connection
    :raises ConnectionError: a sink cannot be opened
    """

    def __init__(self, *sinks: rr.GrpcSink | rr.GrpcServerSink | rr.FileSink) -> None:
        # The first import takes a second, so it happens in the thread of the worker.
        from physsim_ros.view.recording import FrameRecorder
        import rerun as rr

        batching = rr.ChunkBatcherConfig(flush_tick=TICK)
        with RECORDING_LIST:
            self._recording = rr.RecordingStream(NAME, batcher_config=batching)
        try:
            if sinks:
                self._recording.set_sinks(*sinks)
        except RuntimeError as error:
            with RECORDING_LIST:
                del self._recording
            raise ConnectionError(error) from error
        self._recorder = FrameRecorder(self._recording)

    def draw(self, frames: Sequence[Frame], *, context: FrameContext) -> None:
        """Log frames in order."""
        self._recorder.draw(frames, context=context)

    def flush(self, timeout: float) -> None:
        """
        Wait until all logged frames have been sent.

        :raises TimeoutError: they have not been sent yet
        :raises ConnectionError: they cannot be sent any more
        """
        try:
            self._recording.flush(timeout_sec=timeout)
        except RuntimeError as error:
            # Rerun (0.41) raises RuntimeError for both.
            if 'timed out' in str(error):
                raise TimeoutError(error) from error
            raise ConnectionError(error) from error

    def close(self) -> None:
        """Close the stream; waits for a receiver that takes nothing, until that ends."""
        from rerun_bindings import flush_and_cleanup_orphaned_recordings

        self._recording.disconnect()
        # Rerun (0.41) disconnects on a thread of the recording, which needs the interpreter's lock
        # to free what was logged.
        with suppress(RuntimeError):
            self._recording.flush()
        with RECORDING_LIST:
            # Rerun (0.41) ends the two threads of a recording only here (rerun-io/rerun#2116).
            del self._recorder, self._recording
            flush_and_cleanup_orphaned_recordings()


class Endpoint(ABC):
    """
    The receiver of a sink: a file, a server, or a program on this machine.

    :cvar kind: name of it, for messages
    :cvar where: address of it, for messages
    :cvar code: of the event when it is lost
    :cvar period: time for which frames are gathered into a batch [s]
    :cvar capacity: greatest number of frames in the queue
    :cvar patience: time without an answer after which that is reported [s]; an endpoint that does
        not reopen is lost then
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
