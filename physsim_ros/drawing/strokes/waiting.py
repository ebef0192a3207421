# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Strokes that wait for a body: the rod of a pendulum before its bob, the axle before its wheel.

Law: a joint, an x or an arrow that is drawn before its body is what it is when drawn after it. A
stroke that has been a wall, a small solid or an x over nothing is read again, over the new body,
and so is an arrow just before it, which turned gravity. A wall on which something lies, or whose
end the new body only touches from above or beside, stays one. One within the new body is a mark,
which has no effect; a second line may make an x of it. A round arrow that was drawn before the
axle inside it is its motor.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace
import itertools
import math

import numpy as np
from physsim_ros.drawing.geometry import point_of
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.bodies_under import SLOPE, stands_on
from physsim_ros.drawing.strokes.choice import is_likely, reading_of
from physsim_ros.drawing.strokes.figure import Figure
from physsim_ros.drawing.strokes.forms import arrow_of, cross_of
from physsim_ros.drawing.strokes.grouping import pause_between, SLOWLY
from physsim_ros.drawing.strokes.joining import joined_strokes
from physsim_ros.drawing.strokes.marks import lies_within, mark_reading
from physsim_ros.drawing.strokes.reading import guesses_of
from physsim_ros.drawing.strokes.resampled import few_points, middle_half
from physsim_ros.drawing.strokes.scene_after import scene_after
from physsim_ros.drawing.strokes.stages import Classification, MeaningKind, Reading
from physsim_ros.model.errors import Refusal
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import Configure, Delete, Join, Request, Spawn
from physsim_ros.model.shapes import contains
from physsim_ros.model.transform import rotated_each

# Meanings that a stroke has by the bodies under it, and by an axle.
_BY_BODIES = frozenset(
    {
        MeaningKind.ROD,
        MeaningKind.ROPE,
        MeaningKind.SPRING,
        MeaningKind.AXLE,
        MeaningKind.PIN,
        MeaningKind.ANCHOR,
        MeaningKind.VELOCITY,
    }
)
_BY_AXLE = frozenset({MeaningKind.MOTOR})


# The strokes of an earlier figure, and what they are over a new body.
Reread = tuple[tuple[Figure, ...], Reading]


def readings_over(
    figure: Figure, figures: Sequence[Figure], settings: DrawingSettings
) -> Iterator[Reread]:
    """
    Yield earlier strokes and their readings over a new body or axle, where those are others.

    :param figure: the new body or axle
    :param figures: drawn before, the earliest first
    """
    requests = list(figure.requests)
    if figure.is_solid:
        for group, reading in _readings_over_body(figure, figures, settings):
            requests += reading.requests
            yield group, reading
    yield from _motor(requests, figures, figure.scene, settings)


def _motor(
    requests: Sequence[Request],
    figures: Sequence[Figure],
    scene: SceneQuery,
    settings: DrawingSettings,
) -> Iterator[Reread]:
    """
    Yield the last round arrow over nothing whose axle is made now, with its reading.

    :param requests: of bodies and axles
    :param scene: before these
    """
    if not any(isinstance(each, Join) and each.kind is JointKind.AXLE for each in requests):
        return
    after = scene_after(requests, scene)
    for figure in reversed(figures):
        if figure.meaning not in _BY_AXLE or figure.requests:
            continue
        reading = _likely_reading(figure.whole, after, settings, _BY_AXLE)
        if reading is not None:
            yield (figure,), reading
            return


def _readings_over_body(
    solid: Figure, figures: Sequence[Figure], settings: DrawingSettings
) -> Iterator[Reread]:
    """Yield earlier strokes and their readings over a new body, where those are others."""
    spawn = next(each for each in solid.requests if isinstance(each, Spawn))
    requests = list(solid.requests)
    groups = list(_waiting(figures, solid, settings.snap))
    # A wall that is a rod itself is no end of another one.
    walls = _names(
        [each for each, *more in groups if each.meaning is MeaningKind.WALL and not more]
    )
    done: set[str] = set()
    for group in groups:
        names = _names(group)
        if names & done or not _reaches(group, spawn, settings.snap):
            continue
        over = scene_after(requests, solid.scene, without=names | walls | done)
        reading = _reading_over(spawn.name, group, over, settings)
        if reading is None and len(group) == 1 and _is_mark(group[0], solid):
            reading = mark_reading(group[0])
        if reading is None:
            continue
        done |= names
        requests += reading.requests
        yield group, replace(reading, requests=(*_undoing(group), *reading.requests))


