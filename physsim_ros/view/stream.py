# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A recording stream of Rerun: to a file or to a server.

Rerun (0.41) has a list of the recordings and blueprints of the process behind a mutex. Making one
waits for that mutex and keeps the interpreter's lock meanwhile; the cleanup of those that are
closed keeps the mutex until all others are flushed; and a file's writer needs the interpreter's
lock to free what it has written. Three threads that do these at once wait for each other for ever.

Law: a recording or blueprint is made, dropped and cleaned up under `RECORDING_LIST`. Whoever waits
for it gives the interpreter's lock away.
"""

from __future__ import annotations

from contextlib import suppress
import os
from threading import Lock
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import rerun as rr
    import rerun.blueprint as rrb

RECORDING_LIST = Lock()
# Application id of the recordings in Rerun.
NAME = 'physsim'
# Period of Rerun's batcher [s].
TICK = 0.1
# Rerun (0.41) warns of each `FileSink` that writes no footer, and `FileEndpoint` says why none
# does. It reads this as it is imported; 'warn' is its own default. To go with a setting of the
# sink.
os.environ.setdefault('RUST_LOG', 'warn,re_log_encoding::rrd::file_sink=error')


class RerunStream:
    """
    A recording stream of Rerun that is connected to a sink.

    :param sink: of Rerun
    :raises ConnectionError: it cannot be opened

    :ivar recording: stream to log to
    """

    def __init__(self, sink: rr.GrpcSink | rr.GrpcServerSink | rr.FileSink) -> None:
        import rerun as rr

        batching = rr.ChunkBatcherConfig(flush_tick=TICK)
        with RECORDING_LIST:
            self.recording = rr.RecordingStream(NAME, batcher_config=batching)
        try:
            self.recording.set_sinks(sink)
        except RuntimeError as error:
            with RECORDING_LIST:
                del self.recording
            raise ConnectionError(error) from error

    def flush(self) -> None:
        """
        Wait until all that was logged has been sent, without end where nothing is taken.

        Rerun (0.41) gives the interpreter's lock away meanwhile. Logging more would fill its
        buffers, of some 400 MB, before that blocks.

        :raises ConnectionError: it cannot be sent any more
        """
        try:
            self.recording.flush()
        except RuntimeError as error:
            raise ConnectionError(error) from error

    def close(self) -> None:
        """
        Close the stream; waits for a receiver that takes nothing, until that ends.

        Called when nothing else refers to `recording` any more.
        """
        from rerun_bindings import flush_and_cleanup_orphaned_recordings

        self.recording.disconnect()
        # Rerun (0.41) disconnects on a thread of the recording, which needs the interpreter's lock
        # to free what was logged.
        with suppress(RuntimeError):
            self.recording.flush()
        with RECORDING_LIST:
            # Rerun (0.41) ends the two threads of a recording only here (rerun-io/rerun#2116).
            del self.recording
            flush_and_cleanup_orphaned_recordings()


def send_blueprint(recording: rr.RecordingStream, blueprint: rrb.Blueprint) -> None:
    """
    Make a blueprint the active one of a recording, and the default one.

    `RecordingStream.send_blueprint` of Rerun (0.41) leaks: it makes a recording with a memory
    sink, and both keep each other, with two threads, until the process ends. This function can go
    when they do not any more.
    """
    import rerun as rr
    import rerun_bindings as bindings

    with RECORDING_LIST:
        stream = rr.RecordingStream._from_native(  # noqa: SLF001  as Rerun does it
            bindings.new_blueprint(
                application_id=rr.get_application_id(recording) or '',
                make_default=False,
                make_thread_default=False,
                default_enabled=True,
            )
        )
    stream.set_time('blueprint', sequence=0)
    blueprint._log_to_stream(stream)  # noqa: SLF001  the same
    storage = stream.memory_recording().storage
    bindings.send_blueprint(storage, True, True, recording=recording.to_native())
    # Without its sink nothing keeps the recording.
    stream.disconnect()
    with RECORDING_LIST:
        del stream
