# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Hands: they draw a figure with tremor, haste, hooks and all that pens and screens add.

Every figure is drawn by a hand of its own. Its habits are drawn from wide ranges, each
effect often absent, so that there are tidy hands, hasty ones, old ones and mice among them.

Times are those of gestures by pen and finger, 0.4 to 1.7 s each (Leiva, Martín-Albo and Vatavu,
"GATO: predicting human performance with multistroke and multitouch gesture input", 2018), and of
the events of screens, 8 to 30 ms apart. A page places them in whole pixels, of which a
figure has 20 to 400. Of 100 people 99 leave a gap of less than 11.5 %.
"""

from __future__ import annotations

from dataclasses import replace
import math

import numpy as np
from numpy.typing import NDArray

from . import strangers
from .figures import Figure, Floats, Random
from .hand import Hand

# The greatest distance of a path from the samples that show it, in shares of the size, beside what
# the hand trembles: a circle of eight samples has 0.03.
_SHOWN = 0.03
# The least and the greatest size of a pixel, in shares of the size of the figure; and the least
# number of pixels for each corner, and across: nobody draws a star as small as a cross.
_FINEST, _COARSEST, _PIXELS = 0.0025, 0.05, 4.0
# The greatest number of times that somebody draws a figure again, each time more slowly.
_ATTEMPTS = 6


def hand(rng: Random, figure: Figure, half: str = 'report') -> Hand:
    """
    Return somebody of a half of the people: no hand of one half has the habits of the other.

    Hands `apart` are of another kind: they slant and distort what they draw, and their other
    habits have longer tails. Those of `strangers` have another mechanism.
    """
    corners = max(turning(figure.path) / (math.pi / 2) if figure.smooth else len(figure.path), 3)
    # People draw thin shapes with more care, if not enough.
    care = min(1.0, math.sqrt(figure.thin / 0.25))
    # Seconds a corner. A pen in a hurry cuts corners.
    pace = math.exp(_habit(rng, math.log(0.1), math.log(0.7), half))
    hurry = rng.uniform(0.0, 0.04) if pace < 0.2 else 0.0
    somebody = Hand(
        size=math.exp(rng.uniform(math.log(0.4), math.log(6.0))),
        place=(rng.uniform(-20.0, 20.0), rng.uniform(-20.0, 20.0)),
        rate=math.exp(_habit(rng, math.log(33.0), math.log(125.0), half)),
        uneven=rng.uniform(0.0, 0.6),
        duration=corners * pace,
        drift=care * _often(rng, 0.8, 0.012),
        tremor=care * _often(rng, 0.6, 0.004),
        noise=_often(rng, 0.5, 0.0025),
        rounding=care * (hurry + _often(rng, 0.7, 0.025)),
        bow=care * _often(rng, 0.7, 0.03),
        hook_down=care * _often(rng, 0.2, 0.05),
        hook_up=care * _often(rng, 0.25, 0.05),
        closing=_closing(rng, figure),
        slip=care * _often(rng, 0.8, 0.04),
        spiral=rng.normal(0.0, 0.06) if figure.smooth else 0.0,
        slowing=_habit(rng, 0.0, 0.85, half),
        unsteady=_habit(rng, 0.0, 0.4, half),
        pixel=float(rng.choice([0.0, _pixel(rng, figure.thin, corners)])),
        first_step=0.0,
        batch=1,
        dropped=0.0,
        simplified=0.0,
    )
    # A finger on a tablet goes 61 to 71 pixels before the screen calls it a stroke. A busy page
    # gets several samples at once.
    first_step = rng.uniform(0.0, 0.35) if rng.random() < 0.5 else 0.0
    batch = int(rng.integers(2, 6)) if rng.random() < 0.25 else 1
    sending = rng.random()
    somebody = replace(
        somebody,
        first_step=first_step,
        batch=batch,
        dropped=rng.uniform(0.2, 0.7) if sending < 0.3 else 0.0,
        simplified=rng.uniform(0.004, 0.01) if sending > 0.85 else 0.0,
    )
    if half == 'strangers':
        return strangers.stranger(somebody, care, rng)
    return _apart(somebody, care, rng) if half == 'apart' else somebody


def _apart(somebody: Hand, care: float, rng: Random) -> Hand:
    """Return a hand that distorts; its wandering, rounding and bows have exponential tails."""
    return replace(
        somebody,
        drift=care * rng.exponential(0.007),
        rounding=care * rng.exponential(0.02),
        bow=care * rng.exponential(0.02),
        slowing=rng.uniform(0.2, 0.9),
        slant=care * rng.normal(0.0, 0.06),
        warp=care * rng.exponential(0.012),
    )


def drawn(figure: Figure, somebody: Hand, rng: Random) -> Floats:
    """
    Return the samples of a figure that somebody draws, more slowly if they do not show it.

    :return: (n, 3) float64: x, y [m], time [s]
    """
    path = _path(figure, somebody, rng)
    if somebody.lag:
        path = strangers.sketched(path, figure, somebody, rng)
    path = _dense(path)
    if somebody.slant or somebody.warp:
        path = _distorted(path, somebody, rng)
    if not figure.smooth:
        path = _bowed(path, figure, somebody, rng)
    length = float(np.hypot(*np.diff(path, axis=0).T).sum())
    path = _smoothed(path, somebody.rounding / length * len(path))
    path = _with_hooks(path, somebody, rng)
    samples = _sampled(path, somebody, rng)
    for _ in range(_ATTEMPTS):
        if _show(samples, path * somebody.size + somebody.place, somebody):
            break
        somebody = replace(somebody, duration=1.5 * somebody.duration)
        samples = _sampled(path, somebody, rng)
    return samples


def _sampled(path: Floats, somebody: Hand, rng: Random) -> Floats:
    """Return the samples that arrive of a path of the pen, (n, 3) float64: x, y [m], time [s]."""
    here, times = _paced(path, somebody, rng)
    if somebody.lag:
        here = strangers.followed(here, times, somebody.lag)
        here = here + strangers.wandering(times, somebody.wander, rng)
    here = here + _wandering(times, somebody, rng)
    here = here * somebody.size + somebody.place
    if somebody.pixel:
        pixel = somebody.pixel * somebody.size
        here = np.round(here / pixel) * pixel
    return _received(np.column_stack((here, times)), somebody, rng)


def _show(samples: Floats, path: Floats, somebody: Hand) -> bool:
    """
    Return whether the line through samples shows the path: who sees a polygon drew no circle.

    The long first step of a finger does not count.
    """
    x, y = samples[:, :2].T
    along_x, along_y = np.diff(x), np.diff(y)
    away_x, away_y = path[:, :1] - x[:-1], path[:, 1:] - y[:-1]
    length = np.maximum(along_x**2 + along_y**2, 1e-12)
    share = np.clip((away_x * along_x + away_y * along_y) / length, 0.0, 1.0)
    off = np.sqrt(((away_x - share * along_x) ** 2 + (away_y - share * along_y) ** 2).min(axis=1))
    begun = np.hypot(*(path - path[0]).T) > somebody.first_step * somebody.size
    late = np.maximum.accumulate(begun)
    trembling = somebody.drift + somebody.tremor + somebody.noise + somebody.wander
    return bool(off[late].max(initial=0.0) <= (_SHOWN + 3.0 * trembling) * somebody.size)


def stroke(figure: Figure, rng: Random) -> Floats:
    """Return the samples of a figure that anybody draws."""
    return drawn(figure, hand(rng, figure), rng)


def _habit(rng: Random, low: float, high: float, half: str) -> float:
    """Return a number of a range that is cut into eight bands: every other one is a half's."""
    if half in {'apart', 'strangers'}:
        return float(rng.uniform(low, high))
    band = 2 * rng.integers(4) + (half == 'report')
    return float(low + (high - low) * (band + rng.random()) / 8)


