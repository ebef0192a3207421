# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A simulation that tests drive by the time of a wall clock, and compare with what it showed."""

from pathlib import Path
from typing import Any

import numpy as np
from physsim_ros.files import load_world, save_world
from physsim_ros.model.answer import Answer
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import ChangeBody, Request, Restore, Spawn
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc, Shape
from physsim_ros.model.snapshot import Frame
from physsim_ros.simulation.entries import Origin, TakeBack
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.ticks import TickLimits
from physsim_ros.simulation.world import World
import pytest

from ..building import BOX, spawning

# Steps in a frame.
FRAME = 4
SECOND = 10**9
# Each call is overdue at once.
OVERDUE = TickLimits(is_overdue=lambda: True)
FLOOR = WorldSettings(bounds=(-10.0, 0.0, 10.0, 20.0))
SLAB = spawning('floor/0', Box(width=40.0, height=1.0), (0.0, -0.5, 0.0), anchored=True)


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
        return self.simulation.apply_requests()

    @property
    def moment(self) -> tuple[int, str]:
        """Return the step and the digest."""
        return self.simulation.step, self.simulation.world.digest()

    @property
    def names(self) -> tuple[str, ...]:
        return self.simulation.world.snapshot().scene.names

    def assert_same(self, frame: Frame) -> None:
        before = self.shown[frame.snapshot.step].snapshot
        np.testing.assert_array_equal(frame.snapshot.poses, before.poses)
        np.testing.assert_array_equal(frame.snapshot.twists, before.twists)
        np.testing.assert_array_equal(frame.snapshot.forces, before.forces)


def dropped(name: str = 'a/0', height: float = 5.0, **options: float) -> Driven:
    """Return a world in which a box is about to fall from a height [m]."""
    driven = Driven(**options)
    driven.ask(spawning(name, BOX, (0.0, height, 0.0)))
    return driven


def told(frames: list[Frame], topic: str) -> list[Answer]:
    return [answer for frame in frames for answer in frame.answers if answer.topic == topic]


def world_after(*timed: tuple[int, str, Request], frames: int = 60) -> Simulation:
    """Return a world in which people asked for requests before the frame of a number."""
    simulation = Simulation(settings=FLOOR)
    for frame in range(frames):
        for at, author, request in timed:
            if at == frame:
                simulation.requests.submit(request, Origin('t', author=author))
        simulation.advance_frame()
    return simulation


def take_back(simulation: Simulation, author: str) -> Answer:
    """Have the last gesture of a person be taken back, and return the answer."""
    simulation.requests.submit(TakeBack(), Origin('~/undo', author=author))
    simulation.applier.apply_all()
    (answer,) = (each for each in simulation.applier.take_answers() if each.topic == '~/undo')
    return answer


def seen_from_above() -> World:
    """Return a world in which robots and people move on a floor."""
    settings = WorldSettings(gravity=(0.0, 0.0), floor_friction=0.5, seed=3)
    return World(settings=settings)


def body_request(name: str, x: float = 0.0, shape: Shape | None = None, **said: Any) -> Spawn:
    """Return the request for a body at a place on the x axis, by default a disc."""
    shape = shape or Disc(radius=0.1)
    return Spawn(name=name, shape=shape, pose=(x, 0.0, 0.0), properties=Properties(**said))


def put(world: World, name: str, x: float = 0.0, **said: Any) -> None:
    """Spawn a body of `body_request`."""
    world.apply(body_request(name, x, **said))


def changing(name: str, **said: Any) -> ChangeBody:
    """Return the request for other properties of a body."""
    return ChangeBody(name=name, properties=Properties(**said))


def twins(world: World, folder: Path) -> tuple[World, World]:
    """Return a world that begins with the state of another, and one that begins with its file."""
    path = save_world(world.save(), 'saved', world_dir=folder, physics_rate=world.physics_rate)
    one, other = seen_from_above(), seen_from_above()
    one.apply(Restore(state=world.save()))
    other.apply(Restore(state=load_world(path, physics_rate=world.physics_rate)))
    return one, other


def refusal_of_file(folder: Path, *bodies: str) -> Refusal:
    """Return the refusal of a world file with bodies, one line each."""
    path = folder / 'world.yaml'
    path.write_text('\n  - '.join(('format: 1\nbodies:', *bodies)))
    with pytest.raises(Refusal) as caught:
        load_world(path)
    assert caught.value.code == 'bad_world_file'
    return caught.value


def assert_refused(world: World, request: Request, refusal: type[Refusal], field: str) -> None:
    """Assert that a request is refused by the name of a field, and changes nothing."""
    before = world.digest()
    with pytest.raises(refusal) as caught:
        world.apply(request)
    assert caught.value.field == field
    assert world.digest() == before
