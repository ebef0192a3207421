# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Drawing tools that take clicks: one state machine a gesture. Start with `tools`."""
