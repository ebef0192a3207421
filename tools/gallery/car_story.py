# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The story that the animation of the README tells, as frames."""

from __future__ import annotations

from test.worlds.digests import scene

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import MoveBodies, Spawn
from physsim_ros.model.shapes import Box
from physsim_ros.model.snapshot import Frame


def car_story() -> list[Frame]:
    """Return the frames of a car that drives on, goes back, and meets a wall that was moved."""
    simulation = scene('drawings/car')
    simulation.reports_contacts = True
    wall = Spawn(
        name='wall/0',
        shape=Box(width=0.3, height=1.7),
        pose=(11.0, 6.4, 0.0),
        color=(0.9, 0.3, 0.2, 1.0),
        properties=Properties(anchored=True),
    )
    frames: list[Frame] = []
    now = 0

    def run(count: int, speed: float) -> None:
        nonlocal now
        simulation.speed = speed
        for _ in range(count):
            now += 16_666_667
            frames.extend(simulation.advance(now))

    simulation.requests.submit(wall, topic='~/spawn')
    run(200, 1.0)
    run(65, -2.0)
    simulation.requests.submit(MoveBodies(names=('wall/0',), by=(0.0, -2.5)), topic='page')
    run(180, 1.0)
    return frames
