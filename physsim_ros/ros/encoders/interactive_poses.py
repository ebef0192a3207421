# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`~/drag/update`: visualization_msgs/InteractiveMarkerUpdate with the poses of all bodies."""

from __future__ import annotations

import numpy as np
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.ros.encoders.cdr import CdrWriter, MessageTemplate, START
from physsim_ros.ros.encoders.scene_encoder import SceneEncoder

# The type UPDATE, and no markers.
_UPDATE, _NO_MARKERS = b'\1', 0


class InteractivePosesEncoder(SceneEncoder):
    """
    Encodes the poses of all bodies as those of interactive markers.

    :param frame_id: name of the world frame
    :param server: that the update names

    :ivar number: of the next update
    """

    def __init__(self, frame_id: str, server: str) -> None:
        super().__init__(frame_id)
        self.number = 0
        self._server = server

    def _template_of(self, scene: Scene) -> MessageTemplate:
        writer = CdrWriter(START)
        writer.text(self._server)
        writer.align(8)
        self._number_at = len(writer.data) // 8
        writer.doubles(0.0)
        writer.data += _UPDATE
        writer.ints(_NO_MARKERS, len(scene.names))
        for name in scene.names:
            writer.header(self._frame_id)
            writer.pose()
            writer.text(name)
        # No names of bodies that are gone.
        writer.ints(0)
        return MessageTemplate(writer)

    def _fill(self, template: MessageTemplate, snapshot: Snapshot) -> None:
        super()._fill(template, snapshot)
        template.doubles.view(np.int64)[self._number_at] = self.number
