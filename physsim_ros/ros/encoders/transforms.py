# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`/tf`: tf2_msgs/TFMessage, the transform from every body's frame to that of the world."""

from __future__ import annotations

from physsim_ros.model.scene import Scene
from physsim_ros.ros.encoders.cdr import CdrWriter, MessageTemplate, START
from physsim_ros.ros.encoders.scene_encoder import SceneEncoder


class TransformsEncoder(SceneEncoder):
    """Encodes the pose of every body as a transform, whose child frame is the body's name."""

    def _template_of(self, scene: Scene) -> MessageTemplate:
        writer = CdrWriter(START)
        writer.ints(len(scene.names))
        for name in scene.names:
            writer.header(self._frame_id)
            writer.text(name)
            writer.pose()
        return MessageTemplate(writer)
