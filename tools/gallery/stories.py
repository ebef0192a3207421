# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The story that an animation tells, as frames: time goes back, and something is moved there."""

from __future__ import annotations

from test.worlds.digests import scene

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import MoveBodies, Spawn
from physsim_ros.model.shapes import Box
from physsim_ros.model.snapshot import Frame

# Period of the frames [ns].
_PERIOD = 16_666_667


def car_story() -> list[Frame]:
    """Return the frames of a car that drives on, goes back, and meets a wall that was moved."""
    story = _Story('drawings/car', Box(width=0.3, height=1.7), (11.0, 6.4))
    story.run(200, 1.0)
    story.run(65, -2.0)
    story.move_obstacle(0.0, -2.5)
    story.run(180, 1.0)
    return story.frames


class _Story:
    """
    A world with a red obstacle.

    :ivar simulation: that plays it
    :ivar frames: so far
    """

    def __init__(self, name: str, obstacle: Box, at: tuple[float, float]) -> None:
        self.simulation = scene(name)
        self.simulation.reports_contacts = True
        self.frames: list[Frame] = []
        self._now = 0
        spawn = Spawn(
            name='wall/0',
            shape=obstacle,
            pose=(*at, 0.0),
            color=(0.9, 0.3, 0.2, 1.0),
            properties=Properties(anchored=True),
        )
        self.simulation.requests.submit(spawn, topic='~/spawn')

    def run(self, count: int, speed: float) -> None:
        """Play some periods at a speed."""
        self.simulation.speed = speed
        for _ in range(count):
            self._now += _PERIOD
            self.frames.extend(self.simulation.advance(self._now))

    def move_obstacle(self, x: float, y: float) -> None:
        """Move the obstacle by some metres, at the moment that is shown."""
        move = MoveBodies(names=('wall/0',), by=(x, y))
        self.simulation.requests.submit(move, topic='page')
