# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`~/markers`: visualization_msgs/MarkerArray, all bodies, joints, walls and hands.

A body is drawn with the marker that would spawn it, its material in `text`. A marker that is no
longer drawn is deleted by each message for `DELETION`. If thousands are new or gone, `MOST_NEW`
are serialised for each frame, and the message comes after the last, even if the scene has changed
meanwhile.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import chain, islice
import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.appearance import JointGlyphs, segment_corners
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Body, Joint, Scene
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.model.timeline import frames_in
from physsim_ros.model.transform import rotated_each
from physsim_ros.ros.encoders.bare_markers import (
    BareMarker,
    body_markers,
    hands_marker,
    joint_markers,
    Key,
    wall_marker,
)
from physsim_ros.ros.encoders.cdr import MessageTemplate
from physsim_ros.ros.encoders.marker_bytes import (
    COLOR_OFFSET,
    joined,
    MarkerBytes,
    POINTS_OFFSET,
    serialised,
)
from physsim_ros.ros.encoders.streams import pose_columns
from physsim_ros.runtime.garbage_collection import suspended_collection
from visualization_msgs.msg import Marker

# Time in which each message deletes a marker that is gone [s]. The depth of the stream is 1, so
# that a slow subscriber misses some messages; of those of a second it gets at least one.
DELETION = 1.0
# Greatest number of bodies, joints and deletions that are serialised for a frame, 50 µs each.
MOST_NEW = 500


class MarkersEncoder:
    """
    Encodes the markers of a frame.

    :param frame_id: name of the world frame
    :param publish_rate: frames a second at speed 1 [Hz]
    """

    def __init__(self, frame_id: str, publish_rate: float) -> None:
        self._frame_id = frame_id
        self._message: _Message | None = None
        # The last snapshot of the scene whose markers are being serialised.
        self._begun: Snapshot | None = None
        self._bodies: dict[str, tuple[Body, tuple[MarkerBytes, ...]]] = {}
        self._joints: dict[
            str, tuple[tuple[Joint, float, int], tuple[MarkerBytes, MarkerBytes]]
        ] = {}
        self._glyphs: JointGlyphs | None = None
        self._deletions = _Deletions(frame_id, frames_in(DELETION, publish_rate))

    def encode(self, frame: Frame) -> bytes | None:
        """
        Return the serialised message of a frame, or of one whose markers are complete only now.

        :return: None if markers are left to be serialised
        """
        snapshot = frame.snapshot
        if self._begun is not None and self._begun.scene is not snapshot.scene:
            snapshot = self._begun
        scene, hands = snapshot.scene, len(snapshot.grips)
        message = self._message
        if message is None or not message.is_of(scene, hands) or self._deletions.have_ended:
            self._begun = snapshot
            if not self._serialise_some(scene):
                return None
            self._begun = None
            message = self._message = self._new_message(scene, hands)
        self._deletions.messages += 1
        return message.filled(snapshot)

    @suspended_collection()
    def _serialise_some(self, scene: Scene) -> bool:
        """Serialise some of what is new in a scene; return whether none is left."""
        new = chain(
            self._serialise_bodies(scene), self._serialise_joints(scene), self._delete(scene)
        )
        # `islice` makes the first `MOST_NEW`, and `any` one more, if there is one.
        return not any(True for _ in islice(new, MOST_NEW, None))

    def _serialise_bodies(self, scene: Scene) -> Iterator[None]:
        """Serialise the markers of new bodies; yield after each."""
        for body in scene.bodies:
            known = self._bodies.get(body.name)
            if known is None or (known[0] is not body and known[0] != body):
                bare = body_markers(body)
                markers = tuple(serialised(each, self._frame_id) for each in bare)
                self._bodies[body.name] = body, markers
                yield

    def _serialise_joints(self, scene: Scene) -> Iterator[None]:
        """Serialise the markers of new joints, or of another look; yield after each."""
        if not scene.joints:
            self._glyphs = None
            return
        if self._glyphs is None or self._glyphs.scene is not scene:
            self._glyphs = JointGlyphs(scene)
        counts = self._glyphs.segment_ends.tolist()
        for joint, *look in zip(scene.joints, self._glyphs.sizes, counts, strict=True):
            drawn = self._joints.get(joint.name)
            if drawn is None or drawn[0] != (joint, *look):
                points, lines = joint_markers(joint, *look)
                pair = serialised(points, self._frame_id), serialised(lines, self._frame_id)
                self._joints[joint.name] = (joint, *look), pair
                yield

    def _delete(self, scene: Scene) -> Iterator[None]:
        """Serialise deletions of markers that no body or joint has any more; yield after each."""
        bodies = (marker for body in scene.bodies for marker in self._bodies[body.name][1])
        joints = (marker for joint in scene.joints for marker in self._joints[joint.name][1])
        yield from self._deletions.serialise({marker.key for marker in chain(bodies, joints)})

    def _new_message(self, scene: Scene, hands: int) -> _Message:
        """Return the message of a scene, of serialised markers; forget those of other bodies."""
        self._bodies = {body.name: self._bodies[body.name] for body in scene.bodies}
        self._joints = {joint.name: self._joints[joint.name] for joint in scene.joints}
        each = enumerate(self._bodies.values())
        bodies = [(row, marker) for row, (_, own) in each for marker in own]
        bare = []
        if scene.settings.bounds is not None:
            bare.append(wall_marker(scene.settings.bounds))
        if hands:
            bare.append(hands_marker(hands))
        # That of the hands is the last one before those of joints.
        others = [serialised(each, self._frame_id) for each in bare]
        joints = [marker for _, pair in self._joints.values() for marker in pair]
        drawn = [*(marker for _, marker in bodies), *others, *joints]
        deletions = self._deletions.begin({marker.key: None for marker in drawn})
        markers = [*bodies, *((-1, marker) for marker in (*others, *joints, *deletions))]
        first_joint = len(drawn) - len(joints)
        return _Message(scene, markers, self._glyphs, hands=hands, first_joint=first_joint)


