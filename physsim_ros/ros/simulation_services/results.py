# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Result codes of `simulation_interfaces` for refusals."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from physsim_ros.model.errors import BadProperty, Refusal, UnknownBody
from simulation_interfaces.msg import Result


class Failed(Exception):
    """
    A refusal with its result code.

    :param refusal: why it is refused
    :param result: code of the standard
    """

    def __init__(self, refusal: Refusal, result: int) -> None:
        super().__init__(str(refusal))
        self.refusal, self.result = refusal, result


def failed(message: str, result: int, *, field: str = '') -> Failed:
    """Return the failure of a call whose values are wrong."""
    return Failed(BadProperty(message, field=field), result)


@contextmanager
def failing_with(result: int) -> Iterator[None]:
    """Give refusals a result code."""
    try:
        yield
    except Refusal as refusal:
        raise Failed(refusal, result) from refusal


def result_of(error: Failed | Refusal) -> tuple[Refusal, int]:
    """Return a refusal and its result code."""
    match error:
        case Failed():
            return error.refusal, error.result
        case UnknownBody():
            return error, int(Result.RESULT_NOT_FOUND)
    return error, int(Result.RESULT_OPERATION_FAILED)
