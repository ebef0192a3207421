# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Freehand strokes: resampled, recognised, interpreted in the scene, regularised into requests.

Not here: clicks (`clicks`), and the session that both belong to (`drawing.session`). Start with
`interpretation`, then `recogniser`; `signs` has one file for each sign.
"""
