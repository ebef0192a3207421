# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The bodies that an axle or a weld joins, and where.

Laws: an axle goes through all movable bodies at its place, or through one and the body below. It
lies at the middle of a wheel that was meant.
"""

from __future__ import annotations

import itertools
import math

from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.strokes.bodies_under import nearest_on_surface
from physsim_ros.drawing.strokes.stages import Context
from physsim_ros.model.names import WORLD
from physsim_ros.model.shapes import Disc
from physsim_ros.model.transform import norms, Point

# The least share of a circle on a second body, across whose edge it was drawn.
_ACROSS = 0.25
# The greatest distance of a wheel's middle from the body that carries it, in radii of the wheel:
# bodies farther apart overlap by accident.
_CARRIED = 0.9
# The least area of a wheel, as a share of the circle about it; a pentagon's is 0.76.
_ROUND = 0.75


def axle_pairs(center: Point, context: Context) -> tuple[Point, list[tuple[str, str]]]:
    """
    Return the pivot of an axle [m], and the pairs of bodies to be joined there, the upper first.

    An axle goes through all movable bodies at its place, or through one and the body below. Where
    these are joined already, it holds the lowest of them on the background.

    :param center: of the circle that was drawn, on a body [m]
    """
    point, under = _axle_of_two(center, context)
    scene, snap = context.scene, context.settings.snap
    if len(under) == 2 and all(scene.body(name).dynamic for name in under):
        deeper = (each for each in scene.bodies_at(point) if each not in under)
        under = *under, *(each for each in deeper if scene.body(each).dynamic)
    if len(under) == 1 or scene.body(under[-1]).dynamic:
        under = *under, WORLD
    joined = [{each.a, each.b} for each in scene.axles_at(point, snap)]
    pairs = list(itertools.pairwise(under))
    missing = [pair for pair in pairs if {*pair} not in joined]
    # The background holds what nothing else is left to be joined to.
    return point, [pair for pair in missing if pair[1] != WORLD] or missing or pairs[-1:]


def _axle_of_two(center: Point, context: Context) -> tuple[Point, tuple[str, ...]]:
    """Return the pivot of an axle [m], and the one or two topmost bodies there."""
    scene, snap = context.scene, context.settings.snap
    under = crossed_pair(center, context)
    if len(under) == 1 or scene.body(under[1]).anchored:
        carrier = _carrier_of(under[0], center, snap, scene)
        if carrier is not None:
            return scene.centroid(under[0]), (under[0], carrier)
    for name in under:
        if isinstance(scene.body(name).shape, Disc):
            x, y, _ = scene.pose(name)
            if math.dist((x, y), center) > snap:
                continue
            # The middle of a wheel, where it lies on the same bodies or near the other one.
            near = scene.bodies_at((x, y), snap)
            if scene.bodies_at((x, y))[:2] == under or (len(under) == 2 and set(under) <= {*near}):
                return (x, y), under
    return center, under


def crossed_pair(center: Point, context: Context) -> tuple[str, ...]:
    """
    Return the two topmost bodies at a point, else those that the stroke overlaps, too.

    In a gap between bodies, these are the two on either side of it.

    :param center: of a small closed stroke [m]
    :return: at most two names, the topmost first; () in the open
    """
    scene, drawn = context.scene, context.drawn.points
    under = scene.bodies_at(center)[:2]
    if len(under) == 2:
        return under
    radius = float(norms(drawn - center).max())
    near = scene.bodies_at(center, radius)
    shares = {each: float(scene.covers(each, drawn).mean()) for each in near if each not in under}
    beside = sorted(shares, key=shares.__getitem__, reverse=True)[: 2 - len(under)]
    pair = {*under, *(each for each in beside if shares[each] >= _ACROSS)}
    return tuple(each for each in near if each in pair) if len(pair) == 2 else under


def _carrier_of(wheel: str, center: Point, snap: float, scene: SceneQuery) -> str | None:
    """
    Return the movable body that a wheel overlaps and that is nearest to its middle.

    A wheel may stand half below its chassis; it never turns about the road on which it stands.

    :param wheel: name of the topmost body at the centre of the drawn circle
    :return: None where there is none, where the wheel is not round, or where the circle is not
        about its middle
    """
    form = scene.body(wheel).shape.form
    x, y = scene.centroid(wheel)
    if form.area < _ROUND * math.pi * form.outer**2:
        return None
    if math.dist((x, y), center) > max(snap, form.outer / 4):
        return None
    near = scene.bodies_at((x, y), _CARRIED * form.outer)
    dynamic = [each for each in near if each != wheel and scene.body(each).dynamic]

    def distance(name: str) -> float:
        covered = name in scene.bodies_at((x, y))
        return 0.0 if covered else math.dist((x, y), nearest_on_surface((x, y), name, scene))

    return min(dynamic, key=distance, default=None)
