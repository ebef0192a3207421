# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A lesson: a task of mechanics that belongs to a world.

Its question is answered by one figure, which is measured in the world.
"""

from dataclasses import dataclass
from typing import Annotated, Any

from physsim_ros.model.checks import HEAVIEST, number, text, Whole, Within
from physsim_ros.model.declarations import Checked
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.settings import Bounds, rectangle
from physsim_ros.model.texts import is_printable

# Greatest length of a text [characters]: a page of a book.
LONGEST_TEXT = 2000
# Greatest length of a title and of a unit [characters].
LONGEST_TITLE, LONGEST_UNIT = 80, 20


def _text(longest: int) -> Any:
    """
    Return a check of texts of at most a length [characters], which are not empty.

    They have no other control characters than line breaks, as labels of bodies.
    """

    def check(value: object, name: str) -> str:
        # Folded lines of YAML end with a line break.
        line = text(value, name, BadProperty).strip()
        if not 0 < len(line) <= longest:
            raise BadProperty(
                '{field} must have 1 to {longest} characters', field=name, longest=longest
            )
        if not is_printable(line.replace('\n', '')):
            raise BadProperty('{field} has an unprintable character', field=name)
        return line

    return check


@dataclass(frozen=True, slots=True, kw_only=True)
class Lesson(Checked):
    """
    A task that belongs to a world.

    :raises BadProperty: a value is of the wrong type or out of range
    :raises Malformed: a number is not finite
    """

    number: Annotated[int, Whole(1, 10_000), 'place among all lessons']
    title: Annotated[str, _text(LONGEST_TITLE), 'of the lesson']
    question: Annotated[str, _text(LONGEST_TEXT), 'that is asked']
    hint: Annotated[str, _text(LONGEST_TEXT), 'for those who do not know how to begin']
    measure: Annotated[
        str,
        _text(LONGEST_TEXT),
        'the quantity that answers the question, and how it is measured',
    ]
    unit: Annotated[str, _text(LONGEST_UNIT), "of that quantity; '1' is none"]
    figure: Annotated[float, number, 'its true value, in that unit']
    within: Annotated[
        float, Within(0.0, HEAVIEST), 'greatest error of a measured value, in that unit'
    ]
    answer: Annotated[str, _text(LONGEST_TEXT), 'the law behind the figure']
    view: Annotated[
        Bounds | None,
        rectangle,
        'what is shown first, the bodies and where they go: xmin, ymin, xmax, ymax [m]; without '
        'it, the bounds of the world, or its bodies',
    ] = None
