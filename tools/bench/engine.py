# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The cost of a step and of a frame beside those of the bare engine, scene by scene."""

from __future__ import annotations

from collections.abc import Callable
import statistics

from physsim_ros.simulation.simulation import Simulation

from .bodies import Bare, cpu_time
from .scenes import FREE, MACHINES, Scene

# Frames of four steps that are measured in turn, and how often.
FRAMES, ROUNDS = 30, 8


def simulation_of(scene: Scene) -> Simulation:
    """Return a simulation without ROS in which a scene begins."""
    sim = Simulation()
    scene(sim)
    return sim


def _cpu(act: Callable[[], object], count: int) -> float:
    """Return the processor time of a call [µs], made so many times."""
    return 1e3 * cpu_time(lambda: [act() for _ in range(count)]) / count


def times(scene: Scene) -> tuple[float, float, float]:
    """
    Return the processor time of four steps of a scene [µs].

    :return: of Pymunk alone, of our steps, and of a frame, which has four steps; medians of rounds
        that take turns
    """
    framed, stepped = simulation_of(scene), simulation_of(scene).world
    bare = Bare(stepped)
    acts = (bare.frame, lambda: stepped.step(4), framed.advance_frame)
    costs = [[_cpu(act, FRAMES) for act in acts] for _ in range(ROUNDS)]
    one, two, three = (statistics.median(column) for column in zip(*costs, strict=True))
    return one, two, three


def table() -> None:
    """Print it."""
    print('\nProcessor time of 4 steps [µs], and in times of bare Pymunk; frame: with its output')
    print(f'{"":28} {"bare":>8} {"steps":>8} {"frame":>8}   {"steps":>6} {"frame":>6}')
    for name, scenes in (('free bodies', FREE), ('machines', MACHINES)):
        ratios = []
        for name_of_scene, scene in scenes.items():
            bare, steps, frame = times(scene)
            ratios.append((steps / bare, frame / bare))
            print(
                f'{name_of_scene:28} {bare:8.1f} {steps:8.1f} {frame:8.1f}   '
                f'{steps / bare:6.1f} {frame / bare:6.1f}'
            )
        medians = [statistics.median(column) for column in zip(*ratios, strict=True)]
        print(f'{"median of " + name:28} {"":26}   {medians[0]:6.1f} {medians[1]:6.1f}')
