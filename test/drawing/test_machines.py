# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The drawings that are shipped are machines, built by strokes alone, and they run."""

from __future__ import annotations

import math

import numpy as np
from physsim_ros.drawing.session import DrawingSession
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.files import find_drawing, load_drawing
from physsim_ros.model.arrays import Floats
from physsim_ros.simulation.simulation import Simulation
import pytest

G = 9.81
# How far hands go astray, as a share of what they draw, and at most of a metre.
HANDS = {'ruler': 0.0, 'steady': 0.01, 'shaky': 0.02}


class Machine:
    """A world into which a drawing has been drawn while it stood."""

    def __init__(self, name: str, tremor: float = 0.0) -> None:
        self.simulation = Simulation(speed=0.0)
        self._pen = DrawingSession(DrawingSettings())
        self._random = np.random.default_rng(7)
        self.read: list[str] = []
        self.frame = self.simulation.advance_frame()
        for stroke in load_drawing(find_drawing(name)):
            self._draw(stroke, tremor)

    def _draw(self, stroke: Floats, tremor: float) -> None:
        shaken = stroke.copy()
        # A hand does not jump: what it does in ten samples hangs together.
        noise = self._random.normal(size=(len(stroke) + 9, 2))
        drift = [np.convolve(column, np.ones(10) / math.sqrt(10), 'valid') for column in noise.T]
        extent = min(float(np.ptp(stroke[:, :2], axis=0).max()), 1.0)
        shaken[:, :2] += tremor * extent * np.column_stack(drift)
        reading = self._pen.stroke(shaken, '', self.frame.snapshot)
        self.read.append(str(reading.meaning))
        for request in reading.requests:
            self.simulation.submit(request, topic='~/stroke')
        frame = self.simulation.settle()
        assert frame is not None
        assert all(answer.code == '' for answer in frame.answers), frame.answers
        self.frame = frame

    def run(self, seconds: float) -> Floats:
        """Go on, and return poses, (frames, bodies, 3) float64 [m, rad]."""
        poses = []
        for _ in range(round(60 * seconds)):
            frame = self.simulation.advance_frame()
            assert frame.answers == ()
            poses.append(frame.snapshot.poses)
        return np.array(poses)

    @property
    def joints(self) -> list[tuple[str, str, str]]:
        """Return kind and bodies of all joints."""
        scene = self.simulation.world.snapshot().scene
        return [(str(joint.kind), joint.a, joint.b) for joint in scene.joints]


def distances(poses: Floats, first: int, second: int) -> Floats:
    return np.hypot(*(poses[:, first, :2] - poses[:, second, :2]).T)


def period(values: Floats) -> float:
    """Return the mean time between passages upwards through the mean, at 60 Hz [s]."""
    above = values - values.mean()
    passed = np.flatnonzero((above[:-1] < 0) & (above[1:] >= 0))
    exact = passed + above[passed] / (above[passed] - above[passed + 1])
    return float(np.diff(exact).mean() / 60)


@pytest.fixture(params=HANDS)
def tremor(request: pytest.FixtureRequest) -> float:
    """Give how much a hand trembles [m]."""
    return HANDS[request.param]


def test_a_car_rolls_down_its_road(tremor: float) -> None:
    car = Machine('car', tremor)
    assert car.read == ['wall', 'rectangle', 'disc', 'disc', 'axle', 'axle']
    assert car.joints == [('axle', 'drawn/2', 'drawn/1'), ('axle', 'drawn/3', 'drawn/1')]
    _, body, rear, front = range(4)

    poses = car.run(3.0)

    way = poses[-1, body, 0] - poses[0, body, 0]
    # m; at the bottom of the slope it has a speed of 5 m/s
    assert way > 6.0
    # The wheels turn with the road, up to slip and the slope's longer way; they stay on the car.
    for wheel in (rear, front):
        turned = poses[0, wheel, 2] - poses[-1, wheel, 2]
        assert 0.6 * turned == pytest.approx(way, rel=0.1)
        apart = distances(poses, body, wheel)
        assert np.ptp(apart) < 0.01
    # It never lies on its body: that is as high above the road as at the beginning.
    assert distances(poses, rear, front) == pytest.approx(2.0, abs=0.08)


def test_a_pendulum_swings_with_its_period(tremor: float) -> None:
    pendulum = Machine('pendulum', tremor)
    assert pendulum.read == ['wall', 'disc', 'rod']
    assert pendulum.joints == [('rod', 'drawn/1', 'drawn/0')]
    _, bob = range(2)

    poses = pendulum.run(12.0)

    places = poses[:, bob, :2]
    pivot = np.array((places[:, 0].min() + places[:, 0].max(), 0.0)) / 2
    pivot[1] = 7.98
    arm = np.hypot(*(places - pivot).T)
    # m: it was drawn by hand from (8, 7.98) to the bob
    assert np.ptp(arm) < 0.3
    length = float(arm.mean())
    swing = math.asin(float(np.ptp(places[:, 0])) / 2 / length)
    # The period by the arithmetic-geometric mean.
    a, b = 1.0, math.cos(swing / 2)
    for _ in range(5):
        a, b = (a + b) / 2, math.sqrt(a * b)
    exact = 2 * math.pi * math.sqrt(length / G) / a
    assert period(places[:, 0]) == pytest.approx(exact, rel=0.02)


def test_a_mass_on_a_spring_goes_up_and_down(tremor: float) -> None:
    machine = Machine('spring_and_mass', tremor)
    assert machine.read == ['wall', 'rectangle', 'spring']
    assert machine.joints == [('spring', 'drawn/1', 'drawn/0')]
    _, mass = range(2)
    weight = machine.simulation.world.snapshot().scene.bodies[mass].total_mass
    stiffness = 100.0
    before = machine.frame.snapshot.poses[mass, 1]

    heights = machine.run(6.0)[:, mass, 1]

    assert period(heights) == pytest.approx(2 * math.pi * math.sqrt(weight / stiffness), rel=0.03)
    # About where the spring bears the weight.
    assert heights.mean() == pytest.approx(before - weight * G / stiffness, abs=0.03)


def test_a_seesaw_goes_down_where_the_heavier_one_sits(tremor: float) -> None:
    seesaw = Machine('seesaw', tremor)
    assert seesaw.read == ['wall', 'rectangle', 'axle', 'rectangle', 'rectangle']
    assert seesaw.joints == [('axle', 'drawn/1', 'world')]
    _, plank, heavy, light = range(4)

    poses = seesaw.run(1.0)

    # Counter-clockwise, down on the left.
    assert poses[-1, plank, 2] > 0.4
    assert poses[-1, heavy, 1] < 3.0
    assert poses[-1, light, 1] > 4.0
    # m: its axle holds it
    assert np.ptp(poses[:, plank, :2], axis=0).max() < 0.05
