# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The recording of frames: the world, the words in it, the plots and the log, as columns in Rerun.

Laws: constant components are static, since a server never drops those. Components that change
only with the scene are sent when it changes, and every `REPEAT` frames. Positions are sent for
many frames at once, in one entity for all bodies that look alike.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from physsim_ros.model.arrays import Floats, Singles
from physsim_ros.model.settings import Bounds
from physsim_ros.model.snapshot import Frame
from physsim_ros.view import grid, styles
from physsim_ros.view.arrows import ContactArrows, force_scale, VelocityArrows
from physsim_ros.view.blueprint import blueprint, send_blueprint
from physsim_ros.view.body_texts import BodyTexts, LABELS_PATH, NAMES_PATH
from physsim_ros.view.camera import Camera, pinhole
from physsim_ros.view.event_log import send_events
from physsim_ros.view.frame_batch import FrameBatch, RecordedClock
from physsim_ros.view.frame_context import FrameContext
from physsim_ros.view.hand_lines import HandLines
from physsim_ros.view.joints import JointTrack
from physsim_ros.view.legend import Legend
from physsim_ros.view.meshes.body_geometry import BodyGeometry, DEPTH
from physsim_ros.view.meshes.mesh_track import MeshTrack
from physsim_ros.view.plots import Plots
from physsim_ros.view.preview_lines import PreviewLines
from physsim_ros.view.robot_ways import RobotWays
from physsim_ros.view.scan_points import ScanPoints
from physsim_ros.view.status import Status
from physsim_ros.view.time_tracks import TimeTracks
from physsim_ros.view.traces import Traces
import rerun as rr

# Period of sending geometry again [frames]: a server at its memory limit drops old rows.
REPEAT = 1800
# Half the thickness of the walls [units].
WALL_HALF = 0.1
WALL = (89, 94, 102)
WALLS = 'world/walls'
# Heights above the plane, over all bodies [units].
_JOINTS, _ARROWS, _PREVIEW, _TEXTS = (DEPTH + each for each in (0.01, 0.02, 0.03, 0.04))


