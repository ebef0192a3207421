# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
The ROS parameters: their table, their declaration and check, the settings that they make.

Not here: what follows when one is set (`ros.node`). A new parameter is a row of `table`; one that
is a setting of the world or of drawing has its default and range from there (`model.settings`,
`drawing.settings`), and only its meaning here. Start with `table`.
"""

from physsim_ros.ros.parameters.declaration import check, declare
from physsim_ros.ros.parameters.settings import (
    drawing_settings,
    is_world_setting,
    traced_names,
    world_changes,
    world_parameters,
    world_settings,
)
from physsim_ros.ros.parameters.spec import Spec
from physsim_ros.ros.parameters.table import SPECS

__all__ = [
    'SPECS',
    'Spec',
    'check',
    'declare',
    'drawing_settings',
    'is_world_setting',
    'traced_names',
    'world_changes',
    'world_parameters',
    'world_settings',
]
