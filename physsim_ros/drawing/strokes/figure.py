# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Figures: the last things that a person drew, each of one or several strokes, with their guesses.

People draw one thing in several strokes, in any order: an x or an arrow of two, a square of four
lines. Strokes that touch and follow one another within `regroup` seconds are read together. If
that reading is better than open lines, it replaces the readings of the single strokes.

Law: a figure changes nothing in the world.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, replace
import itertools
import math

import numpy as np
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.forms import sign_forms
from physsim_ros.drawing.strokes.geometry import few_points, middle_half, size_of
from physsim_ros.drawing.strokes.joining import (
    connected,
    joined_arrow,
    joined_strokes,
    touch,
    touching,
)
from physsim_ros.drawing.strokes.meanings import (
    CLOSED,
    Context,
    DELETION,
    GRAVITY,
    OPEN,
    Outcome,
)
from physsim_ros.drawing.strokes.plain_forms import DISC, POLYGON, RECTANGLE
from physsim_ros.drawing.strokes.reading import (
    Guess,
    guesses_of,
    in_scene,
    is_likely,
    MOST_GUESSES,
    Reading,
    reading_of,
)
from physsim_ros.drawing.strokes.signs import x
from physsim_ros.drawing.strokes.signs.arrow import ARROW
from physsim_ros.drawing.strokes.stroke import resample_stroke, Stroke
from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.errors import Refusal
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import ChangeBody, Join, Request, Spawn
from physsim_ros.model.transform import next_vertices

# The greatest number of strokes of one figure.
MOST_STROKES = 8
# The greatest CPU time for reading strokes together [s]: a reading takes some 3 ms.
MOST_TIME = 0.01
# Meanings of open lines that join nothing.
_LOOSE = frozenset({'wall', 'hatching'})
# Meanings that several strokes may have together; those of an arrow alone.
_ARROWS = frozenset({GRAVITY, 'velocity'})
# Meanings of the heads of arrows, closed and filled, without their shafts.
_HEADS = frozenset({POLYGON, DELETION})
_JOINED = CLOSED | _ARROWS | {'anchor', 'motor'}
# Signs on a body that two strokes are however slowly they are drawn, and the longest pause between
# these [s]: two lines across a body, and a rod with barbs at its free end, are nothing else.
_ON_BODIES, SLOWLY = frozenset({'anchor', 'velocity'}), 10.0
# The least share of the middle half of a line that lies on a solid whose mark it is.
_ON_SOLID = 0.6


@dataclass(slots=True, kw_only=True, eq=False)
class Figure:
    """
    One or several strokes that are read together.

    :param strokes: each (COUNT, 2) float64: evenly spaced [m]
    :param began: when its first stroke began [s]
    :param ended: when its last stroke ended [s]
    :param scene: over which the first one was drawn
    :param guesses: its possible meanings, the likeliest first
    :param chosen: index of the guess that was taken; None where it was not recognised
    :param requests: of that reading; () where the world cannot have it
    :param gestures: numbers of the gestures with which these were submitted
    """

    strokes: tuple[Floats, ...]
    began: float
    ended: float
    scene: SceneQuery
    guesses: tuple[Guess, ...]
    chosen: int | None = None
    requests: tuple[Request, ...] = ()
    gestures: tuple[int, ...] = ()

    @classmethod
    def read(
        cls, context: Context, *, strokes: tuple[Floats, ...], began: float, ended: float
    ) -> Figure:
        """
        Return a figure with the guesses at its meaning; the first one is taken if it is likely.

        :param context: its strokes as one, in the scene that they were drawn over
        """
        guesses = guesses_of(context)
        likely = is_likely(guesses, context.settings)
        return cls(
            strokes=strokes,
            began=began,
            ended=ended,
            scene=context.scene,
            guesses=guesses,
            chosen=0 if likely else None,
            requests=_requests_of(guesses[0]) if likely else (),
        )

    @property
    def meaning(self) -> str:
        """Return the meaning that it was read with; '' where it was not recognised."""
        return '' if self.chosen is None else self.guesses[self.chosen].meaning

    @property
    def is_open(self) -> bool:
        """Return whether it is an open line, or not recognised, and joins no two bodies."""
        to_background = any(isinstance(each, Join) and each.b == WORLD for each in self.requests)
        return self.is_line and (self.meaning in {'', *_LOOSE} or to_background)

    @property
    def is_line(self) -> bool:
        """Return whether it is an open line, or not recognised."""
        return not self.meaning or self.meaning in OPEN

    @property
    def is_arrow(self) -> bool:
        """Return whether it is a straight arrow."""
        return self.meaning in _ARROWS

    @property
    def is_part(self) -> bool:
        """Return whether it may be a part of a figure of several strokes."""
        return self.is_line or self.is_arrow or self.meaning in _HEADS

    @property
    def is_solid(self) -> bool:
        """Return whether it is a body of its own."""
        return self.meaning in {DISC, RECTANGLE, POLYGON}

    def offer_gravity(self, reading: Reading) -> Reading:
        """Return a reading of a body with the guess that the arrow before it did turn gravity."""
        chosen, *rest = reading.guesses
        # The body alone is built.
        turned = replace(chosen, meaning=GRAVITY, confidence=1.0 - chosen.confidence)
        rest = [each for each in rest if each.meaning != GRAVITY]
        self.guesses, self.chosen = (chosen, turned, *rest)[:MOST_GUESSES], 0
        return replace(reading, guesses=self.guesses)

    @property
    def other_guesses(self) -> list[int]:
        """Return the indices of the other guesses, beginning with the next likely one."""
        count = len(self.guesses)
        if self.chosen is None:
            return list(range(count))
        return [(self.chosen + step) % count for step in range(1, count)]


