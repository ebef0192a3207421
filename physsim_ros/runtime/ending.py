# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The time in which a program ends.

Law: a part that could take longer, as the index of a recording, is given up when its time is over.
"""

from __future__ import annotations

# Time for an orderly end after the first signal [s]. With that of the interpreter itself it is
# less than 3 s, as users are told; `ros2 launch` sends another signal after 5 s.
ENDING = 2.5
# Part of that for viewers, recordings and child processes, which end at the same time [s].
CLOSING = 2.0
