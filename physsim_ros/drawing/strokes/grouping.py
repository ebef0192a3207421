# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Strokes that are read together, and whether that is better than each by itself.

People draw one thing in several strokes, in any order: an x or an arrow of two, a square of four
lines. Strokes that touch and follow one another within `regroup` seconds are read together. If
that reading is better than open lines, it replaces the readings of the single strokes.

Law: grouping changes nothing in the world, nor in the figures that it is asked about.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace
import itertools
import math

import numpy as np
from physsim_ros.drawing.geometry import connected, size_of
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.figure import ARROWS, Figure, ON_SOLID
from physsim_ros.drawing.strokes.forms import arrow_of, cross_of, path_of
from physsim_ros.drawing.strokes.joining import (
    are_sides,
    joined_strokes,
    touch,
    touching,
)
from physsim_ros.drawing.strokes.resampled import few_points
from physsim_ros.drawing.strokes.stages import Classification, CLOSED, MeaningKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import ChangeBody, Join, Spawn

# The greatest number of strokes of one figure.
MOST_STROKES = 8
# The greatest CPU time for reading strokes together [s]: a reading takes some 3 ms.
MOST_TIME = 0.01
# Meanings that several strokes may have together.
_JOINED = CLOSED | ARROWS | {MeaningKind.ANCHOR, MeaningKind.MOTOR}
# Signs on a body that two strokes are however slowly they are drawn, and the longest pause between
# these [s]: two lines across a body, and a rod with barbs at its free end, are nothing else.
_ON_BODIES, SLOWLY = frozenset({MeaningKind.ANCHOR, MeaningKind.VELOCITY}), 10.0


def grouped(
    figures: Sequence[Figure],
    last: Figure,
    settings: DrawingSettings,
    clock: Callable[[], float],
) -> tuple[Figure, ...]:
    """
    Return figures with a new stroke: as one with those just before it, if that is better.

    :param figures: drawn before, the earliest first
    :param last: the new one, of a single stroke
    :param clock: returns a time [s]; after `MOST_TIME` the stroke is read by itself
    """
    began = clock()
    hatching = _is_hatching((*figures, last))
    for group in _groups(figures, last, settings):
        if clock() > began + MOST_TIME:
            break
        whole = _as_one(group, settings)
        if whole is not None and not (hatching and whole.meaning is MeaningKind.ANCHOR):
            gestures = tuple(number for figure in group for number in figure.gestures)
            before = len(figures) + 1 - len(group)
            return *figures[:before], replace(whole, gestures=gestures)
    return *figures, last


def _groups(
    figures: Sequence[Figure], last: Figure, settings: DrawingSettings
) -> Iterator[list[Figure]]:
    """Yield the last figures that may be one with the new one, the most figures first."""
    if not last.is_part:
        return
    group = [last]
    for figure in reversed(figures):
        count = sum(len(each.strokes) for each in (figure, *group))
        part = figure.is_part or is_side(last, figure, settings)
        if not part or count > MOST_STROKES or not follows(figure, group[0], settings):
            break
        group.insert(0, figure)
    if len(group) == 1 and figures and _follows_slowly(figures[-1], last, settings):
        group.insert(0, figures[-1])
    meeting = touching([stroke for each in group for stroke in each.strokes], settings.snap)
    for first in range(len(group) - 1):
        before = sum(len(each.strokes) for each in group[:first])
        if len(connected(meeting[before:, before:])) == 1:
            yield group[first:]


def _as_one(group: Sequence[Figure], settings: DrawingSettings) -> Figure | None:
    """Return figures as one, or None where that is no better than each by itself."""
    walls = {
        each.name
        for figure in group
        for each in figure.requests
        if isinstance(each, Spawn) and figure.meaning is MeaningKind.WALL
    }
    joints = [_leaves_its_bodies(figure, walls) for figure in group]
    if all(joints):
        # Rods from body to body to body are a truss, no polygon.
        return None
    for together, meanings in _together(group, settings):
        whole = Figure.read(
            together,
            group[0].scene,
            settings,
            strokes=tuple(stroke for figure in group for stroke in figure.strokes),
            began=group[0].began,
            ended=group[-1].ended,
        )
        # Two walls that cross are no x in the open: it has no requests.
        better = whole.meaning in meanings and bool(whole.requests)
        if better and (whole.meaning in CLOSED or not any(joints)):
            return whole
    return None


