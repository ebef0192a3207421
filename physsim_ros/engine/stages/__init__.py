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
Stages of a step, one file each: a problem, the method by its name, its source and its cost.

Not here: the order of stages (`pipeline`), joints (`joints`), continuous collision (`ccd`) and the
contact report (`contacts`). A stage reads the step context and no privates of another. Start with
`half_step`, then `contact_projection`; a new stage is a file here and a line in `pipeline`.
"""
