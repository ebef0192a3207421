# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Settings of the world and of drawing as the values of parameters."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields
from functools import lru_cache
from typing import Any

from physsim_ros.drawing import DrawingSettings
from physsim_ros.model.colors import Color, color_from
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.settings import WorldSettings
from physsim_ros.ros.parameters.table import AUTO, SPECS
from rclpy.parameter import Parameter

_WORLD = {each.name for each in fields(WorldSettings)}
_DRAWING = {each.name for each in fields(DrawingSettings)}


def is_world_setting(name: str) -> bool:
    """Return whether a parameter is a setting of the world."""
    return name in _WORLD


def world_changes(parameters: Iterable[Parameter]) -> dict[str, Any]:
    """Return the settings of the world that parameters change, by name."""
    return {
        parameter.name: _setting(parameter.name, parameter.value)
        for parameter in parameters
        if parameter.name in _WORLD
    }


def world_settings(values: Mapping[str, Any]) -> WorldSettings:
    """
    Return the settings of the world among parameter values.

    :raises PhysSimError: they are refused
    """
    return WorldSettings(**{name: _setting(name, values[name]) for name in _WORLD})


def drawing_settings(values: Mapping[str, Any]) -> DrawingSettings:
    """
    Return the settings of drawing among parameter values.

    :raises PhysSimError: they are refused
    """
    settings = {name: values[name] for name in _DRAWING}
    settings['draw_velocity'] = tuple(values['draw_velocity'])
    settings['draw_color'] = _draw_color(values['draw_color'])
    return DrawingSettings(**settings)


def world_parameters(settings: WorldSettings) -> list[Parameter]:
    """Return the parameters that have the settings of the world as their values."""
    parameters = []
    for name in sorted(_WORLD):
        value = getattr(settings, name)
        if isinstance(value, tuple):
            value = list(value)
        parameters.append(Parameter(name, SPECS[name].kind, [] if value is None else value))
    return parameters


@lru_cache(maxsize=2)
@lru_cache(maxsize=2)
def listed_names(value: str) -> tuple[str, ...]:
    """Return the names of bodies in the value of parameter `sketchpad_locked`."""
    return tuple(name for each in value.split(',') if (name := each.strip()))


def _draw_color(text: str) -> Color | None:
    try:
        return None if text == AUTO else color_from(text)
    except BadProperty as refusal:
        raise BadProperty(f'draw_color: {refusal}, or {AUTO}', field='draw_color') from refusal


def _setting(name: str, value: Any) -> Any:
    if name in {'bounds', 'datum'} and len(value) == 0:
        return None
    return tuple(value) if isinstance(SPECS[name].default, list) else value
