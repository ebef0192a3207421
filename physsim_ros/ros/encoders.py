# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
Arrays to serialised ROS messages, without building a message object a body.

Law: what leaves here is, byte for byte but for padding, what rclpy would have written.

Whatever stays while a scene stays (lengths, names, colours, outlines) is written once, into a
template; a frame only writes its stamp and its floats into that, at places known beforehand. The
form is plain CDR, little endian: four bytes of header, then every number aligned to its own size
counted from after them; a string is its length with the NUL, its characters and the NUL.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
import struct

import numpy as np
from physsim_ros.model.arrays import Floats, Ints, Singles
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.scene import Body, Joint, Scene
from physsim_ros.model.snapshot import Answer, Contacts, Snapshot
from physsim_ros.model.transform import turned
from physsim_ros.ros.markers import joint_symbols, Key, Symbol, symbols, walls
from physsim_ros.view.joint_glyphs import Linework, segments, size_of, strips
from visualization_msgs.msg import Marker

# The header of a message; before it four bytes, so that what follows it lies aligned in memory.
_START = b'\0\0\0\0\0\1\0\0'
_SECOND = 1_000_000_000

# A marker from its pose on: pose, scale, color, lifetime, frame_locked, number of points.
_POSED = struct.Struct('<7d3d4f8xx3xi')
# Where in that the color begins [bytes].
_COLORED = struct.calcsize('<7d3d')
_IDENTITY = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
# No colors, texture_resource, texture (stamp, frame_id, format, data), uv_coordinates.
_UNTEXTURED = struct.pack('<ii4s8xi4si4sii', 0, 1, b'', 1, b'', 1, b'', 0, 0)
# No mesh_resource, mesh_file (filename, data), mesh_use_embedded_materials.
_UNMESHED = struct.pack('<i4si4six', 1, b'', 1, b'', 0)
# Which doubles of a pose or transform are not always zero: x, y, and z and w of the quaternion.
_PLACE = (0, 1, 5, 6)

# Messages in which a marker is deleted. The stream keeps one message, so a slow reader misses
# some; within a second of them it gets one.
DELETE_REPEATS = 60

# 10 MB of names; a dense crowd of 1000 that keeps changing its neighbours takes minutes to them.
_MOST_PAIRS = 100_000


class PosesEncoder:
    """
    Encode geometry_msgs/PoseArray: the pose of every body, in spawn order.

    :param frame_id: name of the world frame
    """

    def __init__(self, frame_id: str) -> None:
        self._frame_id = frame_id
        self._scene: Scene | None = None

    def encode(self, snapshot: Snapshot) -> bytes:
        """Return the serialised message."""
        if snapshot.scene is not self._scene:
            writer = _Writer(_START)
            writer.header(self._frame_id)
            writer.block(len(snapshot.scene.bodies), 7)
            self._template = _Template(writer)
            self._scene = snapshot.scene
        _fill(self._template.blocks[0], _PLACE, _places(snapshot))
        return self._template.stamped(snapshot.stamp)


class StatesEncoder:
    """
    Encode sensor_msgs/MultiDOFJointState: name, pose and twist of every body, in spawn order.

    :param frame_id: name of the world frame
    """

    def __init__(self, frame_id: str) -> None:
        self._frame_id = frame_id
        self._scene: Scene | None = None

    def encode(self, snapshot: Snapshot) -> bytes:
        """Return the serialised message."""
        if snapshot.scene is not self._scene:
            names = [_padded(name) for name in snapshot.scene.names]
            self._template = _joint_states(self._frame_id, names, twists=len(names))
            self._scene = snapshot.scene
        transforms, twists, _ = self._template.blocks
        _fill(transforms, _PLACE, _places(snapshot))
        _fill(twists, (0, 1, 5), snapshot.twists.T)
        return self._template.stamped(snapshot.stamp)


class ContactsEncoder:
    """
    Encode sensor_msgs/MultiDOFJointState: an entry for every pair of bodies that touched.

    Its name is `a|b`, its transform the contact point with the x axis along the normal from a to
    b, its wrench the impulse [N s].

    :param frame_id: name of the world frame
    """

    def __init__(self, frame_id: str) -> None:
        self._frame_id = frame_id
        self._scene: Scene | None = None
        self._pairs: Ints = np.empty((0, 2), np.int64)

    def encode(self, snapshot: Snapshot, contacts: Contacts) -> bytes:
        """Return the serialised message."""
        renamed = snapshot.scene is not self._scene
        if renamed:
            self._names = _PairNames(snapshot.scene.names)
            self._scene = snapshot.scene
        # In a pile that has settled the same pairs touch in frame after frame.
        if renamed or not np.array_equal(contacts.pairs, self._pairs):
            names = self._names.of(contacts.pairs)
            self._template = _joint_states(self._frame_id, names, wrenches=len(names))
            self._pairs = contacts.pairs
        transforms, _, wrenches = self._template.blocks
        _fill(transforms, _PLACE, (*contacts.points.T, *_turn_to(contacts.normals)))
        _fill(wrenches, (0, 1), contacts.impulses.T)
        return self._template.stamped(snapshot.stamp)


