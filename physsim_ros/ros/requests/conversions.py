# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
ROS messages to requests.

Law: only the message is validated here; the world validates a request when it applies it. z is
ignored, and so are stamps, except those of the poses of a stroke.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, TypeVar

from geometry_msgs.msg import PointStamped
from nav_msgs.msg import OccupancyGrid, Path
import numpy as np
from physsim_ros.files import BODY_KEYS, load_mapping, PROPERTIES, with_shipped_robot
from physsim_ros.maps import Grid, walls_of
from physsim_ros.model.arrays import Floats
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checks import shown
from physsim_ros.model.colors import Color
from physsim_ros.model.declarations import without_unset
from physsim_ros.model.errors import (
    BadProperty,
    Malformed,
    UnknownFrame,
    UnknownProperty,
)
from physsim_ros.model.names import JOINT_PREFIX
from physsim_ros.model.requests import (
    AtPoint,
    Command,
    Delete,
    DeleteAll,
    Grab,
    Join,
    join_from,
    KeepHand,
    LetGo,
    MoveHand,
    Spawn,
    Unjoin,
    UnjoinAll,
)
from physsim_ros.model.settings import MOST_SAMPLES, WorldSettings
from physsim_ros.model.texts import name_meant
from physsim_ros.ros.marker_shapes import points_from, shape_from
from physsim_ros.ros.planar import named_frame, planar_pose, point_in_frame, yaw_of
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import InteractiveMarkerFeedback, Marker

# The namespaces of markers with an empty one.
NAMESPACE, JOINT_NAMESPACE = 'body', 'joint'
# Name of the hand of feedback without `client_id`.
ANONYMOUS_HAND = 'hand'
# Keys of a body in a world file for which a marker has fields.
_FIELDS = {key: BODY_KEYS[key] for key in ('at', 'circle', 'box', 'color', 'lifetime')}
# The greatest length of `text` [characters]: ten times all properties with all digits.
LONGEST_TEXT = 10_000

# Memory of a marker without points as rclpy decodes it, and of each of its points and colours
# [bytes]: measured with tracemalloc, 1,660, and 112 to 178.
_MARKER, _ELEMENT = 2000, 180
# Namespace of the walls of a map, and their greatest number: as many bodies as a world has by
# default, whatever `max_bodies` is.
_WALLS, _MOST_WALLS = 'walls', WorldSettings().max_bodies
# Occupancy from which on a cell is a wall [percent], as map_server's `occupied_thresh` is.
OCCUPIED = 65

_AtPoint = TypeVar('_AtPoint', bound=AtPoint)


def name_of(marker: Marker) -> str:
    """Return the name of the body of a marker."""
    return f'{marker.ns or NAMESPACE}/{marker.id}'


def memory_of(marker: Marker) -> int:
    """Return the memory of a marker as rclpy decodes it [bytes]."""
    elements = marker.points, marker.colors, marker.uv_coordinates
    texts = marker.header.frame_id, marker.ns, marker.text, marker.texture_resource
    textures = marker.texture.header.frame_id, marker.texture.format, marker.texture.data
    meshes = marker.mesh_resource, marker.mesh_file.filename, marker.mesh_file.data
    letters = sum(map(len, (*texts, *textures, *meshes)))
    return _MARKER + _ELEMENT * sum(map(len, elements)) + letters


def joint_name_of(marker: Marker) -> str:
    """Return the name of the joint of a marker."""
    return f'{marker.ns.removeprefix(JOINT_PREFIX) or JOINT_NAMESPACE}/{marker.id}'


def only_name_in(message: MultiDOFJointState) -> str:
    """Return the name of the body that a command is about, or '' if it is about several."""
    return message.joint_names[0] if len(message.joint_names) == 1 else ''


