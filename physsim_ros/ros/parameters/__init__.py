# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The ROS parameters: their table, their declaration and check, the settings that they make.

Not here: what follows when one is set (`ros.live_parameters`). A new parameter is a field of
`NodeSettings` in `table`, or of the settings of the world or of drawing (`model.settings`,
`drawing.settings`). Start with `table`.
"""

from physsim_ros.ros.parameters.table import NodeSettings, Spec, SPECS
from physsim_ros.ros.parameters.values import (
    check,
    check_names,
    converted,
    declare,
    drawing_settings,
    listed_names,
    no_parameter,
    world_changes,
    world_parameters,
    world_settings,
)

__all__ = [
    'SPECS',
    'NodeSettings',
    'Spec',
    'check',
    'check_names',
    'converted',
    'declare',
    'drawing_settings',
    'listed_names',
    'no_parameter',
    'world_changes',
    'world_parameters',
    'world_settings',
]
