# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The lock of Rerun's list of all recordings of the process.

Rerun (0.41) has a list of its recordings and blueprints behind a mutex. Making one waits for that
mutex and keeps the interpreter's lock meanwhile; the cleanup of those that are closed keeps the
mutex until all others are flushed; and a file's writer needs the interpreter's lock to free what
it has written. Three threads that do these at once wait for each other for ever.

Law: a recording or blueprint is made, dropped and cleaned up under this lock. Whoever waits for it
gives the interpreter's lock away.
"""

from __future__ import annotations

from threading import Lock

RECORDING_LIST = Lock()
