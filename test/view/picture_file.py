# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pictures that are drawn into a file, and what the file then holds."""

from __future__ import annotations

from dataclasses import dataclass, replace
import math

import numpy as np
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box
from physsim_ros.model.snapshot import Contacts, Frame, Snapshot
from physsim_ros.model.transform import cross
from physsim_ros.view import FrameContext
from physsim_ros.view.recording import FrameRecorder
import pytest

from ..building import PLAIN_BODY

rr = pytest.importorskip('rerun')
chunk = pytest.importorskip('rerun.chunk')

# Frames are four steps apart.
STEP_NS = 4_166_667
RED, BLUE = (0.8, 0.05, 0.1, 1.0), (0.1, 0.2, 0.8, 1.0)
# Half of one in 255 from rounding to bytes.
COLOR_TOLERANCE = 0.51 / 255
# float32 at a metre or ten.
TOLERANCE = 2e-6
TIMELINES = ('recorded', 'sim_time')


def body(name='box/0', shape=None, color=RED, **changes):
    shape = shape or Box(width=2.0, height=1.0)
    return replace(PLAIN_BODY, name=name, shape=shape, color=color, **changes)


def scene(*bodies, **settings):
    return Scene(bodies=bodies, settings=WorldSettings(**settings))


def frame(of, poses, *, step=0, **changes):
    poses = np.array(poses, dtype=np.float64).reshape(-1, 3)
    snapshot = Snapshot(
        step=step, stamp=step * STEP_NS, scene=of, poses=poses, twists=np.ones_like(poses)
    )
    return Frame(snapshot=snapshot, contacts=changes.pop('contacts', None), **changes)


def contacts(*impulses, pair=(0, -1)):
    """Return contacts at (1, 2) with impulses on the second body [N s]."""
    count = len(impulses)
    return Contacts(
        pairs=np.array([pair] * count, dtype=np.int64).reshape(-1, 2),
        points=np.array([[1.0, 2.0]] * count).reshape(-1, 2),
        normals=np.array([[0.0, -1.0]] * count).reshape(-1, 2),
        impulses=np.array(impulses, dtype=np.float64).reshape(-1, 2),
    )


@dataclass
class Row:
    """A component of an entity at a frame."""

    value: np.ndarray
    recorded: int
    # Of what is not drawn by the time of the world, None.
    stamp: int | None = None

    @property
    def frame(self):
        """Return the number of the frame; those of these tests are 1/60 s apart."""
        return round(self.recorded * 60e-9)


class Recording:
    """A picture that is drawn into a file, and what the file then holds."""

    def __init__(self, path):
        self.path = path
        self._stream = rr.RecordingStream('test')
        self._stream.set_sinks(rr.FileSink(path))
        self._recorder = FrameRecorder(self._stream)

    def draw(self, *frames, **context):
        """Draw frames; return the time of the last on the timeline of the picture [ns]."""
        self._recorder.log(frames, context=FrameContext(**context))
        return self._recorder.recorded

    def close(self):
        self._stream.disconnect()

    def poses(self, name):
        """Return the rows of the places of a body."""
        return self.rows(f'world/bodies/{name}', 'InstancePoses3D:translations')

    def rows(self, entity, component):
        """Return all rows of a component, in the order of time; no more can be drawn then."""
        self.close()
        rows = []
        for each in chunk.RrdReader(self.path).stream():
            if each.entity_path != f'/{entity}' or each.is_static:
                continue
            table = each.to_record_batch()
            if component not in table.schema.names:
                continue
            times = [
                table.column(name).cast('int64').to_pylist()
                for name in TIMELINES
                if name in table.schema.names
            ]
            values = table.column(component).to_pylist()
            rows += [
                Row(np.array(value), *row)
                for *row, value in zip(*times, values, strict=True)
                if value is not None
            ]
        return sorted(rows, key=lambda row: row.recorded)

    def last(self, entity, component):
        """Return the last value of a component."""
        return self.rows(entity, component)[-1].value

    def shapes(self, entity):
        """Return the instances of an entity as they were drawn, a list for each frame."""
        corners = self.last(entity, 'Mesh3D:vertex_positions')[:, :2]
        triangles = self.last(entity, 'Mesh3D:triangle_indices')
        colors = unpack(self.last(entity, 'Mesh3D:vertex_colors'))
        columns = ('translations', 'quaternions', 'scales')
        places, turns, scales = (
            self.rows(entity, f'InstancePoses3D:{column}') for column in columns
        )
        frames = []
        for number, (place, turn) in enumerate(zip(places, turns, strict=True)):
            instances = []
            for row, (x, y, z) in enumerate(place.value):
                scale = scales[number].value[row, :2] if scales else 1.0
                *tilt, half_sin, half_cos = turn.value[row]
                assert tilt == [0, 0]
                yaw = 2 * math.atan2(half_sin, half_cos)
                cos, sin = math.cos(yaw), math.sin(yaw)
                turned = corners * scale @ np.array([[cos, sin], [-sin, cos]])
                instances.append(Drawn(turned + np.array((x, y)), triangles, colors, z))
            frames.append(instances)
        return frames

    def shape(self, entity):
        """Return the only instance of an entity in its only frame."""
        ((only,),) = self.shapes(entity)
        return only


@dataclass
class Drawn:
    """The mesh of a body where it was drawn: corners (v, 2) [m], triangles, colours, z [m]."""

    corners: np.ndarray
    triangles: np.ndarray
    colors: np.ndarray
    z: float

    @property
    def bounds(self):
        """Left, bottom, right, top [m]."""
        return [*self.corners.min(axis=0), *self.corners.max(axis=0)]

    def color_at(self, x, y):
        """Return the colour that is seen at a point: that of the last triangle there, or None."""
        a, b, c = np.moveaxis(self.corners[self.triangles], 1, 0)
        sides = [
            cross(second - first, (x, y) - first) for first, second in ((a, b), (b, c), (c, a))
        ]
        inside = np.all([side >= 0 for side in sides], axis=0)
        inside |= np.all([side <= 0 for side in sides], axis=0)
        if not inside.any():
            return None
        return tuple(self.colors[self.triangles[np.flatnonzero(inside)[-1], 0]])


def unpack(colors):
    """Return packed colours as (k, 4) 0 .. 1."""
    packed = np.array(colors, dtype=np.uint32)
    return np.stack([(packed >> shift & 255) / 255 for shift in (24, 16, 8, 0)], axis=1)