class _Deletions:
    """
    The deletions of markers that are no longer drawn.

    :param frame_id: name of the world frame
    :param repeats: number of messages that have each deletion

    :ivar messages: number of messages so far
    """

    def __init__(self, frame_id: str, repeats: int) -> None:
        self.messages = 0
        self._frame_id = frame_id
        self._repeats = repeats
        # Keys of the markers that the last message draws.
        self._drawn: dict[Key, None] = {}
        # Deletions that are serialised, and those in messages, with the number of the first
        # message without each.
        self._serialised: dict[Key, MarkerBytes] = {}
        self._gone: dict[Key, tuple[MarkerBytes, int]] = {}
        self._first_end: float = math.inf

    @property
    def have_ended(self) -> bool:
        """Whether the next message is to be without one of them."""
        return self.messages >= self._first_end

    def serialise(self, kept: Collection[Key]) -> Iterator[None]:
        """Serialise the deletions of markers that are drawn, and not kept; yield after each."""
        for key in self._drawn:
            if key not in kept and key not in self._serialised:
                self._serialised[key] = self._deletion(key)
                yield

    def begin(self, drawn: dict[Key, None]) -> list[MarkerBytes]:
        """Return the deletions in the next messages, which draw these markers."""
        end = self.messages + self._repeats
        gone = {
            key: (marker, last)
            for key, (marker, last) in self._gone.items()
            if last > self.messages and key not in drawn
        }
        gone |= {key: (self._deletion(key), end) for key in self._drawn if key not in drawn}
        self._serialised.clear()
        self._drawn, self._gone = drawn, gone
        self._first_end = min((last for _, last in gone.values()), default=math.inf)
        return [marker for marker, _ in gone.values()]

    def _deletion(self, key: Key) -> MarkerBytes:
        """Return the serialised deletion of a marker."""
        known = self._serialised.get(key)
        if known is not None:
            return known
        return serialised(BareMarker(key, action=Marker.DELETE), self._frame_id)