def likeliest_group(
    figures: Sequence[Figure],
    last: Figure,
    settings: DrawingSettings,
    clock: Callable[[], float],
) -> Figure | None:
    """
    Return the last strokes as one figure, if that is better than each stroke by itself.

    :param figures: drawn before, the earliest first
    :param last: the new one, of a single stroke
    :param clock: returns a time [s]; after `MOST_TIME` the stroke is read by itself
    """
    began = clock()
    hatching = _is_hatching((*figures, last))
    for group in _groups(figures, last, settings):
        if clock() > began + MOST_TIME:
            return None
        whole = _as_one(group, settings)
        if whole is not None and not (hatching and whole.meaning == 'anchor'):
            whole.gestures = tuple(number for figure in group for number in figure.gestures)
            return whole
    return None


def _as_one(group: Sequence[Figure], settings: DrawingSettings) -> Figure | None:
    """Return figures as one, or None where that is no better than each by itself."""
    walls = {
        each.name
        for figure in group
        for each in figure.requests
        if isinstance(each, Spawn) and figure.meaning == 'wall'
    }
    joints = [_leaves_its_bodies(figure, walls) for figure in group]
    if all(joints):
        # Rods from body to body to body are a truss, no polygon.
        return None
    for context, meanings in _contexts_together(group, settings):
        whole = Figure.read(
            context,
            strokes=tuple(stroke for figure in group for stroke in figure.strokes),
            began=group[0].began,
            ended=group[-1].ended,
        )
        # Two walls that cross are no x in the open: it has no requests.
        better = whole.meaning in meanings and bool(whole.requests)
        if better and (whole.meaning in CLOSED or not any(joints)):
            return whole
    return None


def _contexts_together(
    group: Sequence[Figure], settings: DrawingSettings
) -> Iterator[tuple[Context, AbstractSet[str]]]:
    """Yield what figures may be together, each in its scene with the meanings to look for."""
    scene = group[0].scene
    strokes = tuple(stroke for figure in group for stroke in figure.strokes)
    pairs = itertools.pairwise(group)
    in_time = all(_follows(figure, later, settings) for figure, later in pairs)
    cross = crossing_in(scene, strokes, settings)
    if cross is not None:
        yield cross, _JOINED if in_time else _ON_BODIES
        return
    arrow = arrow_in(scene, strokes, settings)
    if arrow is not None:
        yield arrow, _ARROWS if in_time else _ON_BODIES
    if not in_time:
        return
    # A solid, or a scribble, is part of an arrow alone; several lines may be an arrow so far.
    *before, last = group
    if last.is_line and all(
        each.is_line or _is_side(last, each, settings) or (each.is_arrow and len(each.strokes) > 1)
        for each in before
    ):
        yield in_scene(_joined(joined_strokes(strokes)), scene, settings), _JOINED


def crossing_in(
    scene: SceneQuery, strokes: Sequence[Floats], settings: DrawingSettings
) -> Context | None:
    """Return strokes in a scene if they are an x of two lines, else None."""
    cross = x.of_lines(strokes)
    if cross is None:
        return None
    return in_scene(_joined(joined_strokes(strokes)), scene, settings, lambda _: (cross,))


