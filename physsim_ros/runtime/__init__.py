# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
How code runs here, whatever it does: where an unexpected error ends, where work may be cut off.

- `error_boundary`: an unexpected error ends one message or one output.
- `slices`: work that lets messages and steps come between.
- `ending`: the time in which a program ends.
- `garbage_collection`: suspended while many objects are made that stay.
"""
