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
The sketchpad: a page in the browser that shows the world and draws in it.

Not here: ROS (`ros` adapts its node to `WorldControl`), the reading of strokes (`drawing`). The
server runs on a thread of its own. Start with `sketchpad`, then `server` and `page_session`;
`messages`, `frame_codec` and `scene_codec` are the wire, `page/` is what a browser runs. Other
folders import the names below.
"""

from physsim_ros.sketchpad.access import Role
from physsim_ros.sketchpad.sketchpad import Sketchpad
from physsim_ros.sketchpad.world_control import WorldControl

__all__ = ['Role', 'Sketchpad', 'WorldControl']
