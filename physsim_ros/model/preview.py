# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The preview of a drawing: what is shown over the world until a body is made of it."""

from __future__ import annotations

from dataclasses import dataclass

from physsim_ros.model.transform import Point

Line = tuple[Point, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Preview:
    """
    Lines, points and a label that are shown over the world.

    :param lines: polylines [m]
    :param points: clicked so far [m]
    :param label: text above the rest; '' is none
    """

    lines: tuple[Line, ...] = ()
    points: Line = ()
    label: str = ''

    @property
    def top(self) -> Point:
        """Return the highest point of it, above which the label is drawn [m]."""
        every = [*self.points, *(point for line in self.lines for point in line)]
        return max(every, key=lambda point: point[1], default=(0.0, 0.0))


NO_PREVIEW = Preview()
