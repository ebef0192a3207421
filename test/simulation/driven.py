# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A simulation that tests drive by the time of a wall clock, and compare with what it showed."""

from __future__ import annotations

import numpy as np
from physsim_ros.model.requests import (
    Request,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Answer, Frame
from physsim_ros.simulation.simulation import Simulation

# Steps in a frame.
FRAME = 4
SECOND = 10**9
FLOOR = WorldSettings(bounds=(-10.0, 0.0, 10.0, 20.0))


class Driven:
    """A simulation, the time that it is handed, and what it showed of each step."""

    def __init__(self, **options: float) -> None:
        self.simulation = Simulation(settings=FLOOR, **options)
        self.now = 0
        self.shown: dict[int, Frame] = {}

    def run(self, speed: float, seconds: float) -> list[Frame]:
        """Run for seconds on the wall, and return the frames."""
        self.simulation.speed = speed
        frames: list[Frame] = []
        for _ in range(round(seconds * 60)):
            frames += self.tick()
        return frames

    def tick(self) -> tuple[Frame, ...]:
        """Go on by a tick of the node, and return its frames."""
        self.now += round(SECOND / 60)
        return self.simulation.advance(self.now)

    def record(self, seconds: float) -> None:
        for frame in self.run(1.0, seconds):
            self.shown[frame.snapshot.step] = frame

    def ask(self, request: Request, *, joined: bool = False) -> None:
        self.simulation.requests.submit(request, topic='~/test', joined=joined)

    def apply_requests(self) -> Frame:
        frame = self.simulation.apply_requests()
        assert frame is not None
        return frame

    @property
    def names(self) -> tuple[str, ...]:
        return self.simulation.world.snapshot().scene.names

    def assert_same(self, frame: Frame) -> None:
        before = self.shown[frame.snapshot.step].snapshot
        np.testing.assert_array_equal(frame.snapshot.poses, before.poses)
        np.testing.assert_array_equal(frame.snapshot.twists, before.twists)
        np.testing.assert_array_equal(frame.snapshot.forces, before.forces)


def told(frames: list[Frame], topic: str) -> list[Answer]:
    return [answer for frame in frames for answer in frame.answers if answer.topic == topic]
