# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages of hands, pens and maps, which `physsim_ros.testing` does not build."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from functools import reduce
import math
from typing import Any

from geometry_msgs.msg import Point, PoseStamped
from nav_msgs.msg import OccupancyGrid, Path
from std_msgs.msg import Header
from visualization_msgs.msg import InteractiveMarkerFeedback

DOWN, MOVE, UP = (
    InteractiveMarkerFeedback.MOUSE_DOWN,
    InteractiveMarkerFeedback.POSE_UPDATE,
    InteractiveMarkerFeedback.MOUSE_UP,
)


def spoiled(message: Any, path: str, value: Any) -> Any:
    """Return a message, or another object, with another value at a path of fields."""
    *parents, field = path.split('.')
    setattr(reduce(getattr, parents, message), field, value)
    return message


def feedback(
    kind: int, x: float = 0.0, y: float = 0.0, *, hand: str = 'anna', frame: str = ''
) -> InteractiveMarkerFeedback:
    """Return the feedback of a hand at a place."""
    return InteractiveMarkerFeedback(
        header=Header(frame_id=frame),
        client_id=hand,
        event_type=kind,
        mouse_point=Point(x=x, y=y),
        mouse_point_valid=True,
    )


def stroke(
    *points: Sequence[float], frame: str = '', frames: Sequence[str] = (), begin: int = 0
) -> Path:
    """Return a path, its points x, y and, where there are three, time [s]."""
    message = Path()
    message.header.frame_id = frame
    for number, point in enumerate(points):
        sample = PoseStamped()
        x, y, seconds = (*map(float, point), 0.0)[:3]
        sample.pose.position.x, sample.pose.position.y, sample.pose.position.z = x, y, 7.0
        stamp = begin + round(seconds * 1e9)
        sample.header.stamp.sec, sample.header.stamp.nanosec = divmod(stamp, 1_000_000_000)
        sample.header.frame_id = frames[number] if frames else ''
        message.poses.append(sample)
    return message


def circle(x: float, y: float, radius: float) -> list[tuple[float, float]]:
    """Return points around a circle, the first one also at the end."""
    angles = [math.tau * number / 60 for number in range(61)]
    return [(x + radius * math.cos(angle), y + radius * math.sin(angle)) for angle in angles]


def grid(*rows: str) -> OccupancyGrid:
    """Return a map of rows of # and . of half a metre, the highest first."""
    message = OccupancyGrid()
    message.header.frame_id = 'map'
    cells = [[100 if cell == '#' else 0 for cell in row] for row in reversed(rows)]
    message.info.height, message.info.width = len(cells), len(cells[0])
    message.info.resolution = 0.5
    message.data = array('b', [cell for row in cells for cell in row])
    return message