class MarkersEncoder:
    """
    Encode visualization_msgs/MarkerArray: the whole picture, and what has gone from it.

    A body is drawn with the marker that would spawn it, its material in `text`. A marker that is
    in the picture no more is deleted in the next `DELETE_REPEATS` messages.

    :param frame_id: name of the world frame
    """

    def __init__(self, frame_id: str) -> None:
        self._frame_id = frame_id
        self._scene: Scene | None = None
        self._drawn: dict[str, tuple[Body, tuple[_Piece, ...]]] = {}
        self._shown: dict[Key, None] = {}
        # What deletes a marker that has gone, and the number of the first message without it.
        self._gone: dict[Key, tuple[_Piece, int]] = {}
        self._until = -1
        self._count = 0
        self._joints: _JointPieces | None = None
        self._lined: dict[str, tuple[tuple[Joint, float], tuple[_Piece, _Piece]]] = {}

    def encode(self, snapshot: Snapshot) -> bytes:
        """Return the serialised message."""
        if snapshot.scene is not self._scene or self._count == self._until:
            self._draw(snapshot.scene)
        self._count += 1
        if self._joints is not None:
            self._joints.fill(self._template, snapshot)
        for spots, values in zip(self._spots, _places(snapshot), strict=True):
            self._template.doubles[spots] = values[self._rows]
        return self._template.stamped(snapshot.stamp)

    def _draw(self, scene: Scene) -> None:
        """Lay out a new template from the pieces of the last one, as far as they still hold."""
        pieces = self._pieces(scene)
        lined = [(-1, piece) for pair in self._joint_pieces(scene) for piece in pair]
        pieces += lined
        shown = dict.fromkeys(piece.key for _, piece in pieces)
        until = self._count + DELETE_REPEATS
        gone = {
            key: (piece, last)
            for key, (piece, last) in self._gone.items()
            if last > self._count and key not in shown
        }
        gone |= {key: (self._deletion(key), until) for key in self._shown if key not in shown}
        pieces += [(-1, piece) for piece, _ in gone.values()]

        writer = _Writer(_START)
        writer.ints(len(pieces))
        starts: list[int] = []
        spots: list[int] = []
        for _, piece in pieces:
            writer.align(4)
            starts.append(len(writer.data))
            writer.data += piece.head
            writer.align(8)
            spots.append(len(writer.data))
            writer.data += piece.rest
        self._template = _Template(writer, starts)
        first = len(pieces) - len(gone) - len(lined)
        last = first + len(lined)
        self._joints = _JointPieces(scene, spots[first:last]) if lined else None
        rows = np.array([row for row, _ in pieces], np.intp)
        moving = rows >= 0
        self._rows = rows[moving]
        self._spots = np.array(spots, np.intp)[moving] // 8 + np.array(_PLACE)[:, None]
        self._scene, self._shown, self._gone = scene, shown, gone
        self._until = min((last for _, last in gone.values()), default=-1)

    def _pieces(self, scene: Scene) -> list[tuple[int, _Piece]]:
        """Return the picture, each marker with the row of the body that it moves with, or -1."""
        drawn = {}
        pieces = []
        for row, body in enumerate(scene.bodies):
            before = self._drawn.get(body.name)
            if before is None or (before[0] is not body and before[0] != body):
                before = body, tuple(self._piece(symbol) for symbol in symbols(body))
            drawn[body.name] = before
            pieces += [(row, piece) for piece in before[1]]
        self._drawn = drawn
        if scene.settings.bounds is not None:
            pieces.append((-1, self._piece(walls(scene.settings.bounds))))
        return pieces

    def _joint_pieces(self, scene: Scene) -> list[tuple[_Piece, _Piece]]:
        """Return the picture of the joints: for each its points, and its lines."""
        if not scene.joints:
            self._lined = {}
            return []
        bodies = dict(zip(scene.names, scene.bodies, strict=True))
        lined = {}
        for joint in scene.joints:
            before = self._lined.get(joint.name)
            size = size_of(joint, bodies)
            if before is None or before[0] != (joint, size):
                corners = len(segments([len(strip) for strip in strips(joint, size)]))
                points, lines = joint_symbols(joint, size, corners)
                before = (joint, size), (self._piece(points), self._piece(lines))
            lined[joint.name] = before
        self._lined = lined
        return [pieces for _, pieces in lined.values()]

    def _deletion(self, key: Key) -> _Piece:
        return self._piece(Symbol(key, action=Marker.DELETE))

    def _piece(self, symbol: Symbol) -> _Piece:
        head = _Writer()
        head.header(self._frame_id)
        head.text(symbol.key[0])
        head.ints(symbol.key[1], symbol.kind, symbol.action)
        rest = _Writer(_POSED.pack(*_IDENTITY, *symbol.scale, *symbol.color, len(symbol.points)))
        rest.doubles(*(number for x, y in symbol.points for number in (x, y, symbol.height)))
        rest.data += _UNTEXTURED
        rest.text(symbol.text)
        rest.align(4)
        rest.data += _UNMESHED
        return _Piece(key=symbol.key, head=bytes(head.data), rest=bytes(rest.data))


