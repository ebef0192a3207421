# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Values of the program at a frame, which are not in the frame itself."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class FrameContext:
    """
    Figures of the program at a frame, which the world does not have.

    :param real_time_factor: simulation seconds a second; 0 where nothing paces the world
    :param cost: mean of a frame in the last second, its steps and its publishing [s]; None where
        nothing paces the world
    :param title: of the world, which names the recording; '' for none
    :param traced: names of the bodies whose way and flight are shown
    """

    real_time_factor: float = 0.0
    cost: float | None = None
    title: str = ''
    traced: tuple[str, ...] = ()
