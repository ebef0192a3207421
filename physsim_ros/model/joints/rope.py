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

"""A rope: greatest distance between two points, unilateral (Pymunk's SlideJoint)."""

from physsim_ros.model.checks import Within
from physsim_ros.model.joints.schema import JointSchema, Property
from physsim_ros.model.shapes import LARGEST

SCHEMA = JointSchema(
    kind='rope',
    points=2,
    own={'length': Property(check=Within(0.0, LARGEST, 'm'), as_drawn=True)},
)
