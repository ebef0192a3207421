# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
