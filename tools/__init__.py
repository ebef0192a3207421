# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Programs that measure, disturb and draw the package, run by targets of `make` or `python -m`.

They use the helpers of `test/`; tests of them are in `test/tools/`.
"""
