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
Contacts: which bodies touched in a frame, where, and with which impulse.

`contact` and `side` are two shapes that touch, as they are read from the engine. `contact_report`
sums them over the steps of a frame, `contact_listing` merges those of several shapes; `pair_ids`,
`manifolds` and `sleeping_pairs` are what both work on. Not here: the contact graph (`islands`),
impulses from which the next step starts (`warm_start`), the effect of contacts on bodies
(`stages`). Start with `contact_report`.
"""
