# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

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
