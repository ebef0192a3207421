# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Drawing by clicks: the tools, and the gesture of one tool. Start with `tools`."""
