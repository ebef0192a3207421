# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages of the pen, the click tools and the hand, and of the material of new bodies."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
import time
from typing import Any, Literal

import numpy as np
from physsim_ros.drawing import Check, Reading, submit_reading, Tool
from physsim_ros.model.arrays import Floats
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checks import LONGEST, number, shown
from physsim_ros.model.colors import Color
from physsim_ros.model.errors import BadProperty, Confidences, Malformed, NotRecognised
from physsim_ros.model.requests import Grab, LetGo, MoveHand
from physsim_ros.model.settings import MOST_SAMPLES
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import Point
from physsim_ros.model.translation import Text
from physsim_ros.simulation.entries import Origin
from physsim_ros.sketchpad.locks import check_locked, check_taken_back
from physsim_ros.sketchpad.message import message, Optional, request_of
from physsim_ros.sketchpad.messages import fields
from physsim_ros.sketchpad.page_session import PageSession
from physsim_ros.sketchpad.rights import Right


def _samples(value: object, name: str) -> Floats:
    """Return (n, 3) float64: x, y [m], time by a clock of the page [s]."""
    if not isinstance(value, list) or not 0 < len(value) <= MOST_SAMPLES:
        raise Malformed('a stroke is a list of 1 to {most} points', field=name, most=MOST_SAMPLES)
    for point in value:
        if not isinstance(point, list) or len(point) != 3:
            raise Malformed('a point of a stroke is [x, y, time]', field=name)
        if not all(type(each) in (int, float) for each in point):
            raise BadProperty('a point of a stroke is three numbers', field=name)
    try:
        samples = np.array(value, dtype=np.float64)
    except OverflowError as error:
        raise Malformed('a sample of the stroke is not finite', field=name) from error
    if not np.isfinite(samples).all():
        raise Malformed('a sample of the stroke is not finite', field=name)
    with np.errstate(over='ignore'):
        duration = np.ptp(samples[:, 2])
    if duration > LONGEST:
        raise BadProperty('a stroke takes at most {most:g} s', field=name, most=LONGEST)
    return samples


def _tool(value: Any, name: str) -> Tool:
    if value not in list(Tool):
        raise BadProperty('there is no tool {value}', field=name, value=shown(value))
    return Tool(value)


def _property(value: object, name: str) -> object:
    """Return a property of a body."""
    return Properties.from_mapping({name: value}).explicit()[name]


def _color(value: object, name: str) -> Color | Literal['']:
    """Return a colour, or '' for the world's choice."""
    return '' if value == '' else fields.color(value, name)


# The pen


@message('stroke', '~/stroke', points=_samples)
def read_stroke(page: PageSession, origin: Origin, points: Floats) -> None:
    """Read a stroke, and submit the requests of its reading."""
    times = points[:, 2]
    # A stroke that has waited for a connection comes late: its arrival counts only without a time.
    began = float(times.min()) or time.monotonic() - float(np.ptp(times))
    snapshot = page.control.loop.bring_up_to_date()

    def read(check: Check) -> Reading:
        return page.person.drawing.stroke(points, '', snapshot, began=began, check=check)

    _submit(page, origin, snapshot, read)


@message('instead', '~/instead', meaning=Optional(fields.text))
def read_instead(page: PageSession, origin: Origin, meaning: str = '') -> None:
    """Replace the last reading by another guess; '' is the next one."""
    # The requests of the last reading may wait.
    snapshot, drawing = page.control.loop.bring_up_to_date(), page.person.drawing
    _submit(page, origin, snapshot, lambda check: drawing.instead(meaning, check=check))


def _submit(
    page: PageSession, origin: Origin, snapshot: Snapshot, read: Callable[[Check], Reading]
) -> None:
    """Send the page a reading that it has the right to, built or not, and submit its requests."""

    def check(reading: Reading) -> None:
        check_locked(page.role, reading.requests, page.control)
        check_taken_back(page.role, reading.amends, snapshot, page.control)

    try:
        reading = read(check)
    except NotRecognised as refusal:
        page.send(_reading_content(origin, refusal.guesses))
        raise
    page.send(_reading_content(origin, reading.confidences, reading))
    reading = replace(reading, requests=page.person.with_material(reading.requests))
    origin = page.checked_in_turn(origin, reading.requests)
    submit_reading(page.control.simulation, page.person.drawing, reading, origin)


def _reading_content(
    origin: Origin, confidences: Confidences, built: Reading | None = None
) -> dict[str, Any]:
    """Return the message of guesses, and of the reading that is built, if one is."""
    guesses = [(meaning, round(confidence, 3)) for meaning, confidence in confidences]
    (meaning, confidence), (second, second_confidence) = [*guesses, ('', 0.0), ('', 0.0)][:2]
    return {
        'type': 'reading',
        'request': request_of(origin),
        'meaning': meaning,
        'confidence': confidence,
        'runner_up': second,
        'runner_up_confidence': second_confidence,
        'guesses': guesses,
        'also': built.also if built else (),
        'outline': built.outline.tolist() if built else (),
        'built': built is not None,
    }


# Click tools


@message('click', 'clicked_point', tool=_tool, point=fields.point)
def click(page: PageSession, origin: Origin, tool: Tool, point: Point) -> None:
    """Add a point [m] to the gesture of a tool; another tool than before drops the gesture."""
    page.person.drawing.tool = tool
    result = page.person.drawing.click(point, '', page.control.loop.bring_up_to_date())
    requests = page.person.with_material(result.requests)
    page.submit(origin, requests, message=result.message)


@message('drop', 'page', Right.DRAW)
def drop(page: PageSession, origin: Origin) -> None:
    """Drop the unfinished gesture."""
    page.person.drawing.drop()
    page.answer_page(origin, Text('dropped what was unfinished'))


@message(
    'draw_with',
    'page',
    Right.DRAW,
    density=Optional(_property),
    friction=Optional(_property),
    elasticity=Optional(_property),
    velocity=Optional(_property),
    color=Optional(_color),
)
def draw_with(
    page: PageSession,
    origin: Origin,
    color: Color | Literal[''] | None = None,
    **properties: Any,
) -> None:
    """Choose the material of the next bodies of this page; properties that are not given stay."""
    page.person.material = replace(page.person.material, **properties)
    if color is not None:
        page.person.color = color or None
    page.answer_page(origin, Text('the material of what is drawn next'))


# The hand


@message('grab', '~/drag/feedback', point=fields.point)
def grab(page: PageSession, origin: Origin, point: Point) -> None:
    """Grab the body at a point [m]."""
    page.use_hand(origin, Grab(hand=page.hand, point=point))


@message('move', '~/drag/feedback', point=fields.point, yaw=Optional(number))
def move(page: PageSession, origin: Origin, point: Point, yaw: float | None = None) -> None:
    """Move the hand to a point [m]; turn a body that is placed to a yaw [rad]."""
    page.use_hand(origin, MoveHand(hand=page.hand, point=point, yaw=yaw))


@message('let_go', '~/drag/feedback', Right.DRAW)
def let_go(page: PageSession, origin: Origin) -> None:
    """Let go of the body that the hand holds."""
    page.use_hand(origin, LetGo(hand=page.hand))
