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
A world: requests go in, steps are made, snapshots come out; it knows the present alone.

Not here: when a request comes, and what was before (`past`). Start with `world`, then
`body_requests`, `joint_requests` and `hand_requests`. Other folders import the names below.
"""

from physsim_ros.simulation.world.world import steps_in, World

__all__ = ['World', 'steps_in']
