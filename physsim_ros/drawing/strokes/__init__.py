# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Freehand strokes: resampled, recognised, read in the scene, regularised into requests.

Not here: clicks (`drawing.tools`), and the session that both belong to (`drawing.session`). Start
with `reading`, which has the stages of one stroke in their order; `signs` has one file for each
sign. Their geometry is in `resampled`, `fitting`, `corner_detection`, `outer_boundary` and
`regularisation`; what lies under a stroke in `bodies_under` and `axles`. With `sketch` begins what
several strokes are together: `grouping`, `joining`, `marks`, `waiting`, `waiting_joints`.
"""
