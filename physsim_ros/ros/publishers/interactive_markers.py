# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`~/drag/update` and `~/drag/get_interactive_markers`: bodies as interactive markers, for RViz.

The protocol is that of the package interactive_markers in ROS 2: the service tells markers with a
number, and each update after it has the next number, and what has changed. What RViz sends while
it drags comes on `~/drag/feedback`, and moves a hand.

Laws: while nobody has asked, or nobody listens, nothing is encoded. No answer and no update makes
more than `MOST_NEW` markers; the others follow by updates, and poses after the last of them.
"""

from __future__ import annotations

from itertools import islice
import math

from geometry_msgs.msg import Point, Quaternion
import numpy as np
from physsim_ros.model.scene import Body
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.model.timeline import frames_in
from physsim_ros.ros.encoders.streams import InteractivePosesEncoder
from physsim_ros.ros.marker_shapes import geometry_of, THIN
from physsim_ros.ros.planar import pose_message
from physsim_ros.ros.topics import CALLS
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

# Time between updates of poses at speed 1 [s]: RViz draws each anew.
PERIOD = 0.1
# Greatest number of markers in an answer or an update, 0.1 ms each.
MOST_NEW = 200
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
    :param publish_rate: frames a second at speed 1 [Hz]

    :ivar name: of the topic
    """

    name = '~/drag/update'

    def __init__(self, node: Node, frame_id: str, publish_rate: float) -> None:
        self._frame_id = frame_id
        self._frames = frames_in(PERIOD, publish_rate)
        self._server = node.get_fully_qualified_name()
        self._publisher = node.create_publisher(InteractiveMarkerUpdate, self.name, _DEPTH)
        service = '~/drag/get_interactive_markers'
        node.create_service(GetInteractiveMarkers, service, self._tell, qos_profile=CALLS)
        self._poses = InteractivePosesEncoder(frame_id, self._server)
        self._frame: Frame | None = None
        self._number = 0
        # The snapshot of the update of that number; None before somebody has asked.
        self._told: Snapshot | None = None
        # Bodies by the names that are told; None for one that the last who asked is not told yet.
        self._known: dict[str, Body | None] = {}
        # Whether markers are left for the next update.
        self._is_late = False
        # Frames until the next update of poses.
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
        same = told.scene is frame.snapshot.scene and not self._is_late
        if same and frame.passing and self._wait > 0:
            return
        self._wait = self._frames
        self._update(frame)

    def show_late(self, frame: Frame) -> None:
        """Go on with the markers that are left of the last frame."""
        if self._is_late and self.is_read:
            self._update(frame)

    def _update(self, frame: Frame) -> None:
        """Publish some of the differences of a frame from what was told."""
        snapshot, told = frame.snapshot, self._told
        self._told = snapshot
        if told is None or told.scene is not snapshot.scene or self._is_late:
            self._publish_changes(snapshot)
        elif np.array_equal(told.poses, snapshot.poses):
            return
        if not self._is_late:
            self._number += 1
            self._poses.number = self._number
            self._publisher.publish(self._poses.encode(frame))

    def _publish_changes(self, snapshot: Snapshot) -> None:
        """Publish some of the bodies that are new or others, and the names of those gone."""
        rows = self._take_new(snapshot)
        erases = sorted(self._known.keys() - snapshot.scene.row_of.keys())
        for name in erases:
            del self._known[name]
        self._number += 1
        self._publisher.publish(
            InteractiveMarkerUpdate(
                server_id=self._server,
                seq_num=self._number,
                type=InteractiveMarkerUpdate.UPDATE,
                markers=[self._marker(snapshot, row) for row in rows],
                erases=erases,
            )
        )

    def _take_new(self, snapshot: Snapshot) -> list[int]:
        """Return the rows of some bodies that are new or others, which are known from now on."""
        bodies = snapshot.scene.bodies
        new = (row for row, body in enumerate(bodies) if self._known.get(body.name) is not body)
        rows = list(islice(new, MOST_NEW))
        self._is_late = next(new, None) is not None
        self._known |= {bodies[row].name: bodies[row] for row in rows}
        return rows

    def _tell(
        self, _: GetInteractiveMarkers.Request, response: GetInteractiveMarkers.Response
    ) -> GetInteractiveMarkers.Response:
        """Tell markers, as others have them now; updates repeat the others for all."""
        if self._frame is not None:
            snapshot = self._frame.snapshot
            if self._told is None:
                self._told = snapshot
                self._take_new(snapshot)
            else:
                self._update(self._frame)
            bodies = enumerate(snapshot.scene.bodies)
            known = [row for row, body in bodies if self._known.get(body.name) is body]
            rows = known[:MOST_NEW]
            response.markers = [self._marker(snapshot, row) for row in rows]
            told = {snapshot.scene.names[row] for row in rows}
            self._known = {
                name: body if name in told else None for name, body in self._known.items()
            }
            self._is_late |= len(rows) < len(known)
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
