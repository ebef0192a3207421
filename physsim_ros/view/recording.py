# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The recording of frames: the world with its words, the plots and the log, and the layout of these.

Laws: constant components are static, since a server never drops those. Components that change
only with the scene are sent when it changes, and every `REPEAT` seconds. Positions are sent for
many frames at once, in one entity for all bodies that look alike. The bounds of the view of the
world never change; the camera moves instead, so that a user's pan and zoom persist.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Frame
from physsim_ros.view import arrows, bodies, events, robots, time_track
from physsim_ros.view.frame_batch import Change, FrameBatch, RECORDED, RecordedClock, Track
from physsim_ros.view.frame_context import FrameContext
from physsim_ros.view.joints import Joints
from physsim_ros.view.plots import plot_views, Plots
from physsim_ros.view.preview import PreviewLines
from physsim_ros.view.scenery import CAMERA, HEIGHT, PAPER, Scenery, WIDTH
from physsim_ros.view.stream import send_blueprint
import rerun as rr
import rerun.blueprint as rrb

# Period of sending geometry again [s]: a server at its memory limit drops old rows.
REPEAT = 30.0
# Time span of the paths of robots [s]: they have ten rows a second.
_DRIVEN = 30.0


class FrameRecorder:
    """
    Logs frames.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._clock = RecordedClock()
        self._last: Frame | None = None
        self._scene: Scene | None = None
        # Poses of the bodies that were sent last.
        self._poses: Floats = np.empty((0, 3))
        self._title = ''
        # Whether the layout has a real-time factor; None before there is one.
        self._paced: bool | None = None
        self._scenery = Scenery(recording)
        self._plots = Plots(recording)
        self._tracks: list[Track] = [
            bodies.Bodies(recording),
            bodies.BodyTexts(recording, bodies.NAMES, lambda scene: scene.names),
            bodies.BodyTexts(
                recording, bodies.WORDS, lambda scene: [each.label for each in scene.bodies]
            ),
            Joints(recording),
            arrows.ContactArrows(recording),
            arrows.VelocityArrows(recording),
            arrows.AppliedArrows(recording),
            robots.ScanPoints(recording),
            robots.RobotPaths(recording),
            PreviewLines(recording),
            events.EventLog(recording),
            time_track.TimeTrack(recording),
            time_track.TimeLabel(recording),
            self._plots,
        ]

    @property
    def recorded(self) -> int:
        """Time of the last frame on the timeline `recorded` [ns]."""
        return self._clock.recorded

    def log(self, frames: Sequence[Frame], *, context: FrameContext) -> None:
        """
        Log frames, except those that are equal to the one before.

        :param frames: in order; their arrays are not changed any more
        :param context: of now
        """
        paced = context.real_time_factor is not None
        if frames and paced is not self._paced:
            self._paced = paced
            send_blueprint(self._recording, blueprint(paced=paced))
        if frames and context.title != self._title:
            self._title = context.title
            self._recording.send_recording_name(self._title)
        fresh = []
        for frame in frames:
            if self._is_new(frame):
                fresh.append(frame)
                self._last = frame
        batch = None
        for batch in self._clock.batches(fresh):
            self._log_batch(batch)
        if batch is not None:
            self._plots.send_pace(batch, context.real_time_factor or 0.0)

    def _is_new(self, frame: Frame) -> bool:
        if self._last is None or frame.stepped or frame.answers or frame.speed != self._last.speed:
            return True
        before, now = self._last.snapshot, frame.snapshot
        if frame.preview != self._last.preview or now.scene is not before.scene:
            return True
        return not np.array_equal(now.poses, before.poses)

    def _log_batch(self, batch: FrameBatch) -> None:
        scene, first = batch.scene, batch.frames[0].snapshot
        everything = bool(batch.due(REPEAT))
        changed = everything or scene is not self._scene
        if changed:
            self._scene = scene
            self._scenery.aim(first)
            self._scenery.send(scene.settings.bounds, batch.times_at([0]))
            moved = np.ones(len(scene.bodies), dtype=bool)
        else:
            moved = (batch.poses != self._poses).any(axis=(0, 2))
        self._poses = batch.poses[-1]
        change = Change(self._scenery.unit, changed, everything, moved)
        for track in self._tracks:
            track.send(batch, change)


def blueprint(*, paced: bool) -> rrb.Blueprint:
    """
    Return the layout of the viewer: the world, the plots beside it, time and log below.

    :param paced: whether there is a real-time factor
    """
    path = rrb.VisibleTimeRanges(
        timeline=RECORDED,
        start=rrb.TimeRangeBoundary.cursor_relative(seconds=-_DRIVEN),
        end=rrb.TimeRangeBoundary.cursor_relative(),
    )
    # Shown by a click on the eye in the panel of the blueprint.
    hidden = rrb.EntityBehavior(visible=False)
    world = rrb.Spatial2DView(
        origin=CAMERA,
        contents='world/**',
        name='World',
        background=PAPER,
        visual_bounds=rrb.VisualBounds2D(x_range=(0, WIDTH), y_range=(0, HEIGHT)),
        overrides={
            robots.TRUTH: [path],
            robots.ODOMETRY: [path],
            bodies.NAMES: [hidden],
            arrows.VELOCITIES: [hidden],
        },
    )
    below = rrb.Horizontal(time_track.time_view(), events.log_view(), column_shares=[1, 2])
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(world, below, row_shares=[4, 1]),
            rrb.Vertical(*plot_views(paced=paced)),
            column_shares=[3, 1],
        ),
        rrb.BlueprintPanel(state='collapsed'),
        rrb.SelectionPanel(state='collapsed'),
        rrb.TimePanel(state='collapsed', timeline=RECORDED, play_state='following'),
    )
