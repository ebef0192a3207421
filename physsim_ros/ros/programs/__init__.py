# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The programs `physsim` (a world as a node) and `physsim_class` (a world for each pupil).

Start with `physsim`: it makes the node, which `real_time_loop` runs; `process` has signals and the
end, `help` the text of `--help`.
"""
