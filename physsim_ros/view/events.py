# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Events: the log of answers, and the tracks of time: run states, courses, past, the last change.

Law: a word of a track is short and stays until the next one, so that it can be read. Sentences are
in the log, after code and subject.
"""

from __future__ import annotations

from dataclasses import fields

from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Answer, Frame
from physsim_ros.view.frame_batch import Change, FrameBatch, RECORDED
import rerun as rr
import rerun.blueprint as rrb

LOG = 'events'
RUN, PAST, COURSE = 'time/run', 'time/past', 'time/course'
CHANGE = 'time/last_change'
# Green while playing, orange while rewinding; the faster, the darker. No colour is in two tracks.
_RUN_COLORS = {
    'slow': (160, 205, 150),
    'play': (84, 162, 75),
    'fast': (40, 110, 40),
    'pause': (150, 150, 150),
    'slowly back': (250, 190, 125),
    'back': (245, 133, 24),
    'fast back': (190, 80, 10),
}
_PAST_COLORS = {'present': (215, 225, 238), 'past': (62, 73, 137)}
# Of courses in turn: blues, violets and browns.
_COURSE_COLORS = (
    (76, 120, 168),
    (178, 121, 162),
    (157, 117, 93),
    (114, 183, 178),
    (121, 112, 196),
    (219, 166, 192),
)
# Of changes in turn, so that neighbours differ: reds.
_CHANGE_COLORS = ((228, 87, 86), (170, 50, 70), (240, 140, 130))
# Topics of answers to what changes the world, and the word of each.
_CHANGES = {
    '~/load_world': 'load',
    '~/reset': 'reset',
    '~/clear': 'clear',
    '~/undo': 'undo',
    '~/redo': 'redo',
    'branch': 'branch',
    '~/timeline': 'return',
    'divergence': 'divergence',
}


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


class TimeTracks:
    """
    Sends run states, past and present, courses and changes.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._states: dict[str, str] = {}
        self._settings: WorldSettings | None = None
        self._styles: dict[str, dict[str, tuple[int, int, int]]] = {}
        self._style(RUN, _RUN_COLORS)
        self._style(PAST, _PAST_COLORS)

    def send(self, batch: FrameBatch, _: Change) -> None:
        """Send the changes in the frames of a batch."""
        for index, frame in enumerate(batch.frames):
            times = batch.times_at([index])[:1]
            self._send(RUN, speed_word(frame.speed), times)
            self._send(PAST, 'past' if frame.past else 'present', times)
            color = _COURSE_COLORS[(frame.course - 1) % len(_COURSE_COLORS)]
            self._style(COURSE, {str(frame.course): color})
            self._send(COURSE, str(frame.course), times)
            if words := self._changes(frame):
                known = self._styles.setdefault(CHANGE, {})
                self._style(CHANGE, {words: _CHANGE_COLORS[len(known) % len(_CHANGE_COLORS)]})
                self._states.pop(CHANGE, None)  # Also the second of two that are alike.
                self._send(CHANGE, words, times)

    def _changes(self, frame: Frame) -> str:
        """Return the words for what changed the world in a frame."""
        topics = [answer.topic for answer in frame.answers if not answer.code]
        words = [_CHANGES[topic] for topic in topics if topic in _CHANGES]
        settings, before = frame.snapshot.scene.settings, self._settings
        if before is not None and settings is not before:
            words += [
                each.name
                for each in fields(settings)
                if getattr(settings, each.name) != getattr(before, each.name)
            ]
        self._settings = settings
        return ', '.join(dict.fromkeys(words))

    def _style(self, path: str, colors: dict[str, tuple[int, int, int]]) -> None:
        """Log the colours of states that are new; those of other states of the track stay."""
        known = self._styles.setdefault(path, {})
        if colors.keys() <= known.keys():
            return
        known.update(colors)
        style = rr.StateConfiguration(values=list(known), colors=list(known.values()))
        self._recording.log(path, style, static=True)

    def _send(self, path: str, state: str, times: list[rr.TimeColumn]) -> None:
        """Send a state that differs from the one before."""
        if self._states.get(path) != state:
            self._states[path] = state
            column = rr.StateChange.columns(state=[state])
            self._recording.send_columns(path, times, column)


def speed_word(speed: float) -> str:
    """Return the word for a speed; Rerun has one colour for each."""
    if speed == 0.0:
        return 'pause'
    pace = abs(speed)
    if speed > 0.0:
        return 'play' if pace == 1.0 else 'fast' if pace > 1.0 else 'slow'
    return 'back' if pace == 1.0 else 'fast back' if pace > 1.0 else 'slowly back'


def time_view() -> rrb.StateTimelineView:
    """Return the view of the tracks, for the blueprint."""
    return rrb.StateTimelineView(origin='time', name='Time')
