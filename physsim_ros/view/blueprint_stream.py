# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Sending a blueprint without a leak.

`RecordingStream.send_blueprint` of Rerun (0.41) makes a recording with a memory sink, and sink and
recording keep each other, with two threads, until the process ends. This file can go when they do
not any more.
"""

from __future__ import annotations

import rerun as rr
import rerun.blueprint as rrb
import rerun_bindings as bindings


def send_blueprint(recording: rr.RecordingStream, blueprint: rrb.Blueprint) -> None:
    """Make a blueprint the active one of a recording, and the default one."""
    stream = rr.RecordingStream._from_native(  # noqa: SLF001  as Rerun does it
        bindings.new_blueprint(
            application_id=rr.get_application_id(recording) or '',
            make_default=False,
            make_thread_default=False,
            default_enabled=True,
        )
    )
    stream.set_time('blueprint', sequence=0)
    blueprint._log_to_stream(stream)  # noqa: SLF001  the same
    storage = stream.memory_recording().storage
    bindings.send_blueprint(storage, True, True, recording=recording.to_native())
    # Without its sink nothing keeps the recording.
    stream.disconnect()