def body_request(marker: Marker, frame_id: str) -> Spawn | Delete | DeleteAll:
    """
    Return the request of a marker for a body.

    :param marker: from `~/spawn`
    :param frame_id: name of the world frame
    :raises Refusal: the marker describes no valid body
    """
    if marker.action == Marker.DELETE:
        return Delete(name=name_of(marker))
    if marker.action == Marker.DELETEALL:
        return DeleteAll(namespace=marker.ns or None)
    if marker.action != Marker.ADD:
        raise BadProperty('there is no action {action}', field='action', action=marker.action)
    properties, unset = _properties(marker)
    return Spawn(
        name=name_of(marker),
        shape=shape_from(marker),
        pose=planar_pose(marker.pose, 'pose'),
        frame=named_frame(marker.header.frame_id, frame_id),
        color=_color(marker),
        lifetime=marker.lifetime.sec + marker.lifetime.nanosec * 1e-9,
        properties=properties,
        unset=unset,
    )


def _properties(marker: Marker) -> tuple[Properties, tuple[str, ...]]:
    """Return the properties that the text of a marker sets and unsets, or those of a note."""
    if marker.type == Marker.TEXT_VIEW_FACING:
        return Properties(anchored=True, sensor=True, label=marker.text), ()
    mapping, unset = without_unset(mapping_of(marker.text, 'text'), Properties)
    for key in mapping:
        word = str(key)
        if word in _FIELDS or name_meant(word, _FIELDS):
            raise UnknownProperty(
                '{key} is no property in a text: a marker has pose, scale, color and lifetime as '
                'fields',
                field=word,
                key=shown(key),
            )
    return Properties.from_mapping(with_shipped_robot(mapping, PROPERTIES)), unset


def joint_request(marker: Marker, frame_id: str) -> Join | Unjoin | UnjoinAll:
    """
    Return the request of a marker for a joint.

    :param marker: from `~/join`
    :param frame_id: name of the world frame
    :raises Refusal: the marker describes no valid joint
    """
    if marker.action == Marker.DELETE:
        return Unjoin(name=joint_name_of(marker))
    if marker.action == Marker.DELETEALL:
        return UnjoinAll(namespace=marker.ns.removeprefix(JOINT_PREFIX) or None)
    if marker.action != Marker.ADD:
        raise BadProperty('there is no action {action}', field='action', action=marker.action)
    return join_from(
        mapping_of(marker.text, 'text'),
        name=joint_name_of(marker),
        points=points_from(marker.points),
        frame=named_frame(marker.header.frame_id, frame_id),
    )


def point_request(kind: type[_AtPoint], message: PointStamped, frame_id: str) -> _AtPoint:
    """
    Return the request of a point.

    :param kind: class of the request
    :raises Malformed: the point is not finite
    """
    point, frame = point_in_frame(message, frame_id)
    return kind(point=point, frame=frame)


def hand_request(
    feedback: InteractiveMarkerFeedback, frame_id: str
) -> Grab | MoveHand | KeepHand | LetGo:
    """
    Return the request of a hand.

    The hand is at `mouse_point`, or at the position of `pose` where that is not valid.

    :param feedback: from `~/drag/feedback`; its client_id is whose hand it is
    :param frame_id: name of the world frame
    :raises Malformed: a number is not finite, or the name of the hand is unprintable
    :raises BadProperty: the type of event is not one of a hand
    """
    hand = feedback.client_id or ANONYMOUS_HAND
    valid = feedback.mouse_point_valid
    position = feedback.mouse_point if valid else feedback.pose.position
    point, frame = (position.x, position.y), named_frame(feedback.header.frame_id, frame_id)
    match feedback.event_type:
        case InteractiveMarkerFeedback.MOUSE_DOWN:
            return Grab(hand=hand, point=point, frame=frame)
        case InteractiveMarkerFeedback.POSE_UPDATE:
            return MoveHand(hand=hand, point=point, frame=frame)
        case InteractiveMarkerFeedback.KEEP_ALIVE:
            return KeepHand(hand=hand)
        case InteractiveMarkerFeedback.MOUSE_UP:
            return LetGo(hand=hand)
    raise BadProperty(
        'a hand has no event_type {event_type}', field='event_type', event_type=feedback.event_type
    )


