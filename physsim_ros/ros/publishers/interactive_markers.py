# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`~/drag/update` and `~/drag/get_interactive_markers`: bodies as interactive markers, for RViz.

The protocol is that of the package interactive_markers in ROS 2: the service tells all markers
with a number, and each update after it has the next number, and what has changed. What RViz sends
while it drags comes on `~/drag/feedback`, and moves a hand.

Law: while nobody has asked, or nobody listens, nothing is encoded.
"""

from __future__ import annotations

import math

from geometry_msgs.msg import Point, Quaternion
import numpy as np
from physsim_ros.model.scene import Body, Scene
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.ros.encoders.cdr import CdrWriter, MessageTemplate, START
from physsim_ros.ros.encoders.streams import SceneEncoder
from physsim_ros.ros.marker_shapes import geometry_of, THIN
from physsim_ros.ros.planar import pose_message
from physsim_ros.ros.qos_safe_node import CALLS
from rclpy.node import Node
from rclpy.time import Time
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import (
    InteractiveMarker,
    InteractiveMarkerControl,
    InteractiveMarkerUpdate,
    Marker,
)
from visualization_msgs.srv import GetInteractiveMarkers

# Frames between updates of poses: RViz draws each anew.
FRAMES = 6
# The depth that the server of interactive_markers has.
_DEPTH = 100
# Height above the bodies of `~/markers`, so that a click finds these [m].
_RAISED = 3 * THIN
# Turns the x axis of a control, its normal, to z.
_FLAT = Quaternion(y=math.sqrt(0.5), w=math.sqrt(0.5))


class InteractiveMarkers:
    """
    Publishes bodies as interactive markers, which are dragged in the plane.

    :param node: that owns topic and service
    :param frame_id: name of the world frame

    :ivar name: of the topic
    """

    name = '~/drag/update'

    def __init__(self, node: Node, frame_id: str) -> None:
        self._frame_id = frame_id
        self._server = node.get_fully_qualified_name()
        self._publisher = node.create_publisher(InteractiveMarkerUpdate, self.name, _DEPTH)
        service = '~/drag/get_interactive_markers'
        node.create_service(GetInteractiveMarkers, service, self._tell, qos_profile=CALLS)
        self._poses = InteractivePosesEncoder(frame_id, self._server)
        self._frame: Frame | None = None
        self._number = 0
        # The frame of the update of that number; None before somebody has asked.
        self._told: Frame | None = None
        self._wait = 0

    @property
    def is_read(self) -> bool:
        """Whether somebody has asked, and listens."""
        return self._told is not None and self._publisher.get_subscription_count() > 0

    def show(self, frame: Frame) -> None:
        """Publish what has changed, if somebody listens; of running time, not every pose."""
        self._frame = frame
        told = self._told
        if told is None or not self.is_read:
            return
        self._wait -= 1
        same = told.snapshot.scene is frame.snapshot.scene
        if same and frame.passing and self._wait > 0:
            return
        self._wait = FRAMES
        self._update(told.snapshot, frame)

    def _update(self, told: Snapshot, frame: Frame) -> None:
        """Publish the differences of a frame from what was told."""
        snapshot = frame.snapshot
        if told.scene is not snapshot.scene:
            self._publish_changes(told, snapshot)
        elif np.array_equal(told.poses, snapshot.poses):
            return
        self._number += 1
        self._poses.number = self._number
        self._publisher.publish(self._poses.encode(frame))
        self._told = frame

    def _publish_changes(self, told: Snapshot, snapshot: Snapshot) -> None:
        """Publish the bodies that are new or others, and the names of those that are gone."""
        before = {body.name: body for body in told.scene.bodies}
        markers = [
            self._marker(snapshot, row)
            for row, body in enumerate(snapshot.scene.bodies)
            if before.get(body.name) is not body
        ]
        erases = list(before.keys() - set(snapshot.scene.names))
        self._number += 1
        self._publisher.publish(
            InteractiveMarkerUpdate(
                server_id=self._server,
                seq_num=self._number,
                type=InteractiveMarkerUpdate.UPDATE,
                markers=markers,
                erases=sorted(erases),
            )
        )

    def _tell(
        self,
        _: GetInteractiveMarkers.Request,
        response: GetInteractiveMarkers.Response,
    ) -> GetInteractiveMarkers.Response:
        """Tell all markers, as others have them now."""
        frame = self._frame
        if frame is not None:
            if self._told is not None:
                self._update(self._told.snapshot, frame)
            self._told = frame
            rows = range(len(frame.snapshot.scene.bodies))
            response.markers = [self._marker(frame.snapshot, row) for row in rows]
        response.sequence_number = self._number
        return response

    def _marker(self, snapshot: Snapshot, row: int) -> InteractiveMarker:
        """Return a body as a marker that is dragged in the plane, where it is clicked."""
        body = snapshot.scene.bodies[row]
        stamp = Time(nanoseconds=snapshot.stamp).to_msg()
        return InteractiveMarker(
            header=Header(frame_id=self._frame_id, stamp=stamp),
            pose=pose_message(snapshot.poses[row].tolist()),
            name=body.name,
            scale=1.0,
            controls=[_control(body)],
        )


def _control(body: Body) -> InteractiveMarkerControl:
    """Return the control of a marker: the shape of the body, which is dragged."""
    kind, scale, points = geometry_of(body.shape)
    red, green, blue, alpha = body.color
    drawn = Marker(type=kind, color=ColorRGBA(r=red, g=green, b=blue, a=alpha))
    drawn.scale.x, drawn.scale.y, drawn.scale.z = scale
    drawn.pose.position.z = _RAISED
    drawn.points = [Point(x=x, y=y) for x, y in points]
    return InteractiveMarkerControl(
        name='drag',
        orientation=_FLAT,
        orientation_mode=InteractiveMarkerControl.FIXED,
        interaction_mode=InteractiveMarkerControl.MOVE_PLANE,
        always_visible=True,
        markers=[drawn],
    )


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
