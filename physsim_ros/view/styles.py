# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Colours and the style of words that several parts of the picture share."""

import rerun as rr

PAPER = (250, 250, 247)
# Rerun (0.41) draws words on a plate that is light grey in its light theme and a middle grey in
# its dark one.
INK = (16, 20, 30)
# Lines and points of what a person draws or drags.
PEN = (230, 51, 128)
_POINT = rr.Radius.ui_points(0.0)
# Points of which only the labels are seen, in the world and in the image of the camera.
LABELS = rr.Points3D.from_fields(colors=[INK], radii=_POINT, show_labels=True)
IMAGE_LABELS = rr.Points2D.from_fields(colors=[INK], radii=_POINT, show_labels=True)
