# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Faults: what pens and people do beside trembling, one at a time and strongly.

A fault changes the figure, the hand or the samples. It is None where a figure cannot have it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
import math

import numpy as np

from .figures import Figure
from .hand import Hand
from .hands import turning
from .outlines import Floats, Random

# The greatest sum of turns that ten samples show [rad]: that of an L is 9.4.
_MOST_TURNING = 10.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """
    A fault.

    :param figure: changes the path of the pen; None where this figure cannot be drawn so
    :param hand: changes the hand
    :param samples: changes the samples, (n, 3) float64: x, y [m], time [s]
    """

    figure: Callable[[Figure, Random], Figure | None] = lambda figure, _: figure
    hand: Callable[[Hand, Random], Hand] = lambda hand, _: hand
    samples: Callable[[Floats, Random], Floats] = lambda samples, _: samples


def _resting(samples: Floats, rng: Random) -> Floats:
    """Let the pen rest for 400 samples at the beginning, at the end or between."""
    at = int(rng.choice([0, len(samples) - 1, rng.integers(len(samples))]))
    first, later = np.split(samples, [at + 1])
    rest = np.repeat(first[-1:], 400, axis=0)
    rest[:, :2] += rng.normal(0.0, 0.002 * _size(samples), (400, 2))
    rest[:, 2] += np.arange(400) / 200.0
    return np.vstack((first, rest, np.add(later, (0.0, 0.0, 2.0))))


def _spike(samples: Floats, rng: Random) -> Floats:
    """Let one sample jump by half the figure's size."""
    result = samples.copy()
    angle = rng.uniform(0, 7)
    away = 0.5 * _size(samples) * np.array((math.cos(angle), math.sin(angle)))
    result[rng.integers(1, len(samples) - 1), :2] += away
    return result


def _resampled(count: int) -> Callable[[Floats, Random], Floats]:
    def samples_of(samples: Floats, _rng: Random) -> Floats:
        at = np.linspace(0.0, len(samples) - 1.0, count)
        rows = np.arange(len(samples))
        return np.column_stack([np.interp(at, rows, column) for column in samples.T])

    return samples_of


def _twice(figure: Figure, rng: Random) -> Figure | None:
    """Draw a closed outline nearly twice, or a little more."""
    if not figure.closed:
        return None
    again = figure.path * rng.uniform(0.95, 1.05, 2) + rng.normal(0.0, 0.015, 2)
    both = np.vstack((figure.path, again))
    return replace(figure, path=both)


def _one_round_corner(figure: Figure, rng: Random) -> Figure | None:
    """Round one corner by a quarter of its shorter side."""
    if figure.corners < 3 or figure.smooth or figure.thin < 0.2:
        return None
    path, count = figure.path, len(figure.path)
    corner = int(rng.integers(1, count - 1))
    before, here, after = path[corner - 1], path[corner], path[corner + 1]
    reach = 0.25 * min(math.dist(before, here), math.dist(here, after))
    start = here + (before - here) * reach / math.dist(before, here)
    end = here + (after - here) * reach / math.dist(after, here)
    share = np.linspace(0.0, 1.0, 9)[:, None]
    bend = (1 - share) ** 2 * start + 2 * share * (1 - share) * here + share**2 * end
    rest = np.delete(path, range(corner + 1), axis=0)
    return replace(figure, path=np.vstack((path[:corner], bend, rest)))


def _closed_only(figure: Figure, _rng: Random) -> Figure | None:
    return figure if figure.closed else None


def _round_only(figure: Figure, _rng: Random) -> Figure | None:
    return figure if figure.kind == 'disc' else None


def _carelessly_closed(hand: Hand, rng: Random) -> Hand:
    """Let the ends of a circle lie 4 to 11 % apart, or overlap by up to 18 %, and miss."""
    ends = (rng.uniform(-0.11, -0.04), rng.uniform(0.05, 0.18))
    return replace(hand, closing=float(rng.choice(ends)), slip=rng.uniform(0.02, 0.12))


def _unequal_arms(figure: Figure, rng: Random) -> Figure | None:
    """Draw the four ends of an x at 0.6 to 1.4 times their distance from its middle."""
    if figure.kind != 'x' or len(figure.path) > 4:
        return None
    return replace(figure, path=figure.path * rng.uniform(0.6, 1.4, (len(figure.path), 1)))


def _few_turns_only(figure: Figure, _rng: Random) -> Figure | None:
    """Return a figure whose turns ten samples show; they show none of a scribble's or a coil's."""
    return figure if turning(figure.path) < _MOST_TURNING else None


def _sharp_only(figure: Figure, _rng: Random) -> Figure | None:
    return None if figure.smooth else figure


def all_arrive(hand: Hand, _rng: Random) -> Hand:
    """Let all samples arrive."""
    return replace(hand, first_step=0.0, batch=1, dropped=0.0, simplified=0.0)


def _size(samples: Floats) -> float:
    return float(np.hypot(*np.ptp(samples[:, :2], axis=0)))


FAULTS: dict[str, Fault] = {
    'a pen that rests': Fault(samples=_resting),
    'a spike': Fault(hand=all_arrive, samples=_spike),
    '10 samples': Fault(figure=_few_turns_only, hand=all_arrive, samples=_resampled(10)),
    '10,000 samples': Fault(hand=all_arrive, samples=_resampled(10_000)),
    'tremor of 2 %': Fault(hand=lambda hand, rng: replace(hand, tremor=rng.uniform(0.015, 0.02))),
    'gap to 11.5 %': Fault(
        figure=_closed_only,
        hand=lambda hand, rng: replace(hand, closing=rng.uniform(-0.115, -0.06), slip=0.0),
    ),
    'ends that cross': Fault(
        figure=_closed_only,
        hand=lambda hand, rng: replace(
            hand, closing=rng.uniform(0.02, 0.1), slip=rng.uniform(0.02, 0.07)
        ),
    ),
    'drawn twice round': Fault(
        figure=_twice, hand=lambda hand, _: replace(hand, closing=min(hand.closing, 0.03))
    ),
    'one round corner': Fault(figure=_one_round_corner),
    'bowed sides': Fault(
        figure=_sharp_only, hand=lambda hand, rng: replace(hand, bow=rng.uniform(0.03, 0.07))
    ),
    'a finger on a tablet': Fault(
        hand=lambda hand, rng: replace(hand, first_step=rng.uniform(0.15, 0.35))
    ),
    'a finger on a busy page': Fault(
        hand=lambda hand, rng: replace(
            hand, first_step=rng.uniform(0.15, 0.35), batch=int(rng.integers(3, 9))
        )
    ),
    'few samples': Fault(
        hand=lambda hand, rng: replace(
            hand, rate=rng.uniform(10.0, 25.0), dropped=rng.uniform(0.0, 0.4)
        )
    ),
    'simplified': Fault(hand=lambda hand, rng: replace(hand, simplified=rng.uniform(0.004, 0.01))),
    'circle with a gap or an overlap': Fault(figure=_round_only, hand=_carelessly_closed),
    'x of unequal arms': Fault(figure=_unequal_arms),
    '3 cm': Fault(hand=lambda hand, _: replace(hand, size=0.03)),
    '50 m': Fault(hand=lambda hand, _: replace(hand, size=50.0)),
}