class _Message:
    """
    The message of a scene, into which each frame writes its numbers.

    :param scene: that it shows
    :param markers: in their order, each with the row of its body, or -1
    :param glyphs: of the joints; None without joints
    :param hands: number of hands, whose marker comes before those of joints
    :param first_joint: place of the first marker of a joint, of which each joint has two
    """

    def __init__(
        self,
        scene: Scene,
        markers: Sequence[tuple[int, MarkerBytes]],
        glyphs: JointGlyphs | None,
        *,
        hands: int,
        first_joint: int,
    ) -> None:
        self._scene = scene
        self._hands = hands
        writer, offsets = joined([marker for _, marker in markers])
        rows = np.array([row for row, _ in markers], np.intp)
        self._rows = rows[rows >= 0]
        writer.poses = [offset for offset, row in zip(offsets, rows, strict=True) if row >= 0]
        self._template = MessageTemplate(writer)
        after_joints = first_joint + 2 * len(scene.joints)
        starts = offsets[first_joint:after_joints]
        self._joints = None if glyphs is None else _JointColumns(glyphs, starts)
        # Offset of the points of hands, in numbers of 8 bytes.
        self._hands_at = (offsets[first_joint - 1] + POINTS_OFFSET) // 8 if hands else 0

    def is_of(self, scene: Scene, hands: int) -> bool:
        """Return whether it shows a scene with a number of hands."""
        return scene is self._scene and hands == self._hands

    def filled(self, snapshot: Snapshot) -> bytes:
        """Return the message of a snapshot of the scene."""
        template = self._template
        if self._joints is not None:
            self._joints.fill(template, snapshot)
        if self._hands:
            ends = self._hands_at + 3 * np.arange(2 * self._hands)
            for column, values in enumerate(snapshot.grip_lines.reshape(-1, 2).T):
                template.doubles[ends + column] = values
        template.write_poses([values[self._rows] for values in pose_columns(snapshot)])
        return template.stamped(snapshot.stamp)


class _JointColumns:
    """
    The offsets of the points and colours of joints in a message.

    :param glyphs: of the joints
    :param starts: offsets of the poses of their markers [bytes], two for each joint
    """

    def __init__(self, glyphs: JointGlyphs, starts: Sequence[int]) -> None:
        scene, self._glyphs = glyphs.scene, glyphs
        self._corners = segment_corners(glyphs.lengths.tolist())
        # Offsets of the first point of each marker, in numbers of 8 bytes.
        firsts = (np.array(starts, np.intp) + POINTS_OFFSET) // 8
        counts = np.array([joint.kind.points for joint in scene.joints], np.intp)
        # Of the points of the joints: number of the joint, and 0 for its first point, 1 for its
        # second.
        self._points = np.repeat(np.arange(len(counts)), counts), _numbers(counts)
        ends = glyphs.segment_ends
        self._offsets = np.concatenate(
            (
                np.repeat(firsts[::2], counts) + 3 * self._points[1],
                np.repeat(firsts[1::2], ends) + 3 * _numbers(ends),
            )
        )
        self._color_offsets = (np.array(starts, np.intp) + COLOR_OFFSET) // 4
        self._sliders = np.array(
            [row for row, joint in enumerate(scene.joints) if joint.kind.schema.has_axis], np.intp
        )

    def fill(self, template: MessageTemplate, snapshot: Snapshot) -> None:
        """Write the points and colours of the joints of a snapshot into a message."""
        ends = snapshot.ends
        if len(self._sliders):
            ends = ends.copy()
            ends[self._sliders, 1] = ends[self._sliders, 0] + self._slider_axes(snapshot)
        corners = self._glyphs.corners(snapshot.poses)[self._corners]
        points = np.concatenate((ends[self._points], corners))
        template.doubles[self._offsets] = points[:, 0]
        template.doubles[self._offsets + 1] = points[:, 1]
        colors = np.repeat(self._glyphs.colors(snapshot), 2, axis=0)
        for channel in range(4):
            template.floats[self._color_offsets + channel] = colors[:, channel]

    def _slider_axes(self, snapshot: Snapshot) -> Floats:
        """Return the unit vectors along the lines of sliders, (s, 2) float64."""
        scene = snapshot.scene
        # The background is the last row.
        yaw = np.append(snapshot.poses[:, 2], 0.0)[scene.joint_rows[self._sliders, 1]]
        return rotated_each(scene.seats[self._sliders, 4:6], yaw)


def _numbers(counts: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return 0, 1, ... up to each count, one after the other."""
    starts = np.cumsum(counts) - counts
    numbers: NDArray[np.intp] = np.arange(counts.sum()) - np.repeat(starts, counts)
    return numbers
