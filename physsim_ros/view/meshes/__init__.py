# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Flat meshes with a pose in each frame: the geometry of bodies, and how it is sent.

Not here: symbols and lines of joints (`joints`). Start with `mesh`, then `body_mesh`, which draws
one body, and `body_geometry`, which groups bodies that look alike.
"""
