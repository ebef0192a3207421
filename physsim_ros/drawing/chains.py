# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Chains: boxes along a curve, joined by axles to each other and to the bodies at its ends.

Law: links have equal lengths along the curve. A chain begins and ends at the surfaces of the
bodies that it joins, so that no link lies within them.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import islice, pairwise
import math

import numpy as np
from physsim_ros.drawing import new_bodies
from physsim_ros.drawing.geometry import path_length, point_of, spaced
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import BadSize
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import shown_end, WORLD
from physsim_ros.model.requests import Join, Request, Spawn
from physsim_ros.model.transform import Point
from physsim_ros.model.translation import counted, Text

# Length of a link by its thickness [1]: the proportions of an anchor chain.
_SLENDER = 3.0
# Greatest number of links, which become longer in a longer chain: a tenth of the bodies that a
# small machine plays in real time.
MOST_LINKS = 100
# Colour of links where none is chosen, so that they look like one thing.
_STEEL = (0.45, 0.49, 0.55, 1.0)
# Points for each link by which the surfaces of bodies are found [1].
_FINE = 16


def chain(
    path: Floats, ends: tuple[str, str], scene: SceneQuery, settings: DrawingSettings
) -> tuple[Request, ...]:
    """
    Return the requests for the links of a chain and their axles.

    :param path: (n, 2) float64: the curve, from its first end to its last [m]
    :param ends: names of the bodies there, or 'world' for the background
    :raises BadSize: there is no room for a link between them
    """
    link = _SLENDER * settings.wall_thickness
    fine = spaced(path, 2 + _FINE * _links(path_length(path), link))
    between = fine[_free_range(fine, ends, scene)]
    length = path_length(between)
    if length < settings.wall_thickness:
        raise BadSize('there is no room for a chain between these ends', field='point')
    knots = spaced(between, 1 + _links(length, link))
    names = [*islice(scene.new_bodies(), len(knots) - 1)]
    settings = replace(settings, draw_color=settings.draw_color or _STEEL)
    requests: list[Request] = [
        _link(name, start, end, settings)
        for name, (start, end) in zip(names, pairwise(map(point_of, knots)), strict=True)
    ]
    # A knot joins the link after it to the one before it; the last one has none after it.
    after, before = (*names, names[-1]), (ends[0], *names[:-1], ends[1])
    requests += [
        Join(name=name, kind=JointKind.AXLE, points=(point_of(knot),), a=a, b=b)
        for name, knot, a, b in zip(scene.new_joints(), knots, after, before, strict=False)
    ]
    return tuple(requests)


def message(requests: tuple[Request, ...], ends: tuple[str, str]) -> Text:
    """
    Return the message about a chain.

    :param requests: for its links and axles
    :param ends: names of the bodies there, or 'world' for the background
    """
    first, last = map(shown_end, ends)
    links = counted(len(requests) // 2, 'link')
    return Text('a chain of {links} from {first} to {last}', links=links, first=first, last=last)


def _links(length: float, link: float) -> int:
    """Return the number of links of a curve of a length [m]."""
    return min(MOST_LINKS, max(1, round(length / link)))


def _free_range(points: Floats, ends: tuple[str, str], scene: SceneQuery) -> slice:
    """Return the range of the points between the bodies at their ends."""
    first, last = 0, len(points)
    if ends[0] != WORLD:
        first = int(np.cumprod(scene.covers(ends[0], points)).sum())
    if ends[1] != WORLD:
        last -= int(np.cumprod(scene.covers(ends[1], points)[::-1]).sum())
    return slice(first, max(first, last))


def _link(name: str, start: Point, end: Point, settings: DrawingSettings) -> Spawn:
    (x, y), (dx, dy) = start, (end[0] - start[0], end[1] - start[1])
    pose = x + dx / 2, y + dy / 2, math.atan2(dy, dx)
    width, height = math.hypot(dx, dy), settings.wall_thickness
    return replace(new_bodies.rectangle(name, pose, width, height, settings), whole='chain')
