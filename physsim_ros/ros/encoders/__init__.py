# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Encoders: frames and answers become serialised messages, one file for each stream.

Law: the bytes are those that rclpy would write, except for padding. Numpy arrays are copied into
a template; no message object is created for a body. Not here: topics and QoS (`ros.publishers`).
Start with `cdr`, then `poses`; a new stream is a file here and a line in `publishers`.
"""

from typing import Protocol

from physsim_ros.model.snapshot import Frame
from physsim_ros.ros.encoders.clock import ClockEncoder, encode_clock
from physsim_ros.ros.encoders.contacts import ContactsEncoder
from physsim_ros.ros.encoders.events import encode_event
from physsim_ros.ros.encoders.markers import DELETE_REPEATS, MarkersEncoder
from physsim_ros.ros.encoders.poses import PosesEncoder
from physsim_ros.ros.encoders.preview import preview_message
from physsim_ros.ros.encoders.states import StatesEncoder
from physsim_ros.ros.encoders.transforms import TransformsEncoder

__all__ = [
    'DELETE_REPEATS',
    'ClockEncoder',
    'ContactsEncoder',
    'Encoder',
    'MarkersEncoder',
    'PosesEncoder',
    'StatesEncoder',
    'TransformsEncoder',
    'encode_clock',
    'encode_event',
    'preview_message',
]


class Encoder(Protocol):
    """An encoder of frames."""

    def encode(self, frame: Frame) -> bytes | None:
        """Return the serialised message of a frame; None where the frame has none."""
