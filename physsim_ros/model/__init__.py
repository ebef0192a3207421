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
Values that all folders use, frozen and checked; numpy is the most that is imported here.

Nothing here moves, reads a clock or knows an engine. Each module is a front of its own, named by
a noun, and so are the packages `shapes`, `joints` and `requests`; this file exports nothing.
Shared by all values: `names`, `colors`, `transform`, `arrays`, `checks`, `errors`.
Descriptions of a world: `shapes`, `body_properties`, `joints`, `settings`, `scene`.
Changes of it: `requests`. States that are shown: `snapshot`, `preview`. States that are saved:
`checkpoint`. Start with `scene` and `requests`.
"""
