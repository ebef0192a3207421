# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`~/poses`: geometry_msgs/PoseArray, the pose of every body, in spawn order."""

from __future__ import annotations

from physsim_ros.model.scene import Scene
from physsim_ros.ros.encoders.cdr import CdrWriter, MessageTemplate, START
from physsim_ros.ros.encoders.scene_encoder import SceneEncoder


class PosesEncoder(SceneEncoder):
    """Encodes the pose of every body: position of its origin [m] and quaternion."""

    def _template_of(self, scene: Scene) -> MessageTemplate:
        writer = CdrWriter(START)
        writer.header(self._frame_id)
        writer.ints(len(scene.bodies))
        writer.pose(len(scene.bodies))
        return MessageTemplate(writer)
