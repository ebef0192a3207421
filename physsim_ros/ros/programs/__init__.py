# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The programs `physsim` (a world as a node) and `physsim_draw` (a node that draws strokes).

Start with `physsim`: it makes the node and runs `real_time_loop`. `stroke_publisher` is the node
of `physsim_draw`; `help` has what both print for `--help`.
"""