def _together(
    group: Sequence[Figure], settings: DrawingSettings
) -> Iterator[tuple[Classification, AbstractSet[MeaningKind]]]:
    """Yield what figures may be together, each with the meanings that make it better."""
    strokes = tuple(stroke for figure in group for stroke in figure.strokes)
    pairs = itertools.pairwise(group)
    in_time = all(follows(figure, later, settings) for figure, later in pairs)
    cross = cross_of(strokes)
    if cross is not None:
        yield cross, _JOINED if in_time else _ON_BODIES
        return
    arrow = arrow_of(strokes)
    if arrow is not None:
        yield arrow, ARROWS if in_time else _ON_BODIES
    if not in_time:
        return
    # A solid, or a scribble, is part of an arrow alone; several lines may be an arrow so far.
    *before, last = group
    if last.is_line and all(
        each.is_line or is_side(last, each, settings) or (each.is_arrow and len(each.strokes) > 1)
        for each in before
    ):
        meanings = _JOINED if are_sides(strokes) else _JOINED - CLOSED
        yield path_of(strokes), meanings


def follows(figure: Figure, later: Figure, settings: DrawingSettings) -> bool:
    """Return whether a figure begins soon enough after another to be read with it."""
    return 0.0 < settings.regroup >= pause_between(figure, later)


def pause_between(figure: Figure, later: Figure) -> float:
    """
    Return the pause between two strokes, < 0 where they overlap [s].

    It is infinite where the later one began earlier: the times are of two clocks.
    """
    return later.began - figure.ended if later.began >= figure.began else math.inf


def _follows_slowly(figure: Figure, later: Figure, settings: DrawingSettings) -> bool:
    """Return whether two strokes, later than `regroup`, may still be a sign on a body."""
    part = figure.is_line and settings.regroup > 0.0
    return part and pause_between(figure, later) <= max(SLOWLY, settings.regroup)


def _is_hatching(figures: Sequence[Figure]) -> bool:
    """Return whether both figures before the last one hatch one body: the last one does, too."""
    hatched = [
        {each.name for each in figure.requests if isinstance(each, ChangeBody)}
        for figure in figures[-3:-1]
        if figure.meaning is MeaningKind.HATCHING
    ]
    return len(hatched) == 2 and hatched[0] == hatched[1]


def _leaves_its_bodies(figure: Figure, walls: AbstractSet[str]) -> bool:
    """
    Return whether a figure is a joint of two bodies that also lies beside them.

    :param walls: names of bodies that are no ends of joints: other strokes of the same figure
    """
    points, scene = np.vstack([few_points(stroke) for stroke in figure.strokes]), figure.scene
    return any(
        float((scene.covers(each.a, points) | scene.covers(each.b, points)).mean()) < ON_SOLID
        for each in figure.requests
        if isinstance(each, Join) and not {each.a, each.b} & {'', WORLD, *walls}
    )


def is_side(line: Figure, figure: Figure, settings: DrawingSettings) -> bool:
    """Return whether a line is one more side of a solid: it joins the ends of its strokes."""
    if len(figure.strokes) < 2 or not figure.is_solid:
        return False
    (stroke,) = line.strokes
    first, last = (end[None] for end in stroke[[0, -1]])
    ends = joined_strokes(figure.strokes)
    begin, end = ends[:1], ends[-1:]
    size = size_of(ends)
    return any(
        touch(first, one, size, settings.snap) and touch(last, other, size, settings.snap)
        for one, other in ((begin, end), (end, begin))
    )
