# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Result codes of `simulation_interfaces` for refusals, and bounds of bodies."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from geometry_msgs.msg import Vector3
from physsim_ros.model.errors import BadProperty, Refusal, UnknownBody
from physsim_ros.model.shapes import extent_of
from physsim_ros.model.translation import verbatim
from simulation_interfaces.msg import Bounds, Result


class CodedRefusal(BadProperty):
    """
    A refusal with its result code; its other code is that of the refusal that it is made of.

    :param refusal: why it is refused
    :param result: code of the standard
    """

    def __init__(self, refusal: Refusal, result: int) -> None:
        super().__init__(refusal.text, field=refusal.field, concerns=refusal.concerns)
        self.code, self.details, self.result = refusal.code, refusal.details, result


def coded(message: str, result: int, *, field: str = '') -> CodedRefusal:
    """Return the refusal of a call whose values are wrong."""
    return CodedRefusal(BadProperty(verbatim(message), field=field), result)


@contextmanager
def coding_refusals(result: int) -> Iterator[None]:
    """Give refusals a result code."""
    try:
        yield
    except Refusal as refusal:
        raise CodedRefusal(refusal, result) from refusal


def result_of(refusal: Refusal) -> int:
    """Return the result code of a refusal."""
    match refusal:
        case CodedRefusal():
            return refusal.result
        case UnknownBody():
            return int(Result.RESULT_NOT_FOUND)
    return int(Result.RESULT_OPERATION_FAILED)


def box_around(shape: Any) -> Bounds:
    """Return the box around a shape, in its own frame."""
    low, high = extent_of(shape.form)
    points = [Vector3(x=high[0], y=high[1]), Vector3(x=low[0], y=low[1])]
    return Bounds(type=Bounds.TYPE_BOX, points=points)
