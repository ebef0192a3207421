# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The cost of going back: time of a seek and of a checkpoint, size of the past."""

from __future__ import annotations

import gc
import random
import statistics

from physsim_ros.simulation.simulation import Simulation

from .bodies import fill, timed

SEEKS = 9
# Simulated time before the seeks, by count of bodies [s].
LENGTHS = {100: 120, 1000: 30}


def measure(count: int, seconds: int) -> None:
    """Print a row for a count of bodies."""
    simulation = Simulation()
    fill(simulation.world, count)
    gc.collect()
    gc.freeze()
    history = simulation.past.line
    frames, stalls = [], []
    for _ in range(60 * seconds):
        before = history.keyframes[-1]
        took = timed(simulation.advance_frame)
        (frames if history.keyframes[-1] is before else stalls).append(took)
    head, oldest = history.head, history.oldest
    usual = statistics.median(frames)
    bytes_kept = sum(each.size for each in history.keyframes)
    rng = random.Random(count)
    print(
        f'{count:6} {usual:10.2f} {statistics.median(stalls) - usual:12.1f}'
        f' {bytes_kept / seconds * 60 / 1e6:14.2f} {simulation.past.frames.size / 1e6:12.1f}',
        end='',
    )
    for distance in (1, 10, seconds):
        steps = [
            max(oldest, head - round(rng.uniform(0.5, 1.0) * distance * 240)) for _ in range(SEEKS)
        ]
        times = []
        for step in steps:
            simulation.seek(round(head / 240 * 1e9))
            times.append(timed(lambda step=step: simulation.seek(round(step / 240 * 1e9))))
        print(f'   {statistics.median(times):5.0f} {max(times):5.0f}', end='')
    print(f'   ({seconds} s)', flush=True)
    gc.unfreeze()


def table() -> None:
    """Print a row for each count of bodies."""
    print('Going back in the history of a settled pile; seek: median and longest [ms]')
    print(
        'bodies frame [ms] checkpoint [ms] checkpoints [MB/min] frames [MB]  seek 1 s   10 s   all'
    )
    for count, seconds in LENGTHS.items():
        measure(count, seconds)
