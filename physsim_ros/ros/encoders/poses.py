# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

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
