# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A recording stream of Rerun as a sink: to a file, to a server, or to memory."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING

from physsim_ros.model.snapshot import Frame
from physsim_ros.view.frame_context import FrameContext

if TYPE_CHECKING:
    import rerun as rr

# Application id of the recordings in Rerun.
NAME = 'physsim'
# Period of Rerun's batcher [s].
TICK = 0.1


class RerunSink:
    """
    A recording stream of Rerun, and the recorder of frames on it.

    :param sinks: of Rerun, that the stream is connected to; none for another connection
    :raises ConnectionError: one of them cannot be opened
    """

    def __init__(self, *sinks: rr.GrpcSink | rr.GrpcServerSink | rr.FileSink) -> None:
        # The first import takes a second, so it happens in the thread of the worker.
        from physsim_ros.view.recording import FrameRecorder
        import rerun as rr

        batching = rr.ChunkBatcherConfig(flush_tick=TICK)
        self._recording = rr.RecordingStream(NAME, batcher_config=batching)
        try:
            if sinks:
                self._recording.set_sinks(*sinks)
        except RuntimeError as error:
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
        # to free what was logged; the cleanup below would wait for it and keep that lock.
        with suppress(RuntimeError):
            self._recording.flush()
        # Rerun (0.41) ends the two threads of a recording only here (rerun-io/rerun#2116).
        del self._recorder, self._recording
        flush_and_cleanup_orphaned_recordings()
