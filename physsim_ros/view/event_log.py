# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The log of answers and events: code and subject first, then the sentence."""

from __future__ import annotations

from physsim_ros.model.snapshot import Answer
from physsim_ros.view.frame_batch import FrameBatch, RECORDED
import rerun as rr
import rerun.blueprint as rrb

PATH = 'events'


def send_events(recording: rr.RecordingStream, batch: FrameBatch) -> None:
    """Send the answers of the frames of a batch."""
    rows = [
        (index, answer) for index, frame in enumerate(batch.frames) for answer in frame.answers
    ]
    if rows:
        columns = rr.TextLog.columns(
            text=[line(answer) for _, answer in rows],
            level=['ERROR' if answer.code else 'INFO' for _, answer in rows],
        )
        recording.send_columns(PATH, batch.times_at([index for index, _ in rows]), columns)


def line(answer: Answer) -> str:
    """Return the line of an answer."""
    words = (answer.code, answer.subject, answer.message, f'({answer.topic})')
    return '  '.join(filter(None, words))


def log_view() -> rrb.TextLogView:
    """Return the view of the log, for the blueprint."""
    return rrb.TextLogView(
        origin=PATH,
        name='Log',
        columns=rrb.TextLogColumns(
            timeline_columns=[RECORDED], text_log_columns=['loglevel', 'body']
        ),
    )
