# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Robots: bodies that drive and sense; values only, checked as they are made."""
