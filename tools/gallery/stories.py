# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The stories that pictures tell: time goes back, and something is moved there."""

from __future__ import annotations

from test.worlds.digests import scene

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import MoveBodies, Spawn
from physsim_ros.model.shapes import Box
from physsim_ros.model.snapshot import Frame

# A robot drives along its path, on which a crate stands behind a shelf, seen from above.
YARD = """
format: 1
bounds: [-3.2, -1.8, 3.2, 1.8]
gravity: [0, 0]
floor_friction: 0.6
bodies:
  - {name: shelf/0, box: {width: 2.6, height: 0.5}, at: [-1.1, 0.5], anchored: true}
  - {name: shelf/1, box: {width: 2.6, height: 0.5}, at: [-1.1, -1.3], anchored: true}
  - {name: shelf/2, box: {width: 0.5, height: 1.5}, at: [2.5, 0.6], anchored: true}
  - {name: crate/0, box: {width: 0.42, height: 0.42}, at: [1, 0.1], mass: 60, color: '#d1495b'}
  - {name: barrel/0, circle: {radius: 0.16}, at: [0.7, -1.4], mass: 4, color: '#4c78a8'}
  - {name: barrel/1, circle: {radius: 0.16}, at: [1.1, -1.5], mass: 4, color: '#4c78a8'}
  - name: robot/0
    circle: {radius: 0.2}
    at: [-2.8, -0.4]
    mass: 6
    color: '#3b4252'
    robot:
      drive: {kind: differential, track: 0.3, max_speed: 0.8, max_turn: 3}
      sensors: [{kind: laser, name: scan, beams: 180, range: [0.1, 3.5], rate: 15}]
    actor:
      kind: path
      speed: 0.6
      points: [[-2.8, -0.4], [0.4, -0.4], [1, 0.1], [1.2, 1.3], [-2.6, 1.3]]
joints: []
"""
# Place of the crate, the vector by which it is moved [m], and the times
# at which time is turned, to which it goes back, and at the end [s].
CRATE, ASIDE = (1.0, 0.1), (0.6, -1.0)
CRASH_TURN, CRASH_BACK, CRASH_END = 7.6, 4.2, 13.0
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
