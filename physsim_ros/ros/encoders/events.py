# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`~/events`: diagnostic_msgs/DiagnosticStatus, one for each answer."""

from __future__ import annotations

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from physsim_ros.model.snapshot import Answer
from rclpy.serialization import serialize_message


def encode_event(answer: Answer) -> bytes:
    """Return an answer as a serialised message, which takes a tenth of the memory of an object."""
    field = [('field', answer.field)] if answer.field else []
    values = [('code', answer.code or 'ok'), *field, *answer.values]
    message: bytes = serialize_message(
        DiagnosticStatus(
            level=DiagnosticStatus.ERROR if answer.code else DiagnosticStatus.OK,
            name=answer.topic,
            message=_encodable(answer.message),
            hardware_id=_encodable(answer.subject),
            values=[KeyValue(key=key, value=_encodable(value)) for key, value in values],
        )
    )
    return message


def _encodable(text: str) -> str:
    """Return a text with '?' for characters without UTF-8, as half surrogates of file names."""
    return text.encode(errors='replace').decode()
