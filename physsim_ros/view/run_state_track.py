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

"""The track of run states and branches of time, a state timeline in Rerun."""

from __future__ import annotations

from collections.abc import Sequence

from physsim_ros.model.snapshot import Frame
import rerun as rr
import rerun.blueprint as rrb

# Green while playing, orange while rewinding; the faster, the darker.
_COLORS = {
    'playing slowly': (160, 205, 150),
    'playing': (84, 162, 75),
    'playing fast': (40, 110, 40),
    'paused': (150, 150, 150),
    'rewinding slowly': (250, 190, 125),
    'rewinding': (245, 133, 24),
    'rewinding fast': (190, 80, 10),
}
# Topics of answers after which a new branch of time begins.
_BRANCHING = {'branch', '~/undo', '~/redo', '~/reset'}


class RunStateTrack:
    """
    Logs run states and branches of time.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._state = ''
        self._branches = 0
        styles = rr.StateConfiguration(values=list(_COLORS), colors=list(_COLORS.values()))
        recording.log('time/run', styles, static=True)

    def draw(self, frames: Sequence[Frame], numbers: Sequence[int]) -> None:
        """
        Log the changes of run state and branch in frames.

        :param numbers: of the frames, on the timeline `frame`, which never goes back
        """
        for frame, number in zip(frames, numbers, strict=True):
            state = _state(frame.speed)
            if state != self._state:
                self._state = state
                self._send('time/run', state, number)
            branching = [answer for answer in frame.answers if answer.topic in _BRANCHING]
            if branching or self._branches == 0:
                self._branches += 1
                reason = f': {branching[-1].message}' if branching else ''
                self._send('time/course', f'{self._branches}{reason}', number)

    def _send(self, path: str, state: str, number: int) -> None:
        time = [rr.TimeColumn('frame', sequence=[number])]
        self._recording.send_columns(path, time, rr.StateChange.columns(state=[state]))


def _state(speed: float) -> str:
    """Return the name of the run state of a speed; Rerun has one colour for each."""
    if speed == 0.0:
        return 'paused'
    direction, pace = 'playing' if speed > 0.0 else 'rewinding', abs(speed)
    if pace == 1.0:
        return direction
    return f'{direction} fast' if pace > 1.0 else f'{direction} slowly'


def run_state_view() -> rrb.StateTimelineView:
    """Return the view of the track, for the blueprint."""
    return rrb.StateTimelineView(origin='time', name='Time')
