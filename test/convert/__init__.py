# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0
