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

"""What leans on a machine is carried by all of it: bridges, whatever rolls and lands on them."""

from __future__ import annotations

from functools import partialmethod
import math

import numpy as np
from physsim_ros.engine.articulation import contact_coupling
from physsim_ros.engine.batch_io import EngineArrays, Touching
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Axle, Join, Pin
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc, Shape
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.simulation.world import World
import pytest

from ...building import BOX, DISC, G, pose, spawn, swing, twist

PLANK = Box(width=1.1, height=0.2)
# Where planks have their upper sides [m].
DECK = 5.1


def bridge(joined: type[Pin | Axle], count: int = 10) -> World:
    """Return planks of 0.22 kg that overlap, between two blocks."""
    world = World()
    for number in range(count):
        spawn(world, f'plank/{number}', PLANK, (number + 0.5, 5.0, 0.0))
    for number, x in enumerate((-0.5, count + 0.5)):
        spawn(world, f'bank/{number}', Box(width=1.2, height=1.0), (x, 5.0, 0.0), anchored=True)
    for number in range(count + 1):
        world.apply(joined(point=(float(number), 5.0)))
    return world


def energy(snapshot: Snapshot) -> float:
    return snapshot.kinetic_energy + snapshot.potential_energy


def watched(world: World, name: str, seconds: float) -> tuple[float, float, float]:
    """Let it run; return how low and, after that, how high a body comes, and the most energy."""
    row = world.snapshot().scene.names.index(name)
    heights, energies = [], []
    for _ in range(round(60 * seconds)):
        world.step(4)
        snapshot = world.snapshot()
        heights.append(float(snapshot.poses[row, 1]))
        energies.append(energy(snapshot))
    lowest = int(np.argmin(heights))
    return heights[lowest], max(heights[lowest:]), max(energies)


@pytest.mark.parametrize('wait', [0, 1200])
@pytest.mark.parametrize('mass', [1.0, 60.0])
@pytest.mark.parametrize('shape', [DISC, BOX])
def test_a_beam_of_light_planks_carries_what_is_heavy(
    shape: Shape, mass: float, wait: int
) -> None:
    world = bridge(Pin)
    world.step(wait)
    spawn(world, 'load/0', shape, (5.0, 8.0, 0.0), mass=mass)
    began = energy(world.snapshot())
    lowest, _, most = watched(world, 'load/0', 4.0)
    # No deeper than anything lies on anything, and no energy from nowhere.
    assert lowest > DECK + 0.5 - 0.03
    assert most < began * (1.0 + 1e-3)
    x, y, _ = pose(world, 'load/0')
    assert y == pytest.approx(DECK + 0.5, abs=1e-3)
    # Where it has come to lie it stays.
    assert x == pytest.approx(5.0, abs=0.1)
    world.step(480)
    assert pose(world, 'load/0')[0] == pytest.approx(x, abs=2e-3)


@pytest.mark.parametrize('mass', [5.0, 20.0, 60.0])
def test_a_taut_bridge_throws_nothing_higher_than_it_fell(mass: float) -> None:
    world = bridge(Axle)
    spawn(world, 'load/0', DISC, (5.0, 8.0, 0.0), mass=mass)
    began = energy(world.snapshot())
    lowest, highest, most = watched(world, 'load/0', 6.0)
    assert lowest > 4.0
    assert highest < 7.0
    assert most < began + 0.02 * mass * G * (8.0 - DECK - 0.5)


def test_boxes_on_each_other_lie_on_a_beam() -> None:
    world = bridge(Pin)
    for number in range(3):
        spawn(world, f'load/{number}', BOX, (5.0, 5.61 + number, 0.0), mass=20.0)
    world.step(960)
    for number in range(3):
        assert pose(world, f'load/{number}')[1] == pytest.approx(5.6 + number, abs=0.02)


def test_a_car_drives_over_a_beam_as_on_the_ground() -> None:
    ways = []
    for world in (World(), bridge(Pin, 12)):
        if not len(world):
            spawn(world, 'ground/0', Box(width=40.0, height=1.0), (6.0, 4.6, 0.0), anchored=True)
        spawn(world, 'car/0', Box(width=2.0, height=0.4), (2.0, 5.6, 0.0), mass=30.0)
        for number, x in enumerate((1.2, 2.8)):
            spawn(world, f'wheel/{number}', Disc(radius=0.3), (x, 5.41, 0.0), mass=1.0)
            world.apply(
                Join(
                    name=f'motor/{number}',
                    kind=JointKind.MOTOR,
                    points=((x, 5.41),),
                    a=f'wheel/{number}',
                    b='car/0',
                    properties=JointProperties(rate=-5.0, max_torque=20.0),
                )
            )
        world.step(960)
        assert twist(world, 'car/0')[0] == pytest.approx(1.5, abs=0.01)
        ways.append(pose(world, 'car/0')[0] - 2.0)
    assert ways[1] == pytest.approx(ways[0], rel=0.03)


