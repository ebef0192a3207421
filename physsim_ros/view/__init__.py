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
Rerun: frames become recordings, shown in a window or browser or written to a file.

Not here: topics for RViz and Foxglove (`ros`). Start with `viewer`, then `recording` (entities)
and the folders: `sinks` (threads, queues, windows, files), `meshes` (bodies) and `joints`. Other
folders import the names below; Rerun itself, which takes a second to import, is imported only by
the thread of a worker.
"""

from physsim_ros.view.frame_context import FrameContext
from physsim_ros.view.joints.joint_colors import JointColors
from physsim_ros.view.joints.joint_glyphs import joint_strips, symbol_size
from physsim_ros.view.joints.joint_lines import JointLines, segment_corners
from physsim_ros.view.viewer import Viewer, ViewerMode

__all__ = [
    'FrameContext',
    'JointColors',
    'JointLines',
    'Viewer',
    'ViewerMode',
    'joint_strips',
    'segment_corners',
    'symbol_size',
]
