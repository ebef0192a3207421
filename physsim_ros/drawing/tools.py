# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The tools of drawing by clicks: each is a function from the clicks of a gesture to requests.

Laws: a tool changes neither clicks nor scene. With the last click it returns the requests, before
that a message about the next click. Clicks without a valid geometry are refused.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
import math

import numpy as np
from physsim_ros.drawing import chains, knife, new_bodies
from physsim_ros.drawing.click import (
    checked_distance,
    checked_length,
    Click,
    ClickResult,
    Tool,
    without_repeats,
)
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.model.applied_forces import AppliedForce
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import Anchored, BadOutline, NothingThere
from physsim_ros.model.joints import JointKind, JointProperties, MOST_STOPS
from physsim_ros.model.names import shown_end, WORLD
from physsim_ros.model.requests import (
    Anchor,
    Axle,
    ChangeBody,
    Command,
    Configure,
    Delete,
    Join,
    Pin,
    Release,
    Request,
)
from physsim_ros.model.shapes import Box, MOST_POINTS
from physsim_ros.model.transform import Point
from physsim_ros.model.translation import Text

Draw = Callable[[Sequence[Click], SceneQuery, DrawingSettings], ClickResult]
# Force of an arrow of 1 m [N]: nearly the weight of 1 kg.
_NEWTONS = 10.0


def circle(clicks: Sequence[Click], scene: SceneQuery, settings: DrawingSettings) -> ClickResult:
    """Draw a disc: its centre, then a point on its rim."""
    if len(clicks) < 2:
        return _next_click('the centre is set', Text('a point on the rim'))
    center, rim = _points(clicks)
    radius = checked_distance(center, rim, settings, 'the radius')
    return _finished(new_bodies.disc(scene.next_body(), center, radius, settings))


def circle_diameter(
    clicks: Sequence[Click], scene: SceneQuery, settings: DrawingSettings
) -> ClickResult:
    """Draw a disc: one end of a diameter, then the other."""
    if len(clicks) < 2:
        return _next_click('an end of a diameter is set', Text('the other end'))
    start, end = _points(clicks)
    radius = checked_distance(start, end, settings, 'the diameter') / 2
    return _finished(new_bodies.disc(scene.next_body(), _middle(start, end), radius, settings))


def rectangle(
    clicks: Sequence[Click], scene: SceneQuery, settings: DrawingSettings
) -> ClickResult:
    """Draw a rectangle: a corner, the next corner, then a point of the side across."""
    if len(clicks) < 2:
        return _next_click('a corner is set', Text('the next corner'))
    start, end, *rest = _points(clicks)
    width = checked_distance(start, end, settings, 'the first side')
    if not rest:
        return _next_click('a side is set', Text('a point of the side across'))
    along = (end[0] - start[0]) / width, (end[1] - start[1]) / width
    # To the left of the first side, or, where it is negative, to the right.
    height = along[0] * (rest[0][1] - start[1]) - along[1] * (rest[0][0] - start[0])
    checked_length(abs(height), settings, 'the second side')
    x, y = _middle(start, end)
    center = x - along[1] * height / 2, y + along[0] * height / 2
    yaw = math.atan2(along[1], along[0])
    name = scene.next_body()
    return _finished(new_bodies.rectangle(name, (*center, yaw), width, abs(height), settings))


def polygon(clicks: Sequence[Click], scene: SceneQuery, settings: DrawingSettings) -> ClickResult:
    """Draw a polygon: corner after corner; a click on the first one closes it."""
    points = _points(clicks)
    if len(points) > 1 and math.dist(points[0], points[-1]) <= settings.snap:
        corners = without_repeats(points[:-1], settings)
        return _finished(new_bodies.polygon(scene.next_body(), corners, settings))
    if len(points) > MOST_POINTS:
        # No polygon of more corners could be closed, and each click looks at all points.
        raise BadOutline('a polygon has at most {most} corners', field='point', most=MOST_POINTS)
    count = len(without_repeats(points, settings))
    done = 'a corner is set' if count == 1 else f'{count} corners are set'
    return _next_click(done, Text('the next corner, or the first one again to close it'))


def wall(clicks: Sequence[Click], scene: SceneQuery, settings: DrawingSettings) -> ClickResult:
    """Draw a wall: one end, then the other."""
    if len(clicks) < 2:
        return _next_click('an end is set', Text('the other end'))
    start, end = _points(clicks)
    checked_distance(start, end, settings, 'the wall')
    return _finished(new_bodies.wall(scene.next_body(), (start, end), settings))


def delete(clicks: Sequence[Click], scene: SceneQuery, _settings: DrawingSettings) -> ClickResult:
    """Delete the body under the click."""
    return _finished(Delete(name=clicks[0].hit_body(scene)))


