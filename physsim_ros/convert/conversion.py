# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A world file in the making, and the shapes and poses that several programs have alike."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
import itertools
import math
import re
from typing import NamedTuple

from physsim_ros.convert.content import BadContent, Content
from physsim_ros.files import yaml_line
from physsim_ros.model.checks import Within
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Circle, Convex
from physsim_ros.model.transform import Point, Pose

# Greatest number of bodies: that of a world where nothing else is asked for.
MOST_BODIES = WorldSettings().max_bodies
# Settings of worlds that are seen from above: bodies lie on a floor that they rub on.
SEEN_FROM_ABOVE: Mapping[str, object] = {'gravity': [0.0, 0.0], 'floor_friction': 0.6}
# Thickness of outlines that are lines [m], and corners of a disc that becomes a polygon.
THICKNESS = 0.05
_CORNERS = 24
# Greatest distance [m] of places that count as one: a line on the screen of an editor.
GAP = 0.01


@dataclass
class Conversion:
    """
    A world file in the making.

    :ivar settings: of the world
    :ivar sentences: about what has no like here, with the number of cases
    """

    settings: dict[str, object] = field(default_factory=dict)
    bodies: list[dict[str, object]] = field(default_factory=list)
    joints: list[dict[str, object]] = field(default_factory=list)
    sentences: Counter[str] = field(default_factory=Counter)
    # Numbers of bodies and of joints by their names without ids.
    _bodies_of: Counter[str] = field(default_factory=Counter)
    _joints_of: Counter[str] = field(default_factory=Counter)

    def add_body(
        self, name: str, shape: Mapping[str, object], at: Pose, **properties: object
    ) -> str:
        """
        Add a body; return its name, which is `<name>/<id>`.

        :raises BadContent: there are too many
        """
        if len(self.bodies) >= MOST_BODIES:
            raise BadContent(f'there are more than {MOST_BODIES:,} bodies')
        full = _next_name(name or 'body', self._bodies_of)
        self.bodies.append({'name': full, **shape, 'at': [*at], **properties})
        return full

    def add_joint(
        self, name: str, kind: str, points: Sequence[Point], **properties: object
    ) -> None:
        """Add a joint; `a` and `b` are among its properties."""
        full = _next_name(name or kind, self._joints_of)
        places = [[x, y] for x, y in points]
        self.joints.append({'name': full, 'kind': kind, 'points': places, **properties})

    def tell(self, sentence: str) -> None:
        """Note something that becomes something else, or is left out."""
        self.sentences[sentence] += 1

    def leave_out(self, content: Content, sentence: str) -> None:
        """Note that all of a mapping is left out, with whatever is in it."""
        content.settle()
        self.tell(f'left out: {sentence}')

    def solid_parts(
        self, parts: Sequence[Content], is_sensor: Callable[[Content], bool]
    ) -> list[Content]:
        """Return the solid parts of a body; if there are any, its sensors are left out."""
        solid = [each for each in parts if not is_sensor(each)]
        for each in parts if solid else ():
            if each not in solid:
                self.leave_out(each, 'a sensor that is a part of a solid body')
        return solid

    def of_first(self, parts: Sequence[Content], key: str) -> float:
        """Return a number of the first part of a body, which counts for all; tell others."""
        first, *others = (each.number(key, 0.0) for each in parts)
        if any(other != first for other in others):
            self.tell(f'parts of a body differ in {key}: that of the first one counts')
        return first

    def common_anchor(self, first: Point, second: Point) -> Point:
        """Return where two anchors are [m] that their joint pulls together; tell if it has to."""
        if math.dist(first, second) > GAP:
            self.tell('a joint whose two anchors are apart is at one of the two')
        return first

    def told(self) -> Iterator[str]:
        """Yield the sentences about what is left out, each once."""
        for sentence, count in sorted(self.sentences.items()):
            yield f'{sentence} ({count} times)' if count > 1 else sentence

    def text(self) -> str:
        """Return the world file."""
        lines = ['format: 1\n']
        lines += (f'{key}: {yaml_line(value)}\n' for key, value in self.settings.items())
        for key, entries in (('bodies', self.bodies), ('joints', self.joints)):
            lines.append(f'{key}:\n' if entries else f'{key}: []\n')
            lines += (f'  - {yaml_line(entry)}\n' for entry in entries)
        return ''.join(lines)


class Line(NamedTuple):
    """An open line of a body, in the body's frame [m]."""

    points: tuple[Point, ...]


Piece = Circle | Convex | Line


def shape_of(pieces: Sequence[Piece], conversion: Conversion) -> tuple[dict[str, object], Point]:
    """
    Return the shape that pieces make together, and its origin in the frame of the body.

    :raises BadContent: there is no piece
    """
    match pieces:
        case []:
            raise BadContent('there is a body without a shape')
        case [Circle(center, radius)]:
            return {'circle': {'radius': radius}}, center
        case [Convex(points)]:
            return {'polygon': [list(point) for point in points]}, (0.0, 0.0)
        case [Line(points)]:
            return line_shape(points), (0.0, 0.0)
    discs = [piece for piece in pieces if isinstance(piece, Circle)]
    if len(discs) == len(pieces) and len({disc.radius for disc in discs}) == 1:
        centers = [list(disc.center) for disc in discs]
        compound = {'circle': {'radius': discs[0].radius}, 'centers': centers}
        return {'compound': compound}, (0.0, 0.0)
    triangles: list[list[float]] = []
    for piece in pieces:
        if isinstance(piece, Line):
            conversion.tell('left out: a line that is a part of a larger body')
            continue
        if isinstance(piece, Circle):
            conversion.tell(f'a disc of a larger body has {_CORNERS} corners')
            outline = disc_outline((piece.radius, piece.radius), piece.center)
        else:
            outline = piece
        first, *rest = outline.vertices
        for second, third in itertools.pairwise(rest):
            triangles += [list(first), list(second), list(third)]
    return {'triangles': triangles}, (0.0, 0.0)


def line_shape(points: Sequence[Point]) -> dict[str, object]:
    """Return the shape of a line."""
    return {'chain': {'points': [list(point) for point in points], 'thickness': THICKNESS}}


def disc_outline(radii: Point, center: Point = (0.0, 0.0)) -> Convex:
    """Return the outline of an ellipse, by half its width and half its height [m]."""
    (x, y), (a, b) = center, radii
    angles = [math.tau * i / _CORNERS for i in range(_CORNERS)]
    return Convex(tuple((x + a * math.cos(each), y + b * math.sin(each)) for each in angles))


def area_of(piece: Piece) -> float:
    """Return the area of a piece [m²]; 0 for a line."""
    match piece:
        case Circle(radius=radius):
            return math.pi * radius**2
        case Line():
            return 0.0
        case Convex(points):
            following = (*points[1:], points[0])
            pairs = zip(points, following, strict=True)
            return abs(sum(x * v - u * y for (x, y), (u, v) in pairs)) / 2


def clamped(value: float, check: Within) -> float:
    """Return the number nearest to a value that passes a check."""
    return min(max(value, check.low), check.high)


def _next_name(name: str, counts: Counter[str]) -> str:
    """Return the next `<name>/<id>`, and count it."""
    plain = re.sub(r'[^\w.-]+', '_', name) or 'body'
    counts[plain] += 1
    return f'{plain}/{counts[plain] - 1}'