def _pixel(rng: Random, thin: float, corners: float) -> float:
    """Return the size of a pixel, in shares of the size of a figure that its pixels show."""
    pixel = math.exp(rng.uniform(math.log(_FINEST), math.log(_COARSEST)))
    return min(pixel, thin / _PIXELS, 1.0 / corners / _PIXELS)


def turning(path: Floats) -> float:
    """Return the sum of the turns of a path [rad]."""
    steps = np.diff(path, axis=0)
    return float(np.abs(np.diff(np.unwrap(np.arctan2(steps[:, 1], steps[:, 0])))).sum())


def _closing(rng: Random, figure: Figure) -> float:
    """Return the share of a closed path that is missing (< 0), or drawn twice (> 0)."""
    gap, overlap = abs(rng.normal(0.0, 0.05)), abs(rng.normal(0.0, 0.1))
    missing, twice = (0.15, 0.25) if figure.smooth else (0.1, 0.12)
    return float(rng.choice([0.0, -min(gap, missing), min(overlap, twice)]))


def _often(rng: Random, chance: float, spread: float) -> float:
    """Return 0, or with some chance a length whose typical size is the spread."""
    return float(abs(rng.normal(0.0, spread))) if rng.random() < chance else 0.0


def _path(figure: Figure, somebody: Hand, rng: Random) -> Floats:
    """Return the path that the pen is to take: its beginning, direction and end."""
    path = figure.path / np.hypot(*np.ptp(figure.path, axis=0))
    if rng.random() < 0.5:
        path = path[::-1] if 'arrow' not in figure.kind else path
    if not figure.closed:
        return path
    path = np.roll(path, rng.integers(len(path)), axis=0)
    # Most begin at a corner, some in the middle of a side.
    if not figure.smooth and rng.random() < 0.25:
        share = rng.uniform(0.2, 0.8)
        path = np.vstack((path[0] + share * (path[1] - path[0]), path[1:], path[0]))
    path = np.vstack((path, path[:1]))
    length = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))))
    end = length[-1] * (1.0 + somebody.closing)
    if somebody.closing < 0:
        keep = length < end
        last = [np.interp(end, length, path[:, axis]) for axis in (0, 1)]
        path = np.vstack((path[keep], last))
    elif somebody.closing > 0:
        again = length[1:] < end - length[-1]
        last = [np.interp(end - length[-1], length, path[:, axis]) for axis in (0, 1)]
        path = np.vstack((path, path[1:][again], last))
    # The end misses the beginning more and more over the last third.
    angle = rng.uniform(0, 7)
    share = np.clip(np.linspace(-2.0, 1.0, len(path)), 0.0, 1.0)[:, None]
    path = path + somebody.slip * share * (math.cos(angle), math.sin(angle))
    return np.asarray(path * np.linspace(1.0, 1.0 - somebody.spiral, len(path))[:, None])


