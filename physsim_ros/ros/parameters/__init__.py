# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The ROS parameters: their table, their declaration and check, the settings that they make.

Not here: what follows when one is set (`ros.node`). A new parameter is a row of `table`; one that
is a setting of the world or of drawing has its default and range from there (`model.settings`,
`drawing.settings`), and only its meaning here. Start with `table`.
"""

from physsim_ros.ros.parameters.declaration import check, check_names, declare, set_value
from physsim_ros.ros.parameters.settings import (
    drawing_settings,
    is_world_setting,
    listed_names,
    world_changes,
    world_parameters,
    world_settings,
)
from physsim_ros.ros.parameters.table import Spec, SPECS

__all__ = [
    'SPECS',
    'Spec',
    'check',
    'check_names',
    'declare',
    'drawing_settings',
    'is_world_setting',
    'listed_names',
    'set_value',
    'world_changes',
    'world_parameters',
    'world_settings',
]
