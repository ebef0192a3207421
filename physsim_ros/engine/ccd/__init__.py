# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Continuous collision: fast bodies do not pass through others within a step.

Broad phase of swept boxes, time of impact by conservative advancement, and plastic impacts of the
moves, which leave velocities alone. Not here: contacts, which the engine resolves where the step
ends. Start with `continuous`, then `broad_phase`, `hulls` and `time_of_impact`.
"""
