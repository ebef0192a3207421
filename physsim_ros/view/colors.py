# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Colours of the picture that more than one of its parts has."""

PAPER = (250, 250, 247)
# Of words: Rerun (0.41) draws them on a plate that is light grey in its light theme and a middle
# grey in its dark one.
INK = (16, 20, 30)
