# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Events: the log of answers, a line each: code, subject, sentence, topic."""

from __future__ import annotations

from physsim_ros.model.answer import Answer
from physsim_ros.view.frame_batch import Change, FrameBatch, RECORDED
import rerun as rr
import rerun.blueprint as rrb

LOG = 'events'


class EventLog:
    """
    Sends the answers of frames.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording

    def send(self, batch: FrameBatch, _: Change) -> None:
        """Send the answers of a batch."""
        rows = [
            (index, answer) for index, frame in enumerate(batch.frames) for answer in frame.answers
        ]
        if rows:
            columns = rr.TextLog.columns(
                text=[line(answer) for _, answer in rows],
                level=['ERROR' if answer.code else 'INFO' for _, answer in rows],
            )
            times = batch.times_at([index for index, _ in rows])
            self._recording.send_columns(LOG, times, columns)


def line(answer: Answer) -> str:
    """Return the line of an answer."""
    words = (answer.code, answer.subject, answer.message, f'({answer.topic})')
    return '  '.join(filter(None, words))


def log_view() -> rrb.TextLogView:
    """Return the view of the log, for the blueprint."""
    return rrb.TextLogView(
        origin=LOG,
        name='Log',
        columns=rrb.TextLogColumns(
            timeline_columns=[RECORDED], text_log_columns=['loglevel', 'body']
        ),
    )
