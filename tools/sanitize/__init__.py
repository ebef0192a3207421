# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Runs of tests with a core that checks its memory and its arithmetic.

`arena.c` replaces the core's own there. Start with `__main__.py`.
"""