def _waiting(
    figures: Sequence[Figure], solid: Figure, snap: float
) -> Iterator[tuple[Figure, ...]]:
    """Yield figures that wait: two walls, which may be an x, then each alone."""
    there = [each for each in figures if _is_there(each, solid.scene, snap)]
    walls = [each for each in there if each.meaning is MeaningKind.WALL]
    yield from itertools.pairwise(walls)
    for each in there:
        if each not in walls or _is_mark(each, solid) or not _bears(each, solid.scene, snap):
            yield (each,)
    # Of strokes that have become no body, a person has the last one in mind.
    if figures and _is_no_body(figures[-1], solid):
        yield (figures[-1],)


def _is_no_body(figure: Figure, solid: Figure) -> bool:
    """Return whether a figure is a sign over nothing, or turned gravity just before a new body."""
    match figure.requests:
        case ():
            return figure.chosen is not None
        case (Configure(changes={'gravity': gravity}),):
            still = solid.scene.settings.gravity == gravity
            return still and pause_between(figure, solid) <= SLOWLY
    return False


def _undoing(figures: Sequence[Figure]) -> Iterator[Request]:
    """Yield the requests by which what figures have become is gone."""
    yield from (Delete(name=each) for each in sorted(_names(figures)))
    for figure in figures:
        if figure.meaning is MeaningKind.GRAVITY:
            yield Configure(changes={'gravity': figure.scene.settings.gravity})


def _names(figures: Sequence[Figure]) -> set[str]:
    """Return the names of the bodies that figures have become."""
    requests = (each for figure in figures for each in figure.requests)
    return {each.name for each in requests if isinstance(each, Spawn)}


def _is_there(figure: Figure, scene: SceneQuery, snap: float) -> bool:
    """Return whether a figure has become one body, which lies where it was drawn, unjoined."""
    match figure.requests:
        case (Spawn(name=name, pose=(x, y, _)),) if name in scene.names:
            away = math.dist(scene.pose(name)[:2], (x, y))
            return away <= snap and not any(name in (each.a, each.b) for each in scene.joints)
    return False


def _is_mark(figure: Figure, solid: Figure) -> bool:
    """Return whether a figure is a wall within a solid that was drawn about it."""
    return figure.meaning is MeaningKind.WALL and lies_within(figure, solid)


def _bears(wall: Figure, scene: SceneQuery, snap: float) -> bool:
    """Return whether other bodies lie on the middle of a wall: it is no rod."""
    # The wheels that a rope runs around do not lie on it.
    held = _names((wall,)).union(each.a for each in scene.joints if each.b == WORLD)
    middle = map(point_of, middle_half(few_points(joined_strokes(wall.strokes))))
    near = {name for point in middle for name in scene.bodies_at(point, snap)}
    return any(scene.body(name).dynamic for name in near - held)


def _reaches(group: Sequence[Figure], body: Spawn, snap: float) -> bool:
    """Return whether a stroke of some figures comes within `snap` of a new body."""
    points = np.vstack([few_points(stroke) for each in group for stroke in each.strokes])
    x, y = rotated_each(points - body.pose[:2], -body.pose[2]).T
    return bool(np.any(contains(body.shape.form.pieces, x, y, snap)))


def _reading_over(
    name: str, group: Sequence[Figure], scene: SceneQuery, settings: DrawingSettings
) -> Reading | None:
    """Return the reading of figures that reach a new body, or None where it is the same."""
    strokes = [stroke for each in group for stroke in each.strokes]
    whole = cross_of(strokes) or arrow_of(strokes) or (group[0].whole if len(group) == 1 else None)
    if whole is None:
        return None
    reading = _likely_reading(whole, scene, settings, _BY_BODIES)
    if reading is None:
        return None
    ends = (point_of(each) for each in joined_strokes(strokes)[[0, -1]])
    within = (each for each in ends if name in scene.bodies_at(each))
    match reading.requests[0]:
        case Join(kind=JointKind.ROD | JointKind.ROPE):
            # A body hangs from the end of a wall within 45° of its top.
            held = not any(stands_on(name, each, scene, -SLOPE) for each in within)
        case Join(a=a, b=b):
            held = name in {a, b}
        case _:
            held = reading.subject == name
    return reading if held else None


def _likely_reading(
    stroke: Classification,
    scene: SceneQuery,
    settings: DrawingSettings,
    meanings: AbstractSet[MeaningKind],
) -> Reading | None:
    """Return the likeliest reading of a stroke if it can be built and is one of some meanings."""
    guesses = guesses_of(stroke, scene, settings)
    if not is_likely(guesses, settings) or guesses[0].meaning not in meanings:
        return None
    try:
        return reading_of(guesses, 0)
    except Refusal:
        return None
