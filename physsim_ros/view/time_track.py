# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The track of time, which tells how time went by, and its label in the view of the world.

Law: a word of the track stays until the next one, so that it can be read.
"""

from __future__ import annotations

from physsim_ros.model.snapshot import Frame
from physsim_ros.view.frame_batch import Change, FrameBatch
from physsim_ros.view.scenery import IMAGE_LABELS
import rerun as rr
import rerun.blueprint as rrb

TIME = 'time/run'
# In the view of the world, which may fill the window: the time and the word of the track.
_LABEL = 'world/camera/legend/time'
# Place of the label [pixels of the image of the camera], and period of its rows [s].
_LABEL_AT, _LABEL_PERIOD = (1150.0, 14.0), 0.1
# Green while playing, orange while rewinding; the faster, the darker.
_COLORS = {
    'slow': (160, 205, 150),
    'play': (84, 162, 75),
    'fast': (40, 110, 40),
    'pause': (150, 150, 150),
    'slowly back': (250, 190, 125),
    'back': (245, 133, 24),
    'fast back': (190, 80, 10),
    'past': (62, 73, 137),
}


class TimeTrack:
    """
    Sends how time goes by.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._state = ''
        words, colors = list(_COLORS), list(_COLORS.values())
        recording.log(TIME, rr.StateConfiguration(values=words, colors=colors), static=True)

    def send(self, batch: FrameBatch, _: Change) -> None:
        """Send the states of a batch that differ from the one before."""
        for index, frame in enumerate(batch.frames):
            state = time_word(frame)
            if state != self._state:
                self._state = state
                column = rr.StateChange.columns(state=[state])
                self._recording.send_columns(TIME, batch.times_at([index])[:1], column)


class TimeLabel:
    """
    Sends simulation time and how it goes by, as a label in the image of the world.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        recording.log(_LABEL, IMAGE_LABELS, static=True)

    def send(self, batch: FrameBatch, _: Change) -> None:
        """Send the label of some frames of a batch."""
        chosen = batch.sampled(_LABEL_PERIOD)
        frames = [batch.frames[index] for index in chosen]
        labels = [f'{each.snapshot.stamp / 1e9:.2f} s  {time_word(each)}' for each in frames]
        points = rr.Points2D.columns(positions=[_LABEL_AT] * len(chosen), labels=labels)
        self._recording.send_columns(
            _LABEL, batch.times_at(chosen), points.partition([1] * len(chosen))
        )


def time_word(frame: Frame) -> str:
    """Return the word for how time goes by: whether the past is played, else by the speed."""
    pace = abs(frame.speed)
    if pace == 0.0:
        return 'pause'
    if frame.speed < 0.0:
        return 'back' if pace == 1.0 else 'fast back' if pace > 1.0 else 'slowly back'
    if frame.past:
        return 'past'
    return 'play' if pace == 1.0 else 'fast' if pace > 1.0 else 'slow'


def time_view() -> rrb.StateTimelineView:
    """Return the view of the track, for the blueprint."""
    return rrb.StateTimelineView(origin='time', name='Time')
