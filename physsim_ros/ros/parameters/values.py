# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Values of parameters: declared on a node, checked, and made into settings.

Law: a value outside its range is refused with a reason and changes nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any

from physsim_ros.drawing import DrawingSettings
from physsim_ros.files import load_mapping
from physsim_ros.model.checks import shown
from physsim_ros.model.colors import Color, color_from
from physsim_ros.model.errors import BadProperty, PhysSimError, UnknownProperty
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.spelling import canonical
from physsim_ros.model.texts import nearest_name
from physsim_ros.ros.parameters.table import AUTO, FOR_NONE, NodeSettings, SPECS, Type
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
        parameter = converted(given)
        check(parameter)
        if parameter is not given:
            node.set_parameters([parameter])
        node.set_descriptor(name, spec.descriptor)
        values[name] = list(parameter.value) if isinstance(spec.default, list) else parameter.value
    world_settings(values)
    drawing_settings(values)
    node.add_pre_set_parameters_callback(lambda given: [converted(each) for each in given])
    return values


def check_names(given: Iterable[str], node: Node, arguments: Sequence[str]) -> None:
    """
    Refuse values for parameters that a node has not declared, which rclpy ignores.

    Those that a file sets for all nodes may be another node's: the log has them.

    :param given: names of the parameters that the command line, a file or the constructor sets
    :param arguments: of the command line
    :raises UnknownProperty: one is not declared; the most similar parameter is named
    """
    unknown = {name: nearest_name(name, SPECS) for name in given if not node.has_parameter(name)}
    for_all = set(_names_for_all_nodes(arguments)) if unknown else set()
    for name, nearest in unknown.items():
        refusal = no_parameter(name, nearest)
        if name not in for_all:
            raise refusal
        if nearest:
            node.get_logger().warning(f'{refusal} (in a file, for all nodes)')
    if others := [shown(name) for name, nearest in unknown.items() if not nearest]:
        node.get_logger().info(f'ignored parameters for all nodes: {", ".join(others)}')


def no_parameter(name: str, nearest: str) -> UnknownProperty:
    """Return the refusal of the name of no parameter, with its `nearest_name`."""
    template = 'there is no parameter {value}{near}'
    return UnknownProperty(template, field=name, value=shown(name), near=nearest)


def _names_for_all_nodes(arguments: Sequence[str]) -> Iterator[str]:
    """Yield the names of the parameters that files of the command line set for all nodes."""
    for option, path in pairwise(arguments):
        if option == '--params-file':
            # rcl has read the file already, and takes other YAML than `load_mapping` does.
            with suppress(OSError, PhysSimError):
                entries = load_mapping(Path(path).read_text(encoding='utf-8'), field=path)
                yield from _flattened(entries.get('/**', {}).get('ros__parameters', {}))


def _flattened(entries: Mapping[str, Any], before: str = '') -> Iterator[str]:
    """Yield the names of nested parameters, joined by dots as ROS does."""
    for name, value in entries.items():
        if isinstance(value, Mapping):
            yield from _flattened(value, f'{before}{name}.')
        else:
            yield f'{before}{name}'


def check(parameter: Parameter) -> None:
    """
    Check type and range of a parameter; the range of a setting is checked with the settings.

    :raises BadProperty: the type is wrong, or the value is out of range
    :raises Malformed: a number is not finite
    """
    spec = SPECS.get(parameter.name)
    if spec is None:
        return
    name, value = parameter.name, parameter.value
    if parameter.type_ != spec.kind:
        kind, found = spec.kind.name.lower(), parameter.type_.name.lower()
        template = '{field} must be of type {kind}, not {found}'
        raise BadProperty(template, field=name, kind=kind, found=found)
    if name in NodeSettings.FIELDS and spec.declaration.check is not None:
        spec.declaration.check(value, name)


def converted(parameter: Parameter) -> Parameter:
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


def world_changes(parameters: Iterable[Parameter]) -> dict[str, Any]:
    """Return the settings of the world that parameters change, by name."""
    return {
        parameter.name: _setting(parameter.name, parameter.value)
        for parameter in parameters
        if parameter.name in WorldSettings.FIELDS
    }


def world_settings(values: Mapping[str, Any]) -> WorldSettings:
    """
    Return the settings of the world among parameter values.

    :raises PhysSimError: they are refused
    """
    return WorldSettings(**{name: _setting(name, values[name]) for name in WorldSettings.FIELDS})


def drawing_settings(values: Mapping[str, Any]) -> DrawingSettings:
    """
    Return the settings of drawing among parameter values.

    :raises PhysSimError: they are refused
    """
    settings = {name: values[name] for name in DrawingSettings.FIELDS}
    settings['draw_velocity'] = tuple(values['draw_velocity'])
    settings['draw_color'] = _draw_color(values['draw_color'])
    return DrawingSettings(**settings)


def world_parameters(settings: WorldSettings) -> list[Parameter]:
    """Return the parameters that have the settings of the world as their values."""
    parameters = []
    for name in sorted(WorldSettings.FIELDS):
        value = getattr(settings, name)
        if isinstance(value, tuple):
            value = list(value)
        elif value is None:
            value = FOR_NONE[name]
        parameters.append(Parameter(name, SPECS[name].kind, value))
    return parameters


@lru_cache(maxsize=2)
def listed_names(value: str) -> tuple[str, ...]:
    """Return the names of bodies in the value of parameter `sketchpad_locked`."""
    return tuple(name for each in canonical(value).split(',') if (name := each.strip()))


def _draw_color(text: str) -> Color | None:
    try:
        return None if text == AUTO else color_from(text)
    except BadProperty as refusal:
        raise BadProperty(
            'draw_color: {refusal}, or {word}',
            field='draw_color',
            refusal=refusal.text,
            word=AUTO,
        ) from refusal


def _setting(name: str, value: Any) -> Any:
    value = list(value) if isinstance(SPECS[name].default, list) else value
    if name in FOR_NONE and value == FOR_NONE[name]:
        return None
    return tuple(value) if isinstance(value, list) else value