def _dense(path: Floats, count: int = 600) -> Floats:
    """Return points along a path, evenly spaced."""
    length = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))))
    at = np.linspace(0.0, length[-1], count)
    return np.column_stack([np.interp(at, length, path[:, axis]) for axis in (0, 1)])


def _distorted(path: Floats, somebody: Hand, rng: Random) -> Floats:
    """Return a path sheared, and moved by a smooth field of two waves."""
    path = path + somebody.slant * np.column_stack((path[:, 1], np.zeros(len(path))))
    waves = rng.normal(0.0, 4.0, (2, 2))
    phases = rng.uniform(0.0, 7.0, 2)
    return np.asarray(path + somebody.warp * np.sin(path @ waves + phases))


def _bowed(path: Floats, figure: Figure, somebody: Hand, rng: Random) -> Floats:
    """Bend what is straight: a wave about as long as the figure's sides."""
    waves = max(len(figure.path) / 2, 1.0) * rng.uniform(0.3, 1.0)
    share = np.linspace(0.0, 1.0, len(path))
    along = np.gradient(path, axis=0)
    along /= np.maximum(np.hypot(*along.T), 1e-12)[:, None]
    across = np.column_stack((-along[:, 1], along[:, 0]))
    # Across the path itself, but smoothly: at corners it turns at once.
    across = _smoothed(across, len(path) / 80)
    length = np.hypot(*np.diff(path, axis=0).T).sum() / max(len(figure.path), 2)
    swing = somebody.bow * length * np.sin(2 * math.pi * (waves * share + rng.random()))
    return np.asarray(path + swing[:, None] * across, dtype=np.float64)


def _smoothed(path: Floats, width: float) -> Floats:
    """Round the corners, by a width in points."""
    if width < 0.5:
        return path
    reach = math.ceil(3 * width)
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
    kernel /= kernel.sum()
    padded = np.vstack(
        (
            2 * path[0] - path[slice(1, reach + 1)][::-1],
            path,
            2 * path[-1] - path[slice(-1 - reach, -1)][::-1],
        )
    )
    return np.column_stack([np.convolve(padded[:, axis], kernel, 'valid') for axis in (0, 1)])


