# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The declaration of the parameters on a node, and the check of their values.

Law: a value outside its range is refused with a reason and changes nothing.
"""

from __future__ import annotations

from collections.abc import Iterable
import math
from typing import Any

from physsim_ros.model.checks import shown
from physsim_ros.model.errors import BadProperty, Malformed, UnknownProperty
from physsim_ros.model.texts import nearest_name
from physsim_ros.ros.parameters.settings import drawing_settings, world_settings
from physsim_ros.ros.parameters.table import Spec, SPECS, Type
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node
from rclpy.parameter import Parameter


def declare(node: Node) -> dict[str, Any]:
    """
    Declare every parameter on a node and return their values.

    :raises PhysSimError: an initial value is out of range
    """
    values = {}
    for name, spec in SPECS.items():
        default = Parameter(name, spec.kind, spec.default).value
        # Declared without type and range: rclpy would refuse initial values without a code.
        node.declare_parameter(name, default, ParameterDescriptor(dynamic_typing=True))
        given = node.get_parameter(name)
        if given.type_ == Type.NOT_SET:
            # rcl passes an empty list of the command line, or of a file, as NOT_SET.
            given = Parameter(name, Type.BYTE_ARRAY, [])
        parameter = _converted(given)
        check(parameter)
        node.set_parameters([parameter])
        node.set_descriptor(name, spec.descriptor)
        values[name] = _plain(parameter.value, spec)
    world_settings(values)
    drawing_settings(values)
    node.add_pre_set_parameters_callback(_all_converted)
    return values


def check_names(given: Iterable[str], node: Node) -> None:
    """
    Refuse values for parameters that a node has not declared, which rclpy ignores.

    :param given: names of the parameters that the command line, a file or the constructor sets
    :raises UnknownProperty: one is not declared; the most similar parameter is named
    """
    for name in given:
        if not node.has_parameter(name):
            nearest = nearest_name(name, SPECS)
            raise UnknownProperty(f'there is no parameter {shown(name)}{nearest}', field=name)


def check(parameter: Parameter) -> None:
    """
    Check type and range of a parameter.

    :raises BadProperty: the type is wrong, or the value is out of range
    :raises Malformed: a number is not finite
    """
    spec = SPECS.get(parameter.name)
    if spec is None:
        return
    name, value = parameter.name, parameter.value
    if parameter.type_ != spec.kind:
        raise BadProperty(
            f'{name} must be of type {spec.kind.name.lower()}, not {parameter.type_.name.lower()}',
            field=name,
        )
    numbers = value if isinstance(value, list) else [value]
    if any(isinstance(each, float) and not math.isfinite(each) for each in numbers):
        raise Malformed(f'{name} is not finite', field=name)
    if spec.low is not None and spec.high is not None and not spec.low <= value <= spec.high:
        raise BadProperty(
            f'{name} is {value:g}; it must lie between {spec.low:g} and {spec.high:g}', field=name
        )
    if spec.choices and value not in spec.choices:
        raise BadProperty(f'{name} must be one of {", ".join(spec.choices)}', field=name)


def set_value(node: Node, name: str, value: str | float) -> None:
    """
    Set a parameter of a node.

    :raises Refusal: the value is refused; nothing has changed
    """
    parameter = Parameter(name, value=value)
    # Here as well: a refusal by rclpy has no code.
    check(parameter)
    (result,) = node.set_parameters([parameter])
    if not result.successful:
        raise BadProperty(result.reason, field=name)


def _all_converted(parameters: Iterable[Parameter]) -> list[Parameter]:
    return [_converted(parameter) for parameter in parameters]


def _converted(parameter: Parameter) -> Parameter:
    """Return a parameter with an integer or an empty list converted to the declared type."""
    spec = SPECS.get(parameter.name)
    if spec is None:
        return parameter
    value = parameter.value
    if spec.kind == Type.DOUBLE and parameter.type_ == Type.INTEGER:
        return Parameter(parameter.name, Type.DOUBLE, float(value))
    # An empty list has no type: rclpy sends it as bytes, ros2cli as booleans.
    empty = parameter.type_.name.endswith('_ARRAY') and len(value) == 0
    numbers = parameter.type_ in (Type.DOUBLE_ARRAY, Type.INTEGER_ARRAY)
    if spec.kind == Type.DOUBLE_ARRAY and (empty or numbers):
        # A message holds an array.array; the value is always a list.
        return Parameter(parameter.name, Type.DOUBLE_ARRAY, [float(each) for each in value])
    return parameter


def _plain(value: Any, spec: Spec) -> Any:
    return list(value) if isinstance(spec.default, list) else value
