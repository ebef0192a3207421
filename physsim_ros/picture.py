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

"""
The picture of the world in Rerun: its entities, their geometry, and the blueprint.

Law: what changes only with the scene is sent when the scene changes, and again now and then; what
moves is sent for many frames at once, one entity for each kind of thing.

Everything is drawn as thin solids seen from straight above, by a camera that is the origin of a
two-dimensional view: that gives filled shapes, y up, and pan and zoom alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.core.settings import Bounds
from physsim_ros.core.shapes import Box, Capsule, Circle, Color, Compound, Convex, Disc, Piece
from physsim_ros.core.shapes import Point, Polygon, Pose
from physsim_ros.core.snapshot import Body, Floats, Frame, Scene
import rerun as rr
import rerun.blueprint as rrb

Singles = NDArray[np.float32]
Rows = NDArray[np.intp]

# A server that has reached its memory limit drops old rows, so geometry is repeated [frames].
REPEAT = 300
# The picture's own pixels. The camera stands where 50 of them are one unit, whatever the size of
# the world, so that neither they nor the bounds of the view ever change.
WIDTH, HEIGHT, PIXELS = 1600, 1000, 50
DISTANCE = 20.0
# Half the thickness of a body, and the depth over which later bodies lie above earlier ones, both
# in units: enough for the renderer's depth buffer, too little to be seen from the side.
THICK, DEPTH = 0.01, 0.02
# What is shown before there is anything: left, bottom, right, top [m].
NOTHING = (-10.0, 0.0, 10.0, 12.0)
# Rerun shades solids and leaves meshes as they are: this makes the two alike.
SHADE = 0.72
TRANSLUCENT = 0.4
PAPER = (250, 250, 247)
WALL = (0.35, 0.37, 0.4, 1.0)
DARK, LIGHT = (0.08, 0.08, 0.1, 1.0), (1.0, 1.0, 1.0, 1.0)
CONTACT = (214, 39, 40)
ENERGIES = {'kinetic': (245, 133, 24), 'potential': (76, 120, 168), 'total': (160, 160, 160)}
BOXES = ('boxes', 'marks', 'anchors', 'outlines')
MESHES = ('polygons', 'ghosts')


class Thing(NamedTuple):
    """
    A flat rectangle on a body, or a disc, whose half extents are its radius.

    :param spot: x, y [m], yaw [rad] in the body's frame
    :param size: half extents [m]
    :param color: red, green, blue, alpha, each 0 .. 1
    """

    spot: Pose
    size: Point
    color: Color


@dataclass(frozen=True, slots=True)
class Table:
    """
    The things of one kind in a scene.

    :param rows: (k,) the body that each lies on
    :param things: (k, 9) float32: spot, size, color of each
    :param depth: (k,) float32: z of each [m]
    """

    rows: Rows
    things: Singles
    depth: Singles

    def centers(self, poses: Floats) -> Singles:
        """Return (f * k, 3) float32 for (f, n, 3) poses of the bodies."""
        return _placed(poses[:, self.rows], self.things[:, :2], self.depth)

    def quaternions(self, poses: Floats) -> Singles:
        """Return (f * k, 4) float32, the turns about z, for (f, n, 3) poses of the bodies."""
        half = (poses[:, self.rows, 2] + self.things[:, 2]) / 2
        turns = np.zeros((*half.shape, 4), dtype=np.float32)
        turns[..., 2], turns[..., 3] = np.sin(half), np.cos(half)
        return turns.reshape(-1, 4)