class FrameRecorder:
    """
    Logs frames.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._clock = RecordedClock()
        self._due = 0
        self._last: Frame | None = None
        self._title = ''
        self._geometry: BodyGeometry | None = None
        self._camera = Camera()
        # Poses of the bodies that were sent last.
        self._poses: Floats = np.empty((0, 3))
        # Whether there is a real-time factor, and whether bodies are traced, in the layout.
        self._layout: tuple[bool, bool] | None = None
        recording.log('world/camera', pinhole(), static=True)
        recording.log(WALLS, rr.Mesh3D.from_fields(albedo_factor=WALL), static=True)
        recording.log(grid.LABELS, styles.LABELS, static=True)
        self._bodies = MeshTrack(recording)
        self._texts = (
            BodyTexts(recording, NAMES_PATH, lambda scene: scene.names),
            BodyTexts(recording, LABELS_PATH, lambda scene: [each.label for each in scene.bodies]),
        )
        self._joints = JointTrack(recording)
        self._contacts = ContactArrows(recording)
        self._velocities = VelocityArrows(recording)
        self._traces = Traces(recording)
        self._scans = ScanPoints(recording)
        self._ways = RobotWays(recording)
        self._hands = HandLines(recording)
        self._previews = PreviewLines(recording)
        self._time_tracks = TimeTracks(recording)
        self._plots = Plots(recording)
        self._status = Status(recording)
        self._legend = Legend(recording)

    @property
    def recorded(self) -> int:
        """Time of the last frame on the timeline `recorded` [ns]."""
        return self._clock.recorded

    def draw(self, frames: Sequence[Frame], *, context: FrameContext) -> None:
        """
        Log frames, except those that are equal to the one before.

        :param frames: in order; their arrays are not changed any more
        :param context: of the last frame
        """
        layout = context.cost is not None, bool(context.traced)
        if frames and layout != self._layout:
            self._layout = layout
            send_blueprint(self._recording, blueprint(paced=layout[0], traced=layout[1]))
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
            self._draw_batch(batch, context)
        if batch is not None:
            self._plots.send_pace(batch, context)

    def _is_new(self, frame: Frame) -> bool:
        if self._last is None or frame.moved or frame.answers or frame.speed != self._last.speed:
            return True
        before, now = self._last.snapshot, frame.snapshot
        if frame.preview != self._last.preview or now.grips != before.grips:
            return True
        return now.scene is not before.scene or not np.array_equal(now.poses, before.poses)

    def _draw_batch(self, batch: FrameBatch, context: FrameContext) -> None:
        bodies = self._geometry
        repeat = due = batch.numbers.start >= self._due
        if bodies is None or batch.scene is not bodies.scene:
            bodies, due = self._change_scene(batch), True
        if due:
            moved = np.ones(len(batch.scene.bodies), dtype=bool)
        else:
            moved = (batch.poses != self._poses).any(axis=(0, 2))
        if repeat:
            self._due = batch.numbers.start + REPEAT
        self._poses = batch.poses[-1]
        unit = bodies.unit
        # Before the meshes: a viewer that draws in between shows no body at the origin.
        self._bodies.send_poses(bodies.groups, batch.poses, batch.times, moved)
        if due:
            self._send_geometry(batch, bodies, everything=repeat)
        for texts in self._texts:
            texts.send_places(batch, moved, _TEXTS * unit)
        self._joints.send(batch, moved)
        self._contacts.send(batch, self._forces, height=_ARROWS * unit)
        self._velocities.send(batch, height=_ARROWS * unit)
        self._traces.send(batch, context.traced, _JOINTS * unit)
        self._scans.send(batch, _ARROWS * unit)
        self._ways.send(batch, _JOINTS * unit)
        self._hands.send(batch, _PREVIEW * unit)
        self._previews.send(batch, unit=unit, height=_PREVIEW * unit, repeat=REPEAT)
        self._plots.send(batch)
        send_events(self._recording, batch)
        self._time_tracks.send(batch)
        self._status.send(batch)

    def _change_scene(self, batch: FrameBatch) -> BodyGeometry:
        """Return the geometry of another scene, with the camera over it."""
        scene, before = batch.scene, self._geometry
        unit = self._camera.unit
        if scene.settings.bounds is not None:
            self._camera.show_bounds(scene.settings.bounds)
        elif scene.bodies:
            extent = BodyGeometry(scene, unit, before).extent(batch.poses[0])
            self._camera.show_bodies(extent, batch.frames[0].snapshot.ends)
        unit = self._camera.unit
        symbols = self._joints.change_scene(scene, unit, _JOINTS * unit)
        self._geometry = BodyGeometry(scene, unit, before, symbols)
        return self._geometry

    def _send_geometry(self, batch: FrameBatch, bodies: BodyGeometry, *, everything: bool) -> None:
        """Send the components that change only with the scene."""
        times = batch.times_at([0])
        self._bodies.send_meshes(bodies.groups, times, everything=everything)
        for texts in self._texts:
            texts.send_texts(batch)
        self._joints.send_symbols(times, everything=everything)
        corners = wall_corners(batch.scene.settings.bounds, bodies.unit)
        walls = rr.Mesh3D.columns(vertex_positions=corners).partition([len(corners)])
        self._recording.send_columns(WALLS, times, walls)
        self._recording.send_columns('world/camera', times, self._camera.transform())
        lines, labels = grid.grid_columns(self._camera.area, bodies.unit)
        self._recording.send_columns(grid.LINES, times, lines)
        self._recording.send_columns(grid.LABELS, times, labels)
        self._forces = force_scale(batch.scene, bodies.unit)
        self._legend.send(batch, self._forces, bodies.unit)


def wall_corners(bounds: Bounds | None, unit: float) -> Singles:
    """Return the triangles of bars just outside the bounds, (24, 3) float32 [m]."""
    if bounds is None:
        return np.empty((0, 3), dtype=np.float32)
    left, bottom, right, top = bounds
    thick = 2 * WALL_HALF * unit
    outer = (left - thick, bottom - thick, right + thick, top + thick)
    bars = (
        (outer[0], outer[1], outer[2], bottom),
        (outer[0], top, outer[2], outer[3]),
        (outer[0], bottom, left, top),
        (right, bottom, outer[2], top),
    )
    corners = [
        (x, y, 0.0)
        for x1, y1, x2, y2 in bars
        for x, y in ((x1, y1), (x2, y1), (x2, y2), (x1, y1), (x2, y2), (x1, y2))
    ]
    return np.array(corners, dtype=np.float32)
