# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Leaves these tests out where Gymnasium is not installed, as from a ROS distribution alone."""

from importlib.util import find_spec

collect_ignore_glob = [] if find_spec('gymnasium') else ['test_*.py']
