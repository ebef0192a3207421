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
Kinds of joints and their properties, one file a kind: points, properties, units, defaults, ranges.

Constraints, Jacobian rows and limits of each kind are in `engine.joints`, glyphs in `view`. Start
with `schema`, then `axle`. A new kind is a file here and a member of `kinds.JointKind`; a property
that no kind has yet is a field of `properties.JointProperties` too.
"""

from physsim_ros.model.joints.kinds import JointKind, kind_from, PROPERTIES
from physsim_ros.model.joints.properties import (
    JOINT_KEYS,
    joint_properties_from,
    JointProperties,
)

__all__ = [
    'JOINT_KEYS',
    'PROPERTIES',
    'JointKind',
    'JointProperties',
    'joint_properties_from',
    'kind_from',
]
