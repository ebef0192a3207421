# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The camera of the world: a pinhole straight above, over the area of all bodies and joints.

Bodies are thin solids, and the camera is the origin of a two-dimensional view: that gives filled
shapes, y up, and pan and zoom without rotation.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.settings import Bounds
from physsim_ros.view.blueprint import HEIGHT, WIDTH
import rerun as rr

# Length of a unit of the view in the image [pixels], for worlds of any size.
PIXELS = 50
# Distance of the camera from the plane [units].
DISTANCE = 20.0
# Area before there are bodies: left, bottom, right, top [m].
_EMPTY = (-10.0, 0.0, 10.0, 12.0)
# Margin around bounds or bodies [units]: it has the coordinates of the grid at the left and below,
# and the legend above.
MARGIN = 1.2
# Room for bodies to move where there are no bounds, in shares of the longer side of their area.
_ROOM = 0.05
# Distance from the area at which a body moves the camera, in shares of the longer side.
_TOLERANCE = 0.5


class Camera:
    """
    The camera of the view of the world.

    It moves only when the bounds change or a body leaves the widened area, since a view that jumps
    is hard to follow.
    """

    def __init__(self) -> None:
        # Left, bottom, right, top of the bounds or of the bodies [m].
        self._content: Bounds = _EMPTY
        self._aimed = False

    @property
    def unit(self) -> float:
        """Length that is drawn as 50 pixels [m]: about 1 m for a world of 20 m."""
        left, bottom, right, top = self._content
        across, up = WIDTH / PIXELS - 2 * MARGIN, HEIGHT / PIXELS - 2 * MARGIN
        return max((right - left) / across, (top - bottom) / up)

    @property
    def area(self) -> Bounds:
        """Left, bottom, right, top of the area that it shows, with the margin [m]."""
        return _widened(self._content, MARGIN * self.unit)

    def show_bounds(self, bounds: Bounds) -> None:
        """Aim at the boundary of the world: left, bottom, right, top [m]."""
        self._content, self._aimed = bounds, True

    def show_bodies(self, extent: Bounds, ends: Floats) -> None:
        """
        Aim at bodies and joints, if a body or joint lies far outside the area.

        :param extent: of the bodies: left, bottom, right, top [m]
        :param ends: (j, 2, 2) float64: points of the joints [m]
        """
        left, bottom, right, top = extent = _around(extent, ends)
        near = _widened(self._content, _TOLERANCE * _longer_side(self._content))
        inside = left >= near[0] and bottom >= near[1] and right <= near[2] and top <= near[3]
        if not self._aimed or not inside:
            self._content = _widened(extent, _ROOM * _longer_side(extent))
            self._aimed = True

    def transform(self) -> rr.ComponentColumnList:
        """Return the pose of the camera, as columns of one row."""
        left, bottom, right, top = self._content
        eye = ((left + right) / 2, (bottom + top) / 2, DISTANCE * self.unit)
        # Straight down: the x axis of the image is that of the world, its y axis is reversed.
        return rr.Transform3D.columns(translation=[eye], mat3x3=[np.diag((1.0, -1.0, -1.0))])


def pinhole() -> rr.Pinhole:
    """Return the projection of the camera."""
    return rr.Pinhole(
        focal_length=PIXELS * DISTANCE,
        width=WIDTH,
        height=HEIGHT,
        camera_xyz=rr.ViewCoordinates.RDF,
    )


def _around(area: Bounds, ends: Floats) -> Bounds:
    """Return an area extended to the points of joints, (j, 2, 2) float64."""
    points = ends.reshape(-1, 2)
    left, bottom = np.minimum(points.min(axis=0, initial=np.inf), area[:2]).tolist()
    right, top = np.maximum(points.max(axis=0, initial=-np.inf), area[2:]).tolist()
    return left, bottom, right, top


def _longer_side(area: Bounds) -> float:
    left, bottom, right, top = area
    return max(right - left, top - bottom)


def _widened(area: Bounds, more: float) -> Bounds:
    left, bottom, right, top = area
    return left - more, bottom - more, right + more, top + more
