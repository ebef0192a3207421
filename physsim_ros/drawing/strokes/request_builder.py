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
What is made of a stroke once it is known what it means: geometry made regular, and requests.

Law: what cannot be made is refused here, with a sentence, before anybody submits it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
import math

import numpy as np
from physsim_ros.drawing import body_requests, snapping
from physsim_ros.drawing.scene_query import View
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes import overlap, regularisation
from physsim_ros.drawing.strokes.corner_detection import bends_of
from physsim_ros.drawing.strokes.fitting import simplified
from physsim_ros.drawing.strokes.stroke import Stroke
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import NothingThere, NotRecognised
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import Anchor, Axle, Configure, Delete, Join, Request
from physsim_ros.model.transform import Point

# Points of the outline of a disc that is shown.
_SHOWN = 48


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Made:
    """What was made of a stroke, as in `Reading`."""

    requests: tuple[Request, ...]
    subject: str
    message: str
    outline: Floats


# Makes something of the points of a candidate and of the stroke itself.
Make = Callable[[Floats, Stroke, View, DrawingSettings], Made]


def disc(points: Floats, _drawn: Stroke, view: View, settings: DrawingSettings) -> Made:
    """Make a disc of its centre and a point on its rim."""
    center, radius = point_of(points[0]), math.dist(*points)
    name = view.next_body()
    return Made(
        requests=(body_requests.disc(name, center, radius, settings),),
        subject=name,
        message=f'a disc of radius {radius:.3g} m',
        outline=_circle(center, radius),
    )


def rectangle(points: Floats, drawn: Stroke, view: View, settings: DrawingSettings) -> Made:
    """Make a rectangle of its corners."""
    if settings.beautify == 0.0:
        return polygon(points, drawn, view, settings)
    name = view.next_body()
    pose, width, height = regularisation.rectangle(points, settings.beautify)
    x, y, yaw = pose
    along = np.array((math.cos(yaw), math.sin(yaw))) * width / 2
    across = np.array((-math.sin(yaw), math.cos(yaw))) * height / 2
    corners = np.array((-along - across, along - across, along + across, across - along))
    return Made(
        requests=(body_requests.rectangle(name, pose, width, height, settings),),
        subject=name,
        message=f'a rectangle of {width:.3g} m by {height:.3g} m',
        outline=_around(np.array((x, y)) + corners),
    )


def polygon(points: Floats, _drawn: Stroke, view: View, settings: DrawingSettings) -> Made:
    """Make a polygon of its corners."""
    name = view.next_body()
    corners = regularisation.polygon_outline(points, settings.beautify)
    return Made(
        requests=(body_requests.polygon(name, list(map(point_of, corners)), settings),),
        subject=name,
        message=f'a polygon of {len(corners)} corners',
        outline=_around(corners),
    )


def wall(points: Floats, drawn: Stroke, view: View, settings: DrawingSettings) -> Made:
    """Make a wall of its ends and bends, or of the curve that was drawn."""
    name = view.next_body()
    # What sides do not explain is a curve, and is kept as one.
    curved = simplified(drawn.points, points)
    way = regularisation.line(points, settings.beautify) if curved is None else curved
    corners = list(map(point_of, way))
    corners[0] = snapping.wall_end(corners[0], view, settings)
    corners[-1] = snapping.wall_end(corners[-1], view, settings)
    length = sum(map(math.dist, corners, corners[1:]))
    return Made(
        requests=(body_requests.wall(name, corners, settings),),
        subject=name,
        message=f'a wall of {length:.3g} m',
        outline=np.array(corners),
    )


def bent_wall(_points: Floats, drawn: Stroke, view: View, settings: DrawingSettings) -> Made:
    """Make a wall of a stroke whose bends have not been looked for yet."""
    return wall(bends_of(drawn.points), drawn, view, settings)


def rod(points: Floats, _drawn: Stroke, view: View, settings: DrawingSettings) -> Made:
    """Join what lies at both ends by a rod."""
    return _join(JointKind.ROD, points, None, view, settings)


def spring(points: Floats, drawn: Stroke, view: View, settings: DrawingSettings) -> Made:
    """Join what lies at both ends by a spring."""
    return _join(JointKind.SPRING, points, drawn, view, settings)