def arrow_in(
    scene: SceneQuery, strokes: Sequence[Floats], settings: DrawingSettings
) -> Context | None:
    """Return strokes in a scene as an arrow if they are a shaft and its head, else None."""
    arrow = joined_arrow(strokes)
    if arrow is None:
        return None
    # The gaps between the parts are no evidence for other forms.
    return in_scene(_joined(arrow), scene, settings, lambda it: sign_forms(it, (ARROW,))[0])


def _joined(path: Floats) -> Stroke:
    """Return strokes that are joined as one: one more may close a gap, its ends do not tell."""
    return replace(resample_stroke(path), relatability=0.0)


def marked_solid(figures: Sequence[Figure], last: Figure, settings: DrawingSettings) -> bool:
    """Return whether the last stroke is a line through the solid that was drawn before it."""
    if not figures or not figures[-1].is_solid or not last.is_open:
        return False
    solid = figures[-1]
    if not _follows(solid, last, settings) or _is_side(last, solid, settings):
        return False
    return lies_within(last, solid)


def lies_within(line: Figure, solid: Figure) -> bool:
    """Return whether most of the middle half of a line lies within the outline of a solid."""
    outline = joined_strokes(solid.strokes)
    points = np.vstack([middle_half(stroke) for stroke in line.strokes])
    return float(_inside(points, outline).mean()) >= _ON_SOLID


def mark_reading(line: Figure) -> Reading:
    """Return the reading of a line within a solid: a mark, which has no requests."""
    mark = Guess(
        meaning='mark',
        confidence=line.guesses[0].confidence if line.guesses else 1.0,
        group_confidence=1.0,
        build=lambda: Outcome(
            requests=(), subject='', message='a mark, which has no effect', outline=line.strokes[0]
        ),
    )
    return reading_of((mark, *line.guesses), 0)


def _requests_of(guess: Guess) -> tuple[Request, ...]:
    """Return the requests of a guess; none where the world cannot have it."""
    try:
        return guess.build().requests
    except Refusal:
        return ()


def _groups(
    figures: Sequence[Figure], last: Figure, settings: DrawingSettings
) -> Iterator[list[Figure]]:
    """Yield the last figures that may be one with the new one, the most figures first."""
    if not last.is_part:
        return
    group = [last]
    for figure in reversed(figures):
        count = sum(len(each.strokes) for each in (figure, *group))
        part = figure.is_part or _is_side(last, figure, settings)
        if not part or count > MOST_STROKES or not _follows(figure, group[0], settings):
            break
        group.insert(0, figure)
    if len(group) == 1 and figures and _follows_slowly(figures[-1], last, settings):
        group.insert(0, figures[-1])
    meeting = touching([stroke for each in group for stroke in each.strokes], settings.snap)
    for first in range(len(group) - 1):
        before = sum(len(each.strokes) for each in group[:first])
        if len(connected(meeting[before:, before:])) == 1:
            yield group[first:]


def _follows(figure: Figure, later: Figure, settings: DrawingSettings) -> bool:
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
        if figure.meaning == 'hatching'
    ]
    return len(hatched) == 2 and hatched[0] == hatched[1]


def _leaves_its_bodies(figure: Figure, walls: AbstractSet[str]) -> bool:
    """
    Return whether a figure is a joint of two bodies that also lies beside them.

    :param walls: names of bodies that are no ends of joints: other strokes of the same figure
    """
    points, scene = np.vstack([few_points(stroke) for stroke in figure.strokes]), figure.scene
    return any(
        float((scene.covers(each.a, points) | scene.covers(each.b, points)).mean()) < _ON_SOLID
        for each in figure.requests
        if isinstance(each, Join) and not {each.a, each.b} & {'', WORLD, *walls}
    )


def _is_side(line: Figure, figure: Figure, settings: DrawingSettings) -> bool:
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


def _inside(points: Floats, outline: Floats) -> Flags:
    """Return whether points lie in a closed polyline, by the crossings of a ray (even-odd)."""
    start, end = outline, next_vertices(outline)
    x, y = points[:, :1], points[:, 1:]
    passes = (start[:, 1] > y) != (end[:, 1] > y)
    height = np.where(end[:, 1] == start[:, 1], 1.0, end[:, 1] - start[:, 1])
    at = start[:, 0] + (y - start[:, 1]) / height * (end[:, 0] - start[:, 0])
    inside: Flags = np.count_nonzero(passes & (x < at), axis=1) % 2 == 1
    return inside
