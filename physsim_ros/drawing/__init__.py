# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Drawing: the clicks and freehand strokes of a person become requests.

Not here: ROS messages and parameters (`ros`), drawing files (`files`), the execution of requests
(`simulation`). Start with `session`; `tools` has the tools of clicks, `strokes` the recognition.
Other folders import the names below.
"""

from physsim_ros.drawing.click import Tool
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.session import Check, DrawingSession
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.stages import Reading
from physsim_ros.drawing.submission import submit_reading, submit_told

__all__ = [
    'Check',
    'DrawingSession',
    'DrawingSettings',
    'Reading',
    'SceneQuery',
    'Tool',
    'submit_reading',
    'submit_told',
]
