# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Values that all folders use, frozen and checked; numpy is the most that is imported here.

Nothing here moves, reads a clock or knows an engine. Each module is a front of its own, named by
a noun, and so are the packages `shapes`, `joints` and `requests`; this file exports nothing.
Shared by all values: `names`, `colors`, `transform`, `arrays`, `checks`, `errors`.
Descriptions of a world: `shapes`, `body_properties`, `joints`, `settings`, `scene`.
Changes of it: `requests`. States that are shown: `snapshot`, `preview`. States that are saved:
`checkpoint`. Start with `scene` and `requests`.
"""
