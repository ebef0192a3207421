# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A hand: the habits and the screen of somebody who draws."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Hand:
    """How somebody draws; lengths are shares of the size of the figure."""

    size: float  # of the figure [m]
    place: tuple[float, float]  # where it is drawn [m]
    rate: float  # samples a second [Hz]
    uneven: float  # how far the times between two samples are from even, 0 .. 1
    duration: float  # of the stroke [s]
    drift: float  # slow wandering
    tremor: float  # of 6 to 12 Hz
    noise: float  # of every sample
    rounding: float  # how far before a corner the pen begins to turn
    bow: float  # how much straight lines are bent
    hook_down: float  # flick when the pen is set down
    hook_up: float  # flick when it is lifted
    closing: float  # how much of a closed path is missing (< 0) or drawn twice (> 0)
    slip: float  # how far the end misses the beginning
    spiral: float  # how much the radius of a curve shrinks (> 0) or grows from end to end
    slowing: float  # of the pen at corners, 0 .. 1
    unsteady: float  # of the pen's speed
    pixel: float  # to which samples are rounded; 0 is none
    first_step: float  # length within which a touch screen sends nothing after the first sample
    batch: int  # samples that arrive with one time
    dropped: float  # share of the samples that are lost
    simplified: float  # greatest distance of samples left out from the line through the others
    slant: float = 0.0  # shear of all that is drawn
    warp: float = 0.0  # amplitude of a smooth distortion whose waves are as long as the figure
    # Of `strangers` alone.
    lag: float = 0.0  # of the pen behind the hand [s]
    missed: float = 0.0  # typical distance of a corner from where it should be
    arc: float = 0.0  # typical height of the arc of a straight side, in shares of its length
    wander: float = 0.0  # typical distance of the hand from its path
