# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The programs `physsim` (a world as a node) and `physsim_class` (a world for each pupil).

Start with `physsim`: it makes the node and runs `real_time_loop`; `help` has its `--help`.
"""
