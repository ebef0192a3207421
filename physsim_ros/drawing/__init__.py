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
Drawing: the clicks and freehand strokes of a person become requests.

Not here: ROS messages and parameters (`ros`), drawing files (`files`), the execution of requests
(`simulation`). Start with `session`; `clicks` has the tools, `strokes` the recognition. Other
folders import the names below.
"""

from physsim_ros.drawing.clicks.tools import Tool
from physsim_ros.drawing.session import DrawingSession, submit_reading
from physsim_ros.drawing.settings import DRAWING_RANGES, DrawingSettings
from physsim_ros.drawing.strokes.interpretation import Reading

__all__ = [
    'DRAWING_RANGES',
    'DrawingSession',
    'DrawingSettings',
    'Reading',
    'Tool',
    'submit_reading',
]
