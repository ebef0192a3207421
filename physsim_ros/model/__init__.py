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
Values that the whole project speaks in: shapes, bodies, joints, requests, snapshots, refusals.

Nothing here moves, reads a clock or knows an engine; numpy is the most that is imported. Start
with `scene` (bodies and joints), `requests` (all that can be asked) and `snapshot` (all that is
seen).
"""