def encode_clock(stamp: int) -> bytes:
    """
    Return a serialised rosgraph_msgs/Clock.

    :param stamp: simulation time [ns]
    """
    return _START[4:] + struct.pack('<iI', *divmod(stamp, _SECOND))


def encode_event(answer: Answer) -> bytes:
    """Return a serialised diagnostic_msgs/DiagnosticStatus that tells of an answer."""
    writer = _Writer(_START)
    writer.data += b'\2' if answer.code else b'\0'
    for text in (answer.topic, answer.message, answer.subject):
        writer.text(text)
    values = [('code', answer.code or 'ok')]
    if answer.field:
        values.append(('field', answer.field))
    values.extend(answer.values)
    writer.ints(len(values))
    for key, value in values:
        writer.text(key)
        writer.text(value)
    return bytes(writer.data[4:])


# What the picture is made of.


@dataclass(frozen=True, slots=True, kw_only=True)
class _Piece:
    """
    A serialised marker, cut where padding depends on where it starts.

    What follows the cut begins with the pose and lies the same way after any multiple of 8.
    """

    key: Key
    head: bytes
    rest: bytes


class _JointPieces:
    """
    Where in a message the joints of a scene are.

    :param scene: whose they are
    :param starts: where the poses of their markers are [bytes], two for each joint
    """

    def __init__(self, scene: Scene, starts: Sequence[int]) -> None:
        self._linework = Linework(scene)
        self._corners = segments(self._linework.lengths.tolist())
        counts = np.bincount(self._linework.owner, 2 * self._linework.lengths - 2)
        spots: list[int] = []
        # Of the points of the joints: number of the joint, and whether it is the second one.
        points: list[tuple[int, int]] = []
        for number, joint in enumerate(scene.joints):
            first = (starts[2 * number] + _POSED.size) // 8
            spots += (first + 3 * each for each in range(joint.kind.points))
            points += ((number, each) for each in range(joint.kind.points))
        for number, count in enumerate(counts.tolist()):
            first = (starts[2 * number + 1] + _POSED.size) // 8
            spots += (first + 3 * each for each in range(int(count)))
        self._spots = np.array(spots, np.intp)
        self._points = tuple(np.array(points, np.intp).T)
        self._colors = (np.array(starts, np.intp) + _COLORED) // 4
        self._sliders = np.array(
            [row for row, joint in enumerate(scene.joints) if joint.kind is JointKind.SLIDER],
            np.intp,
        )

    def fill(self, template: _Template, snapshot: Snapshot) -> None:
        """Write where the joints are, and in what colours, into a message."""
        ends = snapshot.ends
        if len(self._sliders):
            ends = ends.copy()
            ends[self._sliders, 1] = ends[self._sliders, 0] + self._lines(snapshot)
        corners = self._linework.corners(snapshot.poses)[self._corners]
        places = np.concatenate((ends[self._points], corners))
        template.doubles[self._spots] = places[:, 0]
        template.doubles[self._spots + 1] = places[:, 1]
        colors = np.repeat(self._linework.colors(snapshot.forces), 2, axis=0)
        for channel in range(4):
            template.floats[self._colors + channel] = colors[:, channel]

    def _lines(self, snapshot: Snapshot) -> Floats:
        """Return (s, 2) float64: unit vectors along the lines of sliders."""
        scene = snapshot.scene
        # The background is the last row.
        yaw = np.append(snapshot.poses[:, 2], 0.0)[scene.joint_rows[self._sliders, 1]]
        return turned(scene.seats[self._sliders, 4:6], yaw)


# Templates: written slowly once, then filled fast.


