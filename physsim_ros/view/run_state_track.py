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

"""The band under the picture: what time did, frame by frame, and where it took another course."""

from __future__ import annotations

from collections.abc import Sequence

from physsim_ros.model.snapshot import Frame
import rerun as rr
import rerun.blueprint as rrb

# What plays is green, what goes back is orange; the faster, the darker.
_COLORS = {
    'playing slowly': (160, 205, 150),
    'playing': (84, 162, 75),
    'playing fast': (40, 110, 40),
    'paused': (150, 150, 150),
    'rewinding slowly': (250, 190, 125),
    'rewinding': (245, 133, 24),
    'rewinding fast': (190, 80, 10),
}
# Events after which things go on differently from before.
_TURNS = {'branch', '~/undo', '~/redo', '~/reset'}


class Band:
    """
    Draws run state and branches on a recording stream.

    :param recording: where to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._state = ''
        self._courses = 0
        styles = rr.StateConfiguration(values=list(_COLORS), colors=list(_COLORS.values()))
        recording.log('time/run', styles, static=True)

    def draw(self, frames: Sequence[Frame], numbers: Sequence[int]) -> None:
        """
        Draw what has changed in frames.

        :param numbers: of the frames, on the time line that never goes back
        """
        for frame, number in zip(frames, numbers, strict=True):
            state = _state(frame.speed)
            if state != self._state:
                self._state = state
                self._send('time/run', state, number)
            turns = [answer for answer in frame.answers if answer.topic in _TURNS]
            if turns or self._courses == 0:
                self._courses += 1
                said = f': {turns[-1].message}' if turns else ''
                self._send('time/course', f'{self._courses}{said}', number)

    def _send(self, path: str, state: str, number: int) -> None:
        time = [rr.TimeColumn('frame', sequence=[number])]
        self._recording.send_columns(path, time, rr.StateChange.columns(state=[state]))


def _state(speed: float) -> str:
    """Return which state of the band a speed is; Rerun has one colour for each."""
    if speed == 0.0:
        return 'paused'
    way, pace = 'playing' if speed > 0.0 else 'rewinding', abs(speed)
    return way if pace == 1.0 else f'{way} fast' if pace > 1.0 else f'{way} slowly'


def view() -> rrb.StateTimelineView:
    """Return the band's place in the layout."""
    return rrb.StateTimelineView(origin='time', name='Time')