def command_request(message: MultiDOFJointState, frame_id: str) -> Command:
    """
    Return the request with the poses, twists and wrenches of a message.

    :raises Malformed: the lengths differ, or a number is not finite
    :raises NotPlanar: a rotation is not about z
    """
    return Command(
        names=tuple(message.joint_names),
        poses=_rows(
            (each.translation.x, each.translation.y, yaw_of(each.rotation, 'transforms'))
            for each in message.transforms
        ),
        twists=_rows((each.linear.x, each.linear.y, each.angular.z) for each in message.twist),
        wrenches=_rows((each.force.x, each.force.y, each.torque.z) for each in message.wrench),
        frame=named_frame(message.header.frame_id, frame_id),
    )


def _rows(rows: Iterable[tuple[float, float, float]]) -> Floats:
    """Return rows of three numbers as an array, (n, 3) float64."""
    return np.array([*rows], dtype=np.float64).reshape(-1, 3)


def stroke_samples(path: Path) -> tuple[str, Floats, float | None]:
    """
    Return the frame of a stroke, its samples, and the time of the first.

    :param path: from `~/stroke`
    :return: name of its frame; (n, 3) float64: x, y [m] and time from the first sample [s]; stamp
        of the first sample [s], None where all have the same
    :raises Malformed: there are too many samples, or they are in different frames
    """
    if len(path.poses) > MOST_SAMPLES:
        template = 'poses has at most {most} elements, not {count}'
        raise Malformed(template, field='poses', most=MOST_SAMPLES, count=len(path.poses))
    # A pose without a frame is in that of the path, and a path without one in that of its poses.
    frames = {each.header.frame_id for each in (path, *path.poses)} - {''}
    if len(frames) > 1:
        one, other, *_ = map(shown, sorted(frames))
        raise Malformed(
            'a stroke is drawn in one frame, not in {one} and {other}',
            field='header.frame_id',
            one=one,
            other=other,
        )
    stamps = [each.header.stamp.sec * 10**9 + each.header.stamp.nanosec for each in path.poses]
    places = [(each.pose.position.x, each.pose.position.y) for each in path.poses]
    times = ((stamp - stamps[0]) * 1e-9 for stamp in stamps)
    samples = np.array([(*place, time) for place, time in zip(places, times, strict=True)])
    samples = samples.reshape(-1, 3)
    began = stamps[0] * 1e-9 if samples[:, 2].any() else None
    return next(iter(frames), ''), samples, began


def walls_requests(message: OccupancyGrid, frame_id: str) -> tuple[DeleteAll | Spawn, ...]:
    """
    Return the requests that make walls of the occupied cells of a map, in place of earlier ones.

    :param message: from `~/walls`
    :param frame_id: name of the world frame; `map`, as map_server calls it, is that too
    :raises Refusal: the map is none, has a frame of its own, or makes too many walls
    """
    info = message.info
    frame = named_frame(message.header.frame_id, frame_id)
    if frame not in ('', 'map'):
        template = 'a map is in the frame of the world, not in {frame!r}'
        raise UnknownFrame(template, field='header.frame_id', frame=frame)
    cells = np.frombuffer(message.data, np.int8)
    if len(cells) != info.width * info.height:
        raise Malformed(
            'data has {count} cells, not {width} times {height}',
            field='data',
            count=len(cells),
            width=info.width,
            height=info.height,
        )
    position = info.origin.position
    yaw = yaw_of(info.origin.orientation, 'info.origin.orientation')
    grid = Grid(
        occupied=cells.reshape(info.height, info.width) >= OCCUPIED,
        resolution=float(info.resolution),
        origin=(position.x, position.y, yaw),
    )
    return DeleteAll(namespace=_WALLS), *walls_of(grid, _WALLS, _MOST_WALLS)


def mapping_of(text: str, field: str) -> dict[Any, Any]:
    """
    Return the mapping of a short text in YAML.

    :param field: of the message, for the refusal
    :raises Malformed: it is too long, or none
    """
    if len(text) > LONGEST_TEXT:
        raise Malformed('{field} is longer than {most} characters', field=field, most=LONGEST_TEXT)
    return load_mapping(text, field=field)


def _color(marker: Marker) -> Color | None:
    color = (marker.color.r, marker.color.g, marker.color.b, marker.color.a)
    return None if marker.color.a == 0.0 else color