def axle(points: Floats, drawn: Stroke, view: View, settings: DrawingSettings) -> Made:
    """Make an axle where a small circle was drawn."""
    center, under = snapping.pivot(point_of(points[0]), drawn.points, view, settings)
    request: Request = Axle(point=center)
    if under != view.bodies_at(center)[:2]:
        name, (a, b) = view.next_joint(), under
        request = Join(name=name, kind=JointKind.AXLE, points=(center,), a=a, b=b)
    between = ' and '.join(under) if len(under) == 2 else f'{under[0]} and the background'
    return Made(
        requests=(request,),
        subject=under[0],
        message=f'an axle between {between}',
        outline=_circle(center, math.dist(*points)),
    )


def anchor(points: Floats, drawn: Stroke, view: View, settings: DrawingSettings) -> Made:
    """Fix what lies under an x."""
    point = point_of(points[0])
    under = view.bodies_at(point)
    if not under:
        # Made a little beside a thin body; the nearest thing that is under the pen.
        under = view.bodies_at(point, settings.snap)
        near = drawn.points[view.covers(under[0], drawn.points)] if under else ()
        if not len(near):
            x, y = point
            raise NothingThere(
                f'an x anchors the body under it; there is none at ({x:.3g}, {y:.3g})',
                field='poses',
            )
        point = min(map(point_of, near), key=lambda each: math.dist(each, point))
    return Made(
        requests=(Anchor(point=point),),
        subject=under[0],
        message=f'anchor {under[0]}',
        outline=drawn.points,
    )


def gravity(points: Floats, drawn: Stroke, view: View, settings: DrawingSettings) -> Made:
    """Turn gravity from tail to tip."""
    tail = view.bodies_at(point_of(points[0]))
    if tail:
        raise NotRecognised(
            f'an arrow in free space turns gravity; this one begins on {tail[0]}', field='poses'
        )
    strength = view.gravity_strength()
    tip = regularisation.line(points, settings.beautify)
    x, y = (tip[1] - tip[0]).tolist()
    length = math.hypot(x, y)
    gravity = strength * x / length, strength * y / length
    return Made(
        requests=(Configure(changes={'gravity': gravity}),),
        subject='',
        message=f'gravity towards ({gravity[0]:.3g}, {gravity[1]:.3g}) m/s²',
        outline=drawn.points,
    )


def deletion(_points: Floats, drawn: Stroke, view: View, _settings: DrawingSettings) -> Made:
    """Delete what a scribble is meant for."""
    over = overlap.passed(drawn.points, view)
    covered = overlap.bodies_under(drawn.points, over, view)
    if not covered:
        raise NothingThere('a scribble deletes the bodies under it; there are none', field='poses')
    return Made(
        requests=tuple(Delete(name=name) for name in covered),
        subject=covered[0] if len(covered) == 1 else '',
        message=f'delete {", ".join(covered)}',
        outline=drawn.points,
    )


def _join(
    kind: JointKind, points: Floats, drawn: Stroke | None, view: View, settings: DrawingSettings
) -> Made:
    """Join what lies at both ends; show the stroke, or a straight line where there is none."""
    joined = snapping.ends_on(point_of(points[0]), point_of(points[-1]), view, settings)
    if joined is None:
        raise NothingThere(
            f'a {kind} joins two bodies, one of which moves; there are none at its ends',
            field='poses',
        )
    first, last = joined
    name = view.next_joint()
    ends = first.point, last.point
    return Made(
        requests=(Join(name=name, kind=kind, points=ends, a=first.body, b=last.body),),
        subject=name,
        message=f'a {kind} from {first.body} to {last.body}',
        outline=np.array(ends) if drawn is None else drawn.points,
    )


def _circle(center: Point, radius: float) -> Floats:
    angles = np.linspace(0.0, 2 * math.pi, _SHOWN + 1)
    circle: Floats = np.array(center) + radius * np.column_stack((np.cos(angles), np.sin(angles)))
    return circle


def _around(corners: Floats) -> Floats:
    return np.vstack((corners, corners[:1]))


def point_of(row: Floats) -> Point:
    """Return a row as a point."""
    x, y = row.tolist()
    return x, y
