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

"""A motor: an axle that drives the relative angular velocity by a bounded torque."""

from physsim_ros.model.checks import FASTEST, HEAVIEST, Within
from physsim_ros.model.joints.schema import JointSchema, Property

SCHEMA = JointSchema(
    kind='motor',
    points=1,
    own={
        # Of a relative to b, counter-clockwise.
        'rate': Property(check=Within(-FASTEST, FASTEST, 'rad/s'), default=1.0),
        'max_torque': Property(check=Within(0.0, HEAVIEST, 'N m'), default=1000.0),
    },
)
