# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`make coverage`: the share of the package's lines, in Python and in C, that the tests run."""
