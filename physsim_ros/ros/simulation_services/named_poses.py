# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Named poses, by the services of `simulation_interfaces`.

A named pose is a place, such as a gate, a zone or a note: an anchored sensor body, which does not
move and lets everything pass.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from physsim_ros.model.errors import UnknownBody
from physsim_ros.model.scene import Body
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.ros.node_control import NodeControl
from physsim_ros.ros.planar import pose_message
from physsim_ros.ros.simulation_services.entities import passes_tags, tags_of
from physsim_ros.ros.simulation_services.results import box_around
from simulation_interfaces.msg import NamedPose


class NamedPoses:
    """
    The services for named poses, which only read.

    :param control: of the node
    """

    def __init__(self, control: NodeControl) -> None:
        self._control = control

    def poses(self, request: Any, response: Any) -> str:
        """Tell the places whose tags pass a filter."""
        snapshot = self._control.loop.bring_up_to_date()
        response.poses = [
            _named_pose(snapshot, row, body)
            for row, body in _places(snapshot)
            if passes_tags(set(tags_of(body)), request.tags)
        ]
        return ''

    def bounds(self, request: Any, response: Any) -> str:
        """Tell the box around a place, in the frame of its pose."""
        snapshot = self._control.loop.bring_up_to_date()
        body = next((body for _, body in _places(snapshot) if body.name == request.name), None)
        if body is None:
            raise UnknownBody('there is no named pose {name!r}', field='name', name=request.name)
        response.bounds = box_around(body.shape)
        return ''


def _places(snapshot: Snapshot) -> Iterator[tuple[int, Body]]:
    """Yield row and body of each place."""
    bodies = enumerate(snapshot.scene.bodies)
    return ((row, body) for row, body in bodies if body.anchored and body.sensor)


def _named_pose(snapshot: Snapshot, row: int, body: Body) -> NamedPose:
    return NamedPose(
        name=body.name,
        description=body.label,
        tags=list(tags_of(body)),
        pose=pose_message(snapshot.poses[row].tolist()),
    )
