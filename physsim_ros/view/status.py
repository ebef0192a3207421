# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Words in the picture: simulation time, speed, and whether the world is in the past."""

from __future__ import annotations

from physsim_ros.model.snapshot import Frame
from physsim_ros.view import styles
from physsim_ros.view.frame_batch import FrameBatch
import rerun as rr

# In pixels of the image of the camera, so that they stay when the camera moves.
PATH = 'world/camera/status'
# Period of the words [frames]: ten times a second is legible.
SAMPLE = 6
# Middle of the upper edge of the words [pixels].
_AT = (110.0, 6.0)


class Status:
    """
    Sends the words.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._words = ''
        recording.log(PATH, styles.IMAGE_LABELS, static=True)
        recording.log(PATH, rr.Points2D.from_fields(positions=[_AT]), static=True)

    def send(self, batch: FrameBatch) -> None:
        """Send the words of every `SAMPLE`-th frame, and where the run state changes."""
        words = [(index, status_words(frame)) for index, frame in enumerate(batch.frames)]
        chosen = set(batch.sampled(SAMPLE))
        rows = []
        for index, text in words:
            if index in chosen or text.split('  ')[1:] != self._words.split('  ')[1:]:
                rows.append((index, text))
                self._words = text
        labels = rr.Points2D.columns(labels=[text for _, text in rows])
        times = batch.times_at([index for index, _ in rows])
        self._recording.send_columns(PATH, times, labels)


def status_words(frame: Frame) -> str:
    """Return simulation time, speed, and whether the world is in the past."""
    words = [f'{frame.snapshot.stamp * 1e-9:.2f} s', _speed_words(frame.speed)]
    return '  '.join([*words, *(['in the past'] if frame.past else [])])


def _speed_words(speed: float) -> str:
    if speed == 0.0:
        return 'paused'
    factor = f'\N{MULTIPLICATION SIGN} {abs(speed):g}'
    return factor if speed > 0.0 else f'{factor} back'
