# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The pages that show a recording: each is sent one of its own, which begins when it opens.

Law: a page is sent the next batch when it shows the one before. So it is late by one of its own
frames, and nothing piles up in the browser; frames for which the page is too slow are dropped
here. The web viewer of Rerun (0.41) reads for 10 ms in each of its frames. Without a graphics card
these take half a second, so that it could not follow a stream that does not wait.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from physsim_ros.model.snapshot import Frame
from physsim_ros.view.frame_context import FrameContext
from physsim_ros.view.sinks.sink import Endpoint, Sink

# Takes a batch as bytes of an `.rrd` file, and the time of its last frame on the timeline
# `recorded` [ns]. Called on the thread of a worker.
Send = Callable[[bytes, int], None]


class PageEndpoint(Endpoint):
    """
    A page.

    :param send: sends it a batch
    """

    kind, where = 'page', 'the recording in a browser'
    # A second of frames; a page that draws slower misses frames.
    period, capacity, closing, reopens = 1 / 60, 60, 0.5, False

    def __init__(self, send: Send) -> None:
        self._send = send
        self._awaited = -1

    def open_sink(self) -> Sink:
        """Return a recording that is sent to the page."""
        return _PageSink(self._send_batch)

    @property
    def is_ready(self) -> bool:
        """Whether the page shows all that it was sent."""
        return self._awaited < 0

    def note_shown(self, recorded: int) -> None:
        """
        Note which frame the page shows; called on any thread.

        :param recorded: time of the frame on the timeline `recorded` [ns]
        """
        if recorded >= self._awaited:
            self._awaited = -1

    def _send_batch(self, batch: bytes, recorded: int) -> None:
        self._awaited = recorded
        self._send(batch, recorded)


class _PageSink(Sink):
    """A recording in memory, of which each batch is sent as soon as it is logged."""

    def __init__(self, send: Send) -> None:
        import rerun as rr

        super().__init__()
        self._bytes = rr.binary_stream(self._recording)
        self._send = send

    def draw(self, frames: Sequence[Frame], *, context: FrameContext) -> None:
        """Log and send frames."""
        super().draw(frames, context=context)
        batch = self._bytes.read()
        if batch:
            self._send(batch, self._recorder.recorded)

    def close(self) -> None:
        """Close the stream."""
        del self._bytes
        super().close()
