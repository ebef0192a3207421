# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`~/states`: sensor_msgs/MultiDOFJointState, name, pose and twist of every body."""

from __future__ import annotations

from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.ros.encoders.cdr import (
    CdrWriter,
    fill_columns,
    MessageTemplate,
    padded_string,
    START,
)
from physsim_ros.ros.encoders.scene_encoder import SceneEncoder

# Doubles of a planar twist that are not always 0: vx, vy and the angular velocity.
_TWIST_COLUMNS = (0, 1, 5)


class StatesEncoder(SceneEncoder):
    """Encodes name, pose and twist [m/s, rad/s] of every body."""

    def _template_of(self, scene: Scene) -> MessageTemplate:
        names = [padded_string(name) for name in scene.names]
        return multi_dof_template(self._frame_id, names, twists=len(names))

    def _fill(self, template: MessageTemplate, snapshot: Snapshot) -> None:
        super()._fill(template, snapshot)
        fill_columns(template.blocks[0], _TWIST_COLUMNS, snapshot.twists.T)


def multi_dof_template(
    frame_id: str, names: list[bytes], *, twists: int = 0, wrenches: int = 0
) -> MessageTemplate:
    """
    Return a sensor_msgs/MultiDOFJointState; its blocks are twists and wrenches.

    :param frame_id: name of the world frame
    :param names: of the entries, serialised with padding
    :param twists: number of twists
    :param wrenches: number of wrenches
    """
    writer = CdrWriter(START)
    writer.header(frame_id)
    writer.ints(len(names))
    writer.data += b''.join(names)
    writer.ints(len(names))
    writer.pose(len(names))
    writer.block(twists, 6)
    writer.block(wrenches, 6)
    return MessageTemplate(writer)
