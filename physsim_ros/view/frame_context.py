# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Facts that a recording shows beside the frames of a world."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class FrameContext:
    """
    Facts about the program, which the world does not have.

    :param real_time_factor: simulation seconds a second; None where nothing paces the world
    :param title: of the world, which names the recording; '' for none
    """

    real_time_factor: float | None = None
    title: str = ''
