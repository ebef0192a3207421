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
The tools of drawing by clicks: what the clicks of a gesture, from its first, make.

Law: a tool reads clicks and a view of the world, and changes neither. While it wants more clicks
it says which; with the last one it gives the requests; a gesture that is no shape is refused.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
import math

from physsim_ros.drawing import body_requests
from physsim_ros.drawing.clicks.click import Click, distinct, meant, span
from physsim_ros.drawing.scene_query import View
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.model.errors import Anchored, NothingThere
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import (
    Anchor,
    Axle,
    Command,
    Configure,
    Delete,
    Join,
    Pin,
    Release,
    Request,
)
from physsim_ros.model.transform import Point


class Tool(StrEnum):
    """What a click can be made with: the values of parameter `tool`."""

    NONE = 'none'
    CIRCLE = 'circle'
    CIRCLE_DIAMETER = 'circle_diameter'
    RECTANGLE = 'rectangle'
    POLYGON = 'polygon'
    WALL = 'wall'
    ANCHOR = 'anchor'
    RELEASE = 'release'
    PIN = 'pin'
    AXLE = 'axle'
    DELETE = 'delete'
    SPRING = 'spring'
    ROD = 'rod'
    ROPE = 'rope'
    VELOCITY = 'velocity'
    GRAVITY = 'gravity'


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """
    What a click led to.

    :param requests: what to submit; none while the gesture goes on
    :param message: what was done so far, and which click comes next
    """

    requests: tuple[Request, ...] = ()
    message: str = ''


def circle(clicks: Sequence[Click], view: View, settings: DrawingSettings) -> Step:
    """Draw a disc: its centre, then a point on its rim."""
    if len(clicks) < 2:
        return _more('the centre is set', 'a point on the rim')
    center, rim = _points(clicks)
    radius = span(center, rim, settings, 'the radius')
    return _done(body_requests.disc(view.next_body(), center, radius, settings))


def circle_diameter(clicks: Sequence[Click], view: View, settings: DrawingSettings) -> Step:
    """Draw a disc: one end of a diameter, then the other."""
    if len(clicks) < 2:
        return _more('an end of a diameter is set', 'the other end')
    start, end = _points(clicks)
    radius = span(start, end, settings, 'the diameter') / 2
    return _done(body_requests.disc(view.next_body(), _middle(start, end), radius, settings))


def rectangle(clicks: Sequence[Click], view: View, settings: DrawingSettings) -> Step:
    """Draw a rectangle: a corner, the next corner, then a point of the side across."""
    if len(clicks) < 2:
        return _more('a corner is set', 'the next corner')
    start, end, *rest = _points(clicks)
    width = span(start, end, settings, 'the first side')
    if not rest:
        return _more('a side is set', 'a point of the side across')
    along = (end[0] - start[0]) / width, (end[1] - start[1]) / width
    # To the left of the first side, or, where it is negative, to the right.
    height = along[0] * (rest[0][1] - start[1]) - along[1] * (rest[0][0] - start[0])
    meant(abs(height), settings, 'the second side')
    x, y = _middle(start, end)
    center = x - along[1] * height / 2, y + along[0] * height / 2
    yaw = math.atan2(along[1], along[0])
    name = view.next_body()
    return _done(body_requests.rectangle(name, (*center, yaw), width, abs(height), settings))


def polygon(clicks: Sequence[Click], view: View, settings: DrawingSettings) -> Step:
    """Draw a polygon: corner after corner; a click on the first one closes it."""
    points = _points(clicks)
    if len(points) > 1 and math.dist(points[0], points[-1]) <= settings.snap:
        corners = distinct(points[:-1], settings)
        return _done(body_requests.polygon(view.next_body(), corners, settings))
    count = len(distinct(points, settings))
    said = 'a corner is set' if count == 1 else f'{count} corners are set'
    return _more(said, 'the next corner, or the first one again to close it')


def wall(clicks: Sequence[Click], view: View, settings: DrawingSettings) -> Step:
    """Draw a wall: one end, then the other."""
    if len(clicks) < 2:
        return _more('an end is set', 'the other end')
    start, end = _points(clicks)
    span(start, end, settings, 'the wall')
    return _done(body_requests.wall(view.next_body(), (start, end), settings))


def anchor(clicks: Sequence[Click], _view: View, _settings: DrawingSettings) -> Step:
    """Fix the body under the click to the background."""
    return _done(Anchor(point=clicks[0].point))


def release(clicks: Sequence[Click], _view: View, _settings: DrawingSettings) -> Step:
    """Free the body under the click from the background, pins and axles."""
    return _done(Release(point=clicks[0].point))


