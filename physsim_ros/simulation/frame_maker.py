# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The frames of the moment that is shown.

Laws: a frame is made when it is first read after steps or requests; one that nobody reads is not
made, and the past has what is asked for later. Every answer is in one frame, the first after it.
"""

from __future__ import annotations

from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.sensing import SensedFrame
from physsim_ros.simulation.applier import Applier
from physsim_ros.simulation.past import Past
from physsim_ros.simulation.playback import Playback

# Simulation time at speed 1 after which a frame is made even if nobody reads it [s].
LONGEST_UNREAD = 1.0


class FrameMaker:
    """
    Makes the frames of the moment that is shown.

    :param past: of the world
    :param playback: the moment that is shown
    :param applier: with the answers of the next frame

    :ivar is_read: whether somebody reads each frame of `Ticks`; else one is made where something
        but the time has changed, and every `LONGEST_UNREAD`
    """

    def __init__(self, past: Past, playback: Playback, applier: Applier) -> None:
        self.is_read = True
        self._past = past
        self._playback = playback
        self._applier = applier
        self._sensed: SensedFrame | None = None
        # The last state before the next frame, where no frame of it was made.
        self._passed: Snapshot | None = None

    def make_if_changed(self) -> SensedFrame:
        """Return the frame of now as sensors see it, made as `make` does if it differs."""
        sensed = self._sensed
        return self._observe() if sensed is None or self.is_changed else sensed

    @property
    def is_changed(self) -> bool:
        """Whether the frame of now differs from the last one that was made."""
        sensed, playback = self._sensed, self._playback
        return playback.changed or sensed is None or sensed.snapshot.step != playback.step

    @property
    def is_due(self) -> bool:
        """Whether a frame of now is to be made, after steps."""
        sensed, past, playback = self._sensed, self._past, self._playback
        is_told = playback.changed or self._applier.has_answers or past.reports
        if self.is_read or is_told or sensed is None:
            return True
        most = LONGEST_UNREAD * past.physics_rate * max(1.0, abs(playback.speed))
        passed = abs(playback.step - sensed.snapshot.step)
        return passed >= most or playback.arrive().scene is not sensed.snapshot.scene

    def begin(self, *, keeps_before: bool = False) -> None:
        """
        Begin the contacts of the next frame, where no frame of now was made.

        :param keeps_before: whether the state before it is kept, also if nobody reads frames
        """
        if self._sensed is not None and self._sensed.snapshot.step != self._playback.step:
            world = self._playback.arrive()
            world.clear_contacts()
            if keeps_before or self.is_read:
                self._passed = world.snapshot()

    def forget(self) -> None:
        """Have the next frame be the first one of its world: there is none before it."""
        self._sensed = self._passed = None

    def show_again(self, frame: Frame, before: Snapshot | None) -> None:
        """
        Show a frame that was made before, of the same moment.

        :param before: snapshot of another time that was shown before it; None if there is none
        """
        self._sensed = SensedFrame(frame, before)
        self._playback.begin_frame()

    def make(self) -> Frame:
        """Make the frame of now, with all answers; fit the past into its budget."""
        return self._observe().frame

    def _observe(self) -> SensedFrame:
        past, playback = self._past, self._playback
        snapshot, contacts = playback.observe_frame()
        past.fit_memory(playback.moment)
        frame = Frame(
            snapshot=snapshot,
            contacts=contacts if past.reports_contacts else None,
            answers=(*self._applier.take_answers(), *past.take_reports()),
            speed=playback.speed,
            stepped=playback.stepped,
            past=not playback.is_newest,
            course=past.tree.course,
        )
        playback.begin_frame()
        before, last = self._passed, self._sensed
        if last is not None and (before is None or before.step == snapshot.step):
            before = last.snapshot if last.snapshot.step != snapshot.step else last.before
        self._passed, self._sensed = None, SensedFrame(frame, before)
        return self._sensed
