# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Mutation testing: a constant or a condition is changed, and a fast test of its folder has to fail.

A mutation that survives is a constant without a law, or a condition without a case (DeMillo,
Lipton and Sayward, "Hints on Test Data Selection", 1978). Start with `__main__.py`.
"""
