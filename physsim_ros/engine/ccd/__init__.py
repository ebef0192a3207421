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
Continuous collision: fast bodies do not pass through others within a step.

Broad phase of swept boxes, time of impact by conservative advancement, and plastic impacts of the
moves, which leave velocities alone. Not here: contacts, which the engine resolves where the step
ends. Start with `continuous`, then `broad_phase`, `hulls` and `time_of_impact`.
"""
