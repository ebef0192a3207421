# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A hand: the habits and the screen of somebody who draws."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Hand:
    """
    How somebody draws; lengths as shares of the figure's size.

    :param size: of the figure [m]
    :param place: where it is drawn [m]
    :param rate: samples a second [Hz]
    :param uneven: how far the times between two samples are from even, 0 .. 1
    :param duration: of the stroke [s]
    :param drift: slow wandering
    :param tremor: of 6 to 12 Hz
    :param noise: of every sample
    :param rounding: how far before a corner the pen begins to turn
    :param bow: how much straight lines are bent
    :param hook_down: flick when the pen is set down
    :param hook_up: flick when it is lifted
    :param closing: how much of a closed way is missing (< 0) or drawn twice (> 0)
    :param slip: how far the end misses the beginning
    :param spiral: how much the radius of a curve shrinks (> 0) or grows from end to end
    :param slowing: of the pen at corners, 0 .. 1
    :param unsteady: of the pen's speed
    :param pixel: to which samples are rounded; 0 is none
    :param first_step: length within which a touch screen sends nothing after the first sample
    :param dropped: share of the samples that are lost
    :param simplified: greatest distance of samples left out from the line through the others
    :param slant: shear of all that is drawn
    :param warp: amplitude of a smooth distortion whose waves are as long as the figure
    :param lag: of the pen behind the hand [s], of `strangers`, as are the others that follow
    :param missed: typical distance of a corner from where it should be
    :param arc: typical height of the arc of a straight side, in shares of its length
    :param wander: typical distance of the hand from its way
    """

    size: float
    place: tuple[float, float]
    rate: float
    uneven: float
    duration: float
    drift: float
    tremor: float
    noise: float
    rounding: float
    bow: float
    hook_down: float
    hook_up: float
    closing: float
    slip: float
    spiral: float
    slowing: float
    unsteady: float
    pixel: float
    first_step: float
    dropped: float
    simplified: float
    slant: float = 0.0
    warp: float = 0.0
    lag: float = 0.0
    missed: float = 0.0
    arc: float = 0.0
    wander: float = 0.0