def _with_hooks(path: Floats, somebody: Hand, rng: Random) -> Floats:
    """Add the flicks of a pen that is set down before it rests, or lifted late."""
    parts = [path]
    for length, end, at in ((somebody.hook_down, 0, 0), (somebody.hook_up, 1, -1)):
        if length:
            angle = rng.uniform(0, 7)
            tip = path[at] + min(length, 0.08) * np.array([math.cos(angle), math.sin(angle)])
            flick = np.linspace(tip, path[at], 12, endpoint=False)
            parts.insert(0, flick) if end == 0 else parts.append(flick[::-1])
    return np.vstack(parts)


def _paced(path: Floats, somebody: Hand, rng: Random) -> tuple[Floats, Floats]:
    """Return the pen's places at even times, slow at corners, unsteady elsewhere."""
    step = np.diff(path, axis=0)
    heading = np.unwrap(np.arctan2(step[:, 1], step[:, 0]))
    turn = np.abs(np.gradient(heading))
    turn = np.convolve(turn, np.ones(15) / 15, 'same')
    turn /= max(turn.max(), 1e-9)
    slow = 1.0 - somebody.slowing * np.minimum(2.0 * turn, 1.0)
    share = np.linspace(0.0, 1.0, len(step))
    waves = rng.uniform(0.5, 4.0)
    slow *= 1.0 + somebody.unsteady * np.sin(2 * math.pi * (waves * share + rng.random()))
    # It starts and ends at rest.
    slow *= np.clip(np.minimum(share, 1.0 - share) * 12.0 + 0.3, 0.0, 1.0)
    spent = np.concatenate(([0.0], np.cumsum(np.hypot(*step.T) / np.maximum(slow, 0.05))))
    spent *= somebody.duration / spent[-1]
    times = np.arange(0.0, somebody.duration, 1.0 / somebody.rate)
    times[1:] += rng.uniform(-0.5, 0.5, len(times) - 1) * somebody.uneven / somebody.rate
    times = np.append(np.minimum(times, somebody.duration), somebody.duration)
    here = np.column_stack([np.interp(times, spent, path[:, axis]) for axis in (0, 1)])
    return here, times


def _received(samples: Floats, somebody: Hand, rng: Random) -> Floats:
    """Return the samples that arrive of those of a pen; the first and the last one do."""
    away = np.hypot(*(samples[:, :2] - samples[0, :2]).T)
    late = np.maximum.accumulate(away) >= somebody.first_step * somebody.size
    kept = late & (rng.random(len(samples)) >= somebody.dropped) if somebody.dropped else late
    kept[[0, -1]] = True
    if somebody.simplified:
        kept &= _simplified(samples[:, :2], somebody.simplified * somebody.size)
    times = samples[:, 2].copy()
    if somebody.first_step:
        # The screen reports the touch late, too: its first step takes no longer than others.
        times[0] = max(times[int(late.argmax())] - 1.0 / somebody.rate, times[0])
    # All samples of a batch have the time of its last one.
    last = -(-np.arange(len(times)) // somebody.batch) * somebody.batch
    times = times[np.minimum(last, len(times) - 1)]
    return np.column_stack((samples[:, :2], times))[kept]


def _simplified(points: Floats, tolerance: float) -> NDArray[np.bool_]:
    """Return which points the Ramer-Douglas-Peucker algorithm keeps."""
    kept = np.zeros(len(points), np.bool_)
    kept[[0, -1]] = True
    parts = [(0, len(points) - 1)]
    while parts:
        first, last = parts.pop()
        along, away = points[last] - points[first], points[slice(first, last + 1)] - points[first]
        share = np.clip(away @ along / max(float(along @ along), 1e-12), 0.0, 1.0)
        off = np.hypot(*(away - share[:, None] * along).T)
        far = int(off.argmax())
        if off[far] > tolerance:
            kept[first + far] = True
            parts += [(first, first + far), (first + far, last)]
    return kept


def _wandering(times: Floats, somebody: Hand, rng: Random) -> Floats:
    """Return the deviation of a hand: drift below 2 Hz, tremor about 9 Hz, white noise."""
    total = rng.normal(0.0, somebody.noise, (len(times), 2))
    for spread, low, high in ((somebody.drift, 0.2, 2.0), (somebody.tremor, 6.0, 12.0)):
        for axis in (0, 1):
            for frequency in rng.uniform(low, high, 4):
                swing = rng.normal(0.0, spread / 2.0)
                total[:, axis] += swing * np.sin(2 * math.pi * (frequency * times + rng.random()))
    return np.asarray(total, dtype=np.float64)
