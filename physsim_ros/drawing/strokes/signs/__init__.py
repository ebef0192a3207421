# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Signs, each with its measures, its meanings and the outcomes of those.

A new sign is a `Sign` in a file of its own, a name in `SIGNS` and rows in the table of `evidence`,
which `python -m tools.evaluation.fit` makes. Features that several signs need are in `features`,
outcomes that several forms have in `outcomes`.
"""

from physsim_ros.drawing.strokes.signs.arrow import ARROW
from physsim_ros.drawing.strokes.signs.round_arrow import ROUND_ARROW
from physsim_ros.drawing.strokes.signs.swings import SCRIBBLE, ZIGZAG
from physsim_ros.drawing.strokes.signs.x import CROSS

SIGNS = (ZIGZAG, SCRIBBLE, CROSS, ARROW, ROUND_ARROW)
