# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Joints in the picture: symbols, lines and dots, in the colours of their forces.

Not here: what a joint does (`engine.joints`). Start with `joint_glyphs`, which has the lines of
each kind and is shared with the markers of `ros`; `joint_track` sends them.
"""