def pin(clicks: Sequence[Click], _view: View, _settings: DrawingSettings) -> Step:
    """Weld the two bodies under the click, or the one to the background."""
    return _done(Pin(point=clicks[0].point))


def axle(clicks: Sequence[Click], _view: View, _settings: DrawingSettings) -> Step:
    """Let the two bodies under the click turn about it, or the one about the background."""
    return _done(Axle(point=clicks[0].point))


def delete(clicks: Sequence[Click], view: View, _settings: DrawingSettings) -> Step:
    """Delete the body under the click."""
    return _done(Delete(name=clicks[0].hit(view)))


def spring(clicks: Sequence[Click], view: View, settings: DrawingSettings) -> Step:
    """Join two points by a spring: one end, then the other."""
    return _join(JointKind.SPRING, clicks, view, settings)


def rod(clicks: Sequence[Click], view: View, settings: DrawingSettings) -> Step:
    """Join two points by a rod: one end, then the other."""
    return _join(JointKind.ROD, clicks, view, settings)


def rope(clicks: Sequence[Click], view: View, settings: DrawingSettings) -> Step:
    """Join two points by a rope: one end, then the other."""
    return _join(JointKind.ROPE, clicks, view, settings)


def velocity(clicks: Sequence[Click], view: View, settings: DrawingSettings) -> Step:
    """Give a body a velocity: the body, then the tip of an arrow from there, 1 m for 1 m/s."""
    name = clicks[0].hit(view)
    if view.body(name).anchored:
        raise Anchored(f'{name} is anchored; it has no velocity', field='point')
    if len(clicks) < 2:
        return _more(f'the arrow begins on {name}', 'its tip, 1 m for 1 m/s')
    tail, tip = _points(clicks)
    span(tail, tip, settings, 'the arrow')
    spin = view.twist(name)[2]
    twist = (tip[0] - tail[0], tip[1] - tail[1], spin)
    return _done(Command(names=(name,), twists=(twist,)))


def gravity(clicks: Sequence[Click], view: View, settings: DrawingSettings) -> Step:
    """Turn gravity: the tail of an arrow, then its tip; how strong it is stays."""
    strength = view.gravity_strength()
    if len(clicks) < 2:
        return _more('the arrow begins there', 'its tip')
    tail, tip = _points(clicks)
    share = strength / span(tail, tip, settings, 'the arrow')
    turned = (tip[0] - tail[0]) * share, (tip[1] - tail[1]) * share
    return _done(Configure(changes={'gravity': turned}))


Draw = Callable[[Sequence[Click], View, DrawingSettings], Step]

TOOLS: dict[Tool, Draw] = {
    Tool.CIRCLE: circle,
    Tool.CIRCLE_DIAMETER: circle_diameter,
    Tool.RECTANGLE: rectangle,
    Tool.POLYGON: polygon,
    Tool.WALL: wall,
    Tool.ANCHOR: anchor,
    Tool.RELEASE: release,
    Tool.PIN: pin,
    Tool.AXLE: axle,
    Tool.DELETE: delete,
    Tool.SPRING: spring,
    Tool.ROD: rod,
    Tool.ROPE: rope,
    Tool.VELOCITY: velocity,
    Tool.GRAVITY: gravity,
}


def _join(kind: JointKind, clicks: Sequence[Click], view: View, settings: DrawingSettings) -> Step:
    """Join what was clicked first to what was clicked then, one of them a body."""
    if len(clicks) < 2:
        where = clicks[0].body or 'the background'
        return _more(f'the {kind} begins on {where}', 'its other end')
    # A body keeps the place that was clicked, wherever it has gone since.
    ends = [(click.now(view), click.body or WORLD) for click in clicks]
    if ends[0][1] == WORLD:
        ends.reverse()
    (start, a), (end, b) = ends
    if a == WORLD:
        raise NothingThere(f'there is no body at either end of the {kind}', field='point')
    span(start, end, settings, f'the {kind}')
    return _done(Join(name=view.next_joint(), kind=kind, points=(start, end), a=a, b=b))


def _points(clicks: Sequence[Click]) -> list[Point]:
    return [click.point for click in clicks]


def _middle(start: Point, end: Point) -> Point:
    return (start[0] + end[0]) / 2, (start[1] + end[1]) / 2


def _more(said: str, wanted: str) -> Step:
    return Step(message=f'{said}; next: {wanted}')


def _done(*requests: Request) -> Step:
    return Step(requests=requests)
