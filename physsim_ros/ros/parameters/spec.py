# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The specification of a parameter: default, description, unit and range."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.parameter import Parameter

Type = Parameter.Type


@dataclass(frozen=True, slots=True, kw_only=True)
class Spec:
    """
    The specification of a parameter.

    :param default: its value and type
    :param meaning: description in one line, with the unit
    :param low: least value
    :param high: greatest value
    :param choices: allowed values, empty for any
    :param read_only: whether it is fixed after start
    """

    default: Any
    meaning: str
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    read_only: bool = False

    @property
    def kind(self) -> Type:
        """Return the type of the parameter."""
        if isinstance(self.default, list):
            return Type.DOUBLE_ARRAY
        kind: Type = Type.from_parameter_value(self.default)
        return kind

    @property
    def descriptor(self) -> ParameterDescriptor:
        """Return the descriptor for `ros2 param describe`."""
        descriptor = ParameterDescriptor(
            description=self.meaning,
            read_only=self.read_only,
            type=int(self.kind.value),
        )
        if self.choices:
            descriptor.additional_constraints = 'one of ' + ', '.join(self.choices)
        elif self.low is not None and self.high is not None:
            if self.kind == Type.INTEGER:
                span = IntegerRange(from_value=int(self.low), to_value=int(self.high))
                descriptor.integer_range = [span]
            else:
                spans = FloatingPointRange(from_value=float(self.low), to_value=float(self.high))
                descriptor.floating_point_range = [spans]
        return descriptor