@pytest.mark.parametrize('radius', [0.16, 0.2, 0.3])
def test_a_ball_hung_by_links_that_it_overlaps_gains_nothing(radius: float) -> None:
    # What it touches and what it hangs on contradict each other, along a chain that does not give.
    world = swing(link=1.0, ball=1.0, radius=radius)
    began = energy(world.snapshot())

    _, _, most = watched(world, 'ball/0', 4.0)

    # Of 96 J that it falls through.
    assert most < began + 1.0


def test_what_bears_a_load_feels_it() -> None:
    world = bridge(Pin)
    spawn(world, 'load/0', BOX, (5.0, 5.6, 0.0), mass=20.0)
    world.step(480)
    # The half of the weight, and its moment about the end of a beam that is held at both.
    shear, moment = (20.0 + 10 * 0.22) * G / 2, (20.0 + 10 * 0.22 / 1.5) * G * 10.0 / 8
    forces = world.snapshot().forces
    assert shear < forces.max() < 3.0 * math.hypot(shear, moment)


def test_momentum_of_what_floats_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    carry, carried = contact_coupling.Loads.carry, []
    monkeypatch.setattr(
        contact_coupling.Loads, 'carry', lambda *all_: carried.append(carry(*all_)) or carried[-1]
    )
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    for number in range(12):
        spawn(world, f'plank/{number}', PLANK, (number + 0.5, 0.0, 0.0))
    for number in range(1, 12):
        world.apply(Pin(point=(float(number), 0.0)))
    # Where there is a motor, no energy is taken out, nor momentum with it.
    spawn(world, 'wheel/0', DISC, (0.5, 2.0, 0.0))
    motor = JointProperties(rate=0.0)
    world.apply(
        Join(name='j/0', kind=JointKind.MOTOR, points=((0.5, 2.0),), a='wheel/0', properties=motor)
    )
    spawn(world, 'load/0', DISC, (5.3, 0.8, 0.0), mass=500.0, velocity=(0.3, -5.0))
    before, began = world.snapshot().momentum, energy(world.snapshot())
    for _ in range(60):
        world.step(4)
        assert energy(world.snapshot()) < began * (1.0 + 1e-9)
    assert any(carried)
    assert world.snapshot().momentum == pytest.approx(before, abs=1e-9)
    assert twist(world, 'plank/5')[1] < -1.0


def test_the_order_in_which_contacts_are_listed_changes_no_bit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    listed = EngineArrays.touching

    def otherwise(arrays: EngineArrays, pick: np.random.Generator) -> Touching:
        touching = listed(arrays)
        order = pick.permutation(len(touching.bodies))
        turned = pick.integers(0, 2, len(order)).astype(bool)
        touching = Touching(*(each[order] for each in touching))
        touching.bodies[turned] = touching.bodies[turned, ::-1]
        touching.normals[turned] *= -1.0
        return touching

    digests = set()
    for seed in range(3):
        pick = np.random.default_rng(seed)
        monkeypatch.setattr(EngineArrays, 'touching', partialmethod(otherwise, pick=pick))
        world = bridge(Axle)
        for number in range(3):
            spawn(world, f'load/{number}', BOX, (4.0 + number, 6.0 + number, 0.0), mass=9.0)
        world.step(240)
        digests.add(world.digest())
    assert len(digests) == 1


@pytest.mark.parametrize('seed', range(20))
def test_pushes_are_the_least_that_leave_nothing_short(seed: int) -> None:
    pick = np.random.default_rng(seed)
    count = int(pick.integers(1, 30))
    # Some say the same as others.
    rows = pick.normal(size=(count, max(1, count - 2)))
    shared, short = rows @ rows.T, pick.normal(size=count)
    # What others can make up, as what bodies do.
    short = rows @ np.linalg.lstsq(rows, short, rcond=None)[0]
    given = contact_coupling._least(shared, short)  # noqa: SLF001 - by itself
    left = short - shared @ given
    assert (given >= 0.0).all()
    assert left.max() < 1e-5
    assert given @ np.abs(left) < 1e-5 * max(1.0, float(given.sum()))
