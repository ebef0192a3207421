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

"""`/tf`: tf2_msgs/TFMessage, the transform from every body's frame to that of the world."""

from __future__ import annotations

import numpy as np
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.ros.encoders.cdr import CdrWriter, MessageTemplate, START
from physsim_ros.ros.encoders.scene_encoder import POSE_COLUMNS, pose_columns, SceneEncoder

_ZERO = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class TransformsEncoder(SceneEncoder):
    """Encodes the pose of every body as a transform, whose child frame is the body's name."""

    def _template_of(self, scene: Scene) -> MessageTemplate:
        writer = CdrWriter(START)
        writer.ints(len(scene.names))
        stamps, transforms = [], []
        for name in scene.names:
            writer.align(4)
            stamps.append(len(writer.data))
            writer.header(self._frame_id)
            writer.text(name)
            writer.align(8)
            transforms.append(len(writer.data))
            writer.doubles(*_ZERO)
        # Offsets of each column in all transforms, in numbers of 8 bytes.
        self._offsets = np.array(transforms, np.intp) // 8 + np.array(POSE_COLUMNS)[:, None]
        return MessageTemplate(writer, stamps)

    def _fill(self, template: MessageTemplate, snapshot: Snapshot) -> None:
        for offsets, values in zip(self._offsets, pose_columns(snapshot), strict=True):
            template.doubles[offsets] = values
