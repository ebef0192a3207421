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
The physics engine: Pymunk's space, and the stages that make a step of it accurate.

The only folder that imports Pymunk; an immutable value or a fresh array is all that crosses its
border. Not here: requests, time and history (`simulation`). Start with `pipeline`, the stages of a
step in their order, then `space` (bodies, joints, walls) and `body_table` (bodies by column).
`stages`, `ccd`, `joints` and `contacts` are the packages of the pipeline.
"""