class _Writer:
    """
    Writes values one after the other, each aligned as it has to be.

    :param start: what comes first; where it is not empty, a multiple of 8 bytes
    """

    def __init__(self, start: bytes = b'') -> None:
        self.data = bytearray(start)
        self.blocks: list[tuple[int, int, int]] = []

    def align(self, size: int) -> None:
        self.data += b'\0\0\0\0\0\0\0'[: -len(self.data) % size]

    def ints(self, *values: int) -> None:
        self.align(4)
        self.data += struct.pack(f'<{len(values)}i', *values)

    def doubles(self, *values: float) -> None:
        if values:
            self.align(8)
            self.data += struct.pack(f'<{len(values)}d', *values)

    def text(self, text: str) -> None:
        self.align(4)
        self.data += _string(text)

    def header(self, frame_id: str) -> None:
        self.ints(0, 0)
        self.text(frame_id)

    def block(self, count: int, width: int) -> None:
        """Leave room for a sequence of `count` values of `width` doubles each."""
        self.ints(count)
        if count:
            self.align(8)
        self.blocks.append((len(self.data), count, width))
        self.data += bytes(8 * count * width)


class _Template:
    """
    A message whose stamps and doubles can be written over.

    :param writer: what has been written, from `_START` on
    :param starts: where the stamps are [bytes]

    :ivar doubles: (k,) float64: all of it, as if it were nothing but doubles
    :ivar floats: (k,) float32: all of it, as if it were nothing but floats
    :ivar blocks: (count, width) float64 each: where room was left
    """

    def __init__(self, writer: _Writer, starts: Sequence[int] = (len(_START),)) -> None:
        self._message = memoryview(writer.data)[4:]
        self._words = np.frombuffer(writer.data, '<u4', len(writer.data) // 4)
        self._seconds = np.array(starts, np.intp) // 4
        self._nanoseconds = self._seconds + 1
        self.doubles: Floats = np.frombuffer(writer.data, '<f8', len(writer.data) // 8)
        self.floats: Singles = np.frombuffer(writer.data, '<f4', len(writer.data) // 4)
        self.blocks = [
            np.frombuffer(writer.data, '<f8', count * width, start).reshape(count, width)
            for start, count, width in writer.blocks
        ]

    def stamped(self, stamp: int) -> bytes:
        """Return the message as it stands, at a time [ns]."""
        self._words[self._seconds], self._words[self._nanoseconds] = divmod(stamp, _SECOND)
        return bytes(self._message)


class _PairNames(dict[int, bytes]):
    """
    Serialised names of pairs of bodies, by the number of the pair.

    :param names: of the bodies of a scene
    """

    def __init__(self, names: tuple[str, ...]) -> None:
        super().__init__()
        # Row -1, the walls, is the last one.
        self._names = (*names, WORLD)

    def __missing__(self, pair: int) -> bytes:
        first, second = divmod(pair, len(self._names))
        name = self[pair] = _padded(f'{self._names[first]}|{self._names[second]}')
        return name

    def of(self, pairs: Ints) -> list[bytes]:
        """Return the name of each pair of rows, (m, 2) int64."""
        if len(self) > _MOST_PAIRS:
            self.clear()
        count = len(self._names)
        numbers = pairs[:, 0] * count + pairs[:, 1] % count
        return list(map(self.__getitem__, numbers.tolist()))


def _joint_states(
    frame_id: str, names: list[bytes], *, twists: int = 0, wrenches: int = 0
) -> _Template:
    """Return a MultiDOFJointState whose blocks are transforms, twists and wrenches."""
    writer = _Writer(_START)
    writer.header(frame_id)
    writer.ints(len(names))
    writer.data += b''.join(names)
    writer.block(len(names), 7)
    writer.block(twists, 6)
    writer.block(wrenches, 6)
    return _Template(writer)


def _string(text: str) -> bytes:
    # Characters that no message can hold, half surrogates of broken file names, become '?'.
    data = text.encode(errors='replace') + b'\0'
    return struct.pack('<I', len(data)) + data


def _padded(text: str) -> bytes:
    """Return a string with the padding that another one behind it would need."""
    data = _string(text)
    return data + bytes(-len(data) % 4)


# Three streams ask for the same frame one after the other.
@lru_cache(maxsize=1)
def _places(snapshot: Snapshot) -> tuple[Floats, ...]:
    """Return x, y [m], and z and w of the quaternion about z, (n,) float64 each."""
    x, y, yaw = snapshot.poses.T
    return x, y, np.sin(yaw / 2), np.cos(yaw / 2)


def _turn_to(normals: Floats) -> tuple[Floats, Floats]:
    """Return z and w of the quaternion about z that turns the x axis onto unit vectors."""
    x, y = normals.T
    # Half angle formulas, three times as fast as arctan2, sin and cos. The larger of z and w comes
    # from the root, the smaller one from it, so that neither loses digits.
    large = np.sqrt((1 + np.abs(x)) / 2)
    small = y / (2 * large)
    right = x >= 0
    return (
        np.where(right, small, np.copysign(large, y)),
        np.where(right, large, np.abs(small)),
    )


def _fill(block: Floats, columns: Iterable[int], values: Iterable[Floats]) -> None:
    # Column by column: numpy copies (n, 2) into (n, 7) five times slower than twice (n,).
    for column, value in zip(columns, values, strict=True):
        block[:, column] = value
