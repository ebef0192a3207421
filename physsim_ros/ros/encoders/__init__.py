# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Encoders: frames and answers become messages, one file for each stream.

Messages with a part for each body, joint or contact are written as bytes (`cdr`): arrays of NumPy
are copied into a template, without an object for each part, which took 40 times as long. The bytes
are those that rclpy would write, except for padding. All other messages are objects of rclpy. Not
here: topics and QoS (`ros.publishers`). Start with `poses`; a new stream is a file here and a line
in `ros.publishers.publishers`.
"""

from typing import Any, Protocol

from physsim_ros.model.snapshot import Frame
from physsim_ros.ros.encoders.clock import ClockEncoder
from physsim_ros.ros.encoders.contacts import ContactsEncoder
from physsim_ros.ros.encoders.events import encode_event
from physsim_ros.ros.encoders.interactive_poses import InteractivePosesEncoder
from physsim_ros.ros.encoders.map import MapEncoder
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
    'InteractivePosesEncoder',
    'MapEncoder',
    'MarkersEncoder',
    'PosesEncoder',
    'StatesEncoder',
    'TransformsEncoder',
    'encode_event',
    'preview_message',
]


class Encoder(Protocol):
    """An encoder of frames."""

    def encode(self, frame: Frame) -> Any:
        """Return the message of a frame, serialised or not; None where the frame has none."""
