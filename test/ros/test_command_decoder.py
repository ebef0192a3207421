# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A serialised command is read as rclpy reads it; one that breaks off is no command."""

from __future__ import annotations

import struct

from hypothesis import given
from hypothesis import strategies as st
from physsim_ros.model.errors import Malformed
from physsim_ros.ros.requests.decoding import command_from, CommandMessage, Truncated
from physsim_ros.testing import command
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import MultiDOFJointState

ROWS = [(1.5, -2.0, 0.5), (0.0, 1e300, -0.25), (7.0, 8.0, 9.0)]


def as_rclpy_reads(message: bytes) -> tuple[object, ...]:
    read = deserialize_message(message, MultiDOFJointState)
    vectors = [
        [(each.linear, each.angular) for each in read.twist],
        [(each.force, each.torque) for each in read.wrench],
    ]
    turns = [(each.translation, each.rotation) for each in read.transforms]
    return (
        read.header.frame_id,
        tuple(read.joint_names),
        [[at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w] for at, turn in turns],
        *([[a.x, a.y, a.z, b.x, b.y, b.z] for a, b in rows] for rows in vectors),
    )


def plain(found: CommandMessage) -> tuple[object, ...]:
    rows = (found.transforms.tolist(), found.twist.tolist(), found.wrench.tolist())
    return (found.frame_id, found.joint_names, *rows)


@pytest.mark.parametrize('parts', range(8))
@pytest.mark.parametrize(
    'names', [(), ('a',), ('a/0', 'Würfel/12', ''), ('abc', 'd' * 1000, '\N{SNOWMAN}')]
)
def test_every_field_is_read_whatever_is_empty(names: tuple[str, ...], parts: int) -> None:
    rows = ROWS[: len(names)]
    message = command(
        *names,
        poses=rows if parts & 1 else (),
        twists=rows if parts & 2 else (),
        wrenches=rows if parts & 4 else (),
        frame='map' * parts,
    )
    data = serialize_message(message)
    assert plain(command_from(data)) == as_rclpy_reads(data)


def test_a_name_that_is_no_text_is_another_name_and_no_accident() -> None:
    data = serialize_message(command('names', twists=ROWS[:1])).replace(b'names', b'\xffames')
    assert command_from(data).joint_names == ('\N{REPLACEMENT CHARACTER}ames',)


def test_big_endian_commands_are_read_too() -> None:
    data = struct.pack('>4xiII1s3xII1s3xII4x6dI', 3, 0, 1, b'', 1, 1, b'', 0, 1, *range(6), 0)
    found = command_from(data)
    assert found.joint_names == ('',)
    assert found.twist.tolist() == [[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]]
    assert found.twist.dtype.isnative


def test_a_command_that_breaks_off_anywhere_is_refused() -> None:
    data = serialize_message(command('a/0', 'b/0', poses=ROWS[:2], twists=ROWS[:2], frame='map'))
    assert len(command_from(data).joint_names) == 2
    for length in range(len(data)):
        with pytest.raises(Truncated):
            command_from(data[:length])


@given(st.binary(max_size=300), st.integers(0, 255))
def test_no_bytes_are_more_than_refused(noise: bytes, place: int) -> None:
    data, end = serialize_message(command('a/0', poses=ROWS[:1])), place + len(noise)
    try:
        found = command_from(data[:place] + noise + data[end:])
    except (Malformed, Truncated):
        return
    assert found.transforms.shape[1] == 7