def velocity(clicks: Sequence[Click], scene: SceneQuery, settings: DrawingSettings) -> ClickResult:
    """Set the velocity of a body: the body, then the tip of an arrow from there, 1 m for 1 m/s."""
    name = clicks[0].hit_body(scene)
    if scene.body(name).anchored:
        raise Anchored(
            '{body} is anchored; it has no velocity', field='point', body=name, concerns=name
        )
    if len(clicks) < 2:
        return _next_click(f'the arrow begins on {name}', Text('its tip, 1 m for 1 m/s'))
    tail, tip = _points(clicks)
    checked_distance(tail, tip, settings, 'the arrow')
    spin = scene.twist(name)[2]
    twist = (tip[0] - tail[0], tip[1] - tail[1], spin)
    return _finished(Command(names=(name,), twists=np.array((twist,))))


def gravity(clicks: Sequence[Click], scene: SceneQuery, settings: DrawingSettings) -> ClickResult:
    """Turn gravity: the tail of an arrow, then its tip; its magnitude stays."""
    strength = scene.gravity_strength()
    if len(clicks) < 2:
        return _next_click('the arrow begins there', Text('its tip'))
    tail, tip = _points(clicks)
    share = strength / checked_distance(tail, tip, settings, 'the arrow')
    turned = (tip[0] - tail[0]) * share, (tip[1] - tail[1]) * share
    return _finished(Configure(changes={'gravity': turned}))


def force(clicks: Sequence[Click], scene: SceneQuery, settings: DrawingSettings) -> ClickResult:
    """Add a constant force: its point on a body, then the tip of an arrow, 1 m for 10 N."""
    name = clicks[0].hit_body(scene)
    if len(clicks) < 2:
        return _next_click(f'the force acts on {name}', Text('the tip of its arrow, 1 m for 10 N'))
    tail, tip, body = clicks[0].current_point(scene), clicks[1].point, scene.body(name)
    checked_distance(tail, tip, settings, 'the arrow')
    form, at = body.shape.form, clicks[0].local
    # Near the centre of mass, that is meant.
    is_central = math.dist(at, form.centroid) <= min(settings.snap, form.inner / 2)
    added = AppliedForce(
        force=(_NEWTONS * (tip[0] - tail[0]), _NEWTONS * (tip[1] - tail[1])),
        at=None if is_central else at,
    )
    return _finished(ChangeBody(name=name, properties=Properties(forces=(*body.forces, added))))


def cut(clicks: Sequence[Click], scene: SceneQuery, settings: DrawingSettings) -> ClickResult:
    """Cut bodies with a knife: from one end of a stroke right through them to the other."""
    if len(clicks) < 2:
        return _next_click('the cut begins there', Text('its other end, beyond the bodies'))
    start, end = _points(clicks)
    checked_distance(start, end, settings, 'the cut')
    return _finished(knife.cut(start, end, scene))


def request_at(
    request: Callable[..., Request],
    clicks: Sequence[Click],
    _scene: SceneQuery,
    _settings: DrawingSettings,
) -> ClickResult:
    """Make a request about the bodies under the click; the world resolves the point."""
    return _finished(request(point=clicks[0].point))


def join(
    kind: JointKind, clicks: Sequence[Click], scene: SceneQuery, settings: DrawingSettings
) -> ClickResult:
    """Join the body, or the background, under the first click to that under the second."""
    if len(clicks) < 2:
        where = shown_end(clicks[0].body or WORLD)
        return _next_click(f'the {kind} begins on {where}', Text('its other end'))
    # Each end stays at its place on the body that was clicked, which may have moved since.
    ends = [(click.current_point(scene), click.body or WORLD) for click in clicks]
    if ends[0][1] == WORLD:
        ends.reverse()
    (start, a), (end, b) = ends
    if a == WORLD:
        raise _no_end(kind)
    checked_distance(start, end, settings, f'the {kind}')
    return _finished(Join(name=scene.next_joint(), kind=kind, points=(start, end), a=a, b=b))


def pulley(clicks: Sequence[Click], scene: SceneQuery, settings: DrawingSettings) -> ClickResult:
    """Draw a rope past wheels and rings, click after click; its end is clicked twice."""
    points = [click.current_point(scene) for click in clicks]
    if len(points) > 1 and math.dist(points[-2], points[-1]) <= settings.snap:
        names = [click.body or WORLD for click in clicks[:-1]]
        points = points[:-1]
        if names[0] == WORLD:
            names.reverse()
            points.reverse()
        if len(names) < 2 or names[0] == WORLD:
            raise _no_end(JointKind.ROPE)
        join = Join(
            name=scene.next_joint(),
            kind=JointKind.ROPE,
            points=tuple(points),
            a=names[0],
            b=names[-1],
            properties=JointProperties(over=tuple(names[1:-1]) or None),
        )
        return _finished(join)
    if len(points) > MOST_STOPS:
        # Each click looks at all points.
        raise BadOutline('a rope has at most {most} points', field='point', most=MOST_STOPS)
    where = shown_end(clicks[-1].body or WORLD)
    return _next_click(f'the rope is on {where}', Text('the next wheel or ring; its end twice'))


