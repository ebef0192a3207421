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

"""`~/poses`: geometry_msgs/PoseArray, the pose of every body, in spawn order."""

from __future__ import annotations

from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.ros.encoders.cdr import CdrWriter, fill_columns, MessageTemplate, START
from physsim_ros.ros.encoders.scene_encoder import POSE_COLUMNS, pose_columns, SceneEncoder


class PosesEncoder(SceneEncoder):
    """Encodes the pose of every body: position of its origin [m] and quaternion."""

    def _template_of(self, scene: Scene) -> MessageTemplate:
        writer = CdrWriter(START)
        writer.header(self._frame_id)
        writer.block(len(scene.bodies), 7)
        return MessageTemplate(writer)

    def _fill(self, template: MessageTemplate, snapshot: Snapshot) -> None:
        fill_columns(template.blocks[0], POSE_COLUMNS, pose_columns(snapshot))
