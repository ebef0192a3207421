# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Publishers of the world: streams of frames, events, the timeline.

Not here: the bytes of messages (`ros.encoders`), and the report on `/diagnostics`
(`ros.diagnostics`). Start with `publishers`, which has a line for each topic.
"""