def chain(clicks: Sequence[Click], scene: SceneQuery, settings: DrawingSettings) -> ClickResult:
    """Draw a chain of links from the body, or the background, under one click to another."""
    if len(clicks) < 2:
        where = shown_end(clicks[0].body or WORLD)
        return _next_click(f'the chain begins on {where}', Text('its other end'))
    start, end = (click.current_point(scene) for click in clicks)
    checked_distance(start, end, settings, 'the chain')
    first, last = (click.body or WORLD for click in clicks)
    requests = chains.chain(np.array((start, end)), (first, last), scene, settings)
    return ClickResult(requests=requests, message=chains.message(requests, (first, last)))


def gear(clicks: Sequence[Click], scene: SceneQuery, _settings: DrawingSettings) -> ClickResult:
    """Couple two wheels by their teeth, at the ratio of their radii: one wheel, then the other."""
    names = [click.hit_body(scene) for click in clicks]
    if len(names) < 2:
        return _next_click(f'{names[0]} is a gear', Text('the other one'))
    a, b = names
    centers = scene.centroid(a), scene.centroid(b)
    radii = [scene.body(name).shape.form.outer for name in names]
    # A wheel within a ring turns in the same direction as the ring.
    sense = 1.0 if math.dist(*centers) < max(radii) else -1.0
    properties = JointProperties(ratio=sense * radii[1] / radii[0])
    return _finished(
        Join(
            name=scene.next_joint(),
            kind=JointKind.GEAR,
            points=centers[:1],
            a=a,
            b=b,
            properties=properties,
        )
    )


def rack(clicks: Sequence[Click], scene: SceneQuery, settings: DrawingSettings) -> ClickResult:
    """Let a wheel roll on a rack: the wheel, then a bar, along which the rack goes, or a point."""
    pinion = clicks[0].hit_body(scene)
    if len(clicks) < 2:
        return _next_click(f'{pinion} is the pinion', Text('its rack'))
    center, other = scene.centroid(pinion), clicks[1].body or WORLD
    foot = clicks[1].current_point(scene)
    if other != WORLD and isinstance(bar := scene.body(other).shape, Box):
        (x, y, yaw), across = scene.pose(other), bar.width < bar.height
        along = yaw + math.pi / 2 * across
        away = (y - center[1]) * math.cos(along) - (x - center[0]) * math.sin(along)
        foot = center[0] - away * math.sin(along), center[1] + away * math.cos(along)
    distance = checked_distance(center, foot, settings, 'the rack')
    share = scene.body(pinion).shape.form.outer / distance
    met = tuple(share * (end - begin) + begin for begin, end in zip(center, foot, strict=True))
    return _finished(
        Join(
            name=scene.next_joint(),
            kind=JointKind.RACK,
            points=(center, (met[0], met[1])),
            a=pinion,
            b=other,
            # A pinion without an axle lies on its rack.
            properties=JointProperties(collide=True),
        )
    )


TOOLS: dict[Tool, Draw] = {
    Tool.CIRCLE: circle,
    Tool.CIRCLE_DIAMETER: circle_diameter,
    Tool.RECTANGLE: rectangle,
    Tool.POLYGON: polygon,
    Tool.WALL: wall,
    Tool.ANCHOR: partial(request_at, Anchor),
    Tool.RELEASE: partial(request_at, Release),
    Tool.PIN: partial(request_at, Pin),
    Tool.AXLE: partial(request_at, Axle),
    Tool.DELETE: delete,
    Tool.SPRING: partial(join, JointKind.SPRING),
    Tool.ROD: partial(join, JointKind.ROD),
    Tool.ROPE: partial(join, JointKind.ROPE),
    Tool.PULLEY: pulley,
    Tool.CHAIN: chain,
    Tool.SLIDER: partial(join, JointKind.SLIDER),
    Tool.GEAR: gear,
    Tool.RACK: rack,
    Tool.VELOCITY: velocity,
    Tool.GRAVITY: gravity,
    Tool.FORCE: force,
    Tool.KNIFE: cut,
}


def _points(clicks: Sequence[Click]) -> list[Point]:
    return [click.point for click in clicks]


def _middle(start: Point, end: Point) -> Point:
    return (start[0] + end[0]) / 2, (start[1] + end[1]) / 2


def _no_end(kind: JointKind) -> NothingThere:
    return NothingThere(
        'there is no body at either end of the {kind}', field='point', kind=Text(kind)
    )


def _next_click(done: str, wanted: Text) -> ClickResult:
    return ClickResult(message=Text('{done}; next: {wanted}', done=done, wanted=wanted))


def _finished(*requests: Request) -> ClickResult:
    return ClickResult(requests=requests)
