# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`~/events`: diagnostic_msgs/DiagnosticStatus, one for each answer."""

from __future__ import annotations

from physsim_ros.model.snapshot import Answer
from physsim_ros.ros.encoders.cdr import CdrWriter, START


def encode_event(answer: Answer) -> bytes:
    """Return a serialised diagnostic_msgs/DiagnosticStatus that reports an answer."""
    writer = CdrWriter(START)
    # The level: ERROR or OK.
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
