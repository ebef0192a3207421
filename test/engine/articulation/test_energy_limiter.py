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

"""What nothing drives gains no energy; what something drives keeps all of it."""

from __future__ import annotations

import numpy as np
from physsim_ros.engine import joints
from physsim_ros.engine.articulation.energy_limiter import Balance
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Command, Join
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.world import World
import pytest

from ...building import pose, spawn, twist

FLOATING = WorldSettings(gravity=(0.0, 0.0))


def machine(kind: JointKind, *, b: str = 'a/1') -> tuple[World, Balance]:
    """Return a world of two joined bodies and a loose one, and a balance of it."""
    world = World(settings=FLOATING)
    spawn(world, 'a/0', Disc(radius=0.5), (0.0, 0.0, 0.0), mass=1.0)
    spawn(world, 'a/1', Disc(radius=0.5), (2.0, 0.0, 0.0), mass=3.0)
    spawn(world, 'a/2', Disc(radius=0.5), (9.0, 0.0, 0.0), mass=2.0)
    points = ((0.0, 0.0), (2.0, 0.0))[: kind.points]
    world.apply(Join(name='joint/0', kind=kind, points=points, a='a/0', b=b))
    space = world._space  # noqa: SLF001 - where the engine's bodies are
    rigids = list(space.bodies.values())
    background = space._space.static_body  # noqa: SLF001
    other = space.bodies.get(b)
    (joint,) = world.snapshot().scene.joints
    held = joints.build(joint, rigids[0], other, background, world.dt)
    places = {rigid.engine: place for place, rigid in enumerate(rigids)}
    return world, Balance([held], places, 3, gravity=(0.0, 0.0), dt=world.dt)


def state(*twists: tuple[float, float, float]) -> np.ndarray:
    poses = ((0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (9.0, 0.0, 0.0))
    bodies = [(*pose, *twist) for pose, twist in zip(poses, twists, strict=True)]
    return np.array([*bodies, (0.0,) * 6])


# The background, which comes last, has none.
MASS = np.array([1.0, 3.0, 2.0, 0.0])
MOMENT = MASS * 0.5**2 / 2
SLOW = ((0.0, 1.0, 0.5), (0.4, -1.0, 0.0), (1.0, 0.0, 0.0))
# Thrown apart: the momentum is that of SLOW.
FAST = ((0.0, 4.0, 48.5), (0.4, -2.0, 0.0), (1.0, 0.0, 0.0))


def energy(rows: np.ndarray) -> float:
    return float((MASS * (rows[:, 3] ** 2 + rows[:, 4] ** 2) + MOMENT * rows[:, 5] ** 2).sum() / 2)


def momentum(rows: np.ndarray) -> tuple[float, float, float]:
    x, y = (MASS @ rows[:, 3:5]).tolist()
    turning = rows[:, 0] * rows[:, 4] - rows[:, 1] * rows[:, 3]
    return x, y, float(MASS @ turning + MOMENT @ rows[:, 5])


def test_what_a_linkage_has_gained_is_taken_and_momentum_is_kept() -> None:
    _, balance = machine(JointKind.ROD)
    before, after = state(*SLOW), state(*FAST)
    assert not balance.limit_energy(before)
    kept = momentum(after)
    # The rigid part of the motion could not be slowed without its momentum.
    assert balance.limit_energy(after)
    assert momentum(after) == pytest.approx(kept, abs=1e-12)
    assert energy(before) <= energy(after) < energy(state(*FAST)) - 1.0
    assert after[2].tolist() == state(*FAST)[2].tolist()


def test_what_the_background_holds_is_slowed_as_a_whole() -> None:
    _, balance = machine(JointKind.ROD, b='world')
    before, after = state(*SLOW), state(FAST[0], *SLOW[1:])
    balance.limit_energy(before)
    assert balance.limit_energy(after)
    assert energy(after) == pytest.approx(energy(before), rel=1e-9)
    assert after[1:].tolist() == before[1:].tolist()


def test_what_is_lost_is_not_given_back_and_not_gained_again() -> None:
    _, balance = machine(JointKind.ROD, b='world')
    rest = state((0.0, 0.0, 0.0), *SLOW[1:])
    balance.limit_energy(state(*SLOW))
    assert not balance.limit_energy(rest)
    again = state(*SLOW)
    assert balance.limit_energy(again)
    assert energy(again) == pytest.approx(energy(rest), rel=1e-9)


def test_what_contacts_have_given_an_island_as_a_whole_is_taken_too() -> None:
    _, balance = machine(JointKind.ROD)
    rest = state((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), SLOW[2])
    balance.limit_energy(rest)
    # Both alike: nothing of it is motion against each other.
    thrown = state((3.0, 0.0, 0.0), (3.0, 0.0, 0.0), SLOW[2])
    assert balance.limit_energy(thrown)
    assert energy(thrown) == pytest.approx(energy(rest), rel=1e-9)


def test_a_balance_follows_another_of_the_same_bodies() -> None:
    _, before = machine(JointKind.ROD, b='world')
    _, after = machine(JointKind.ROD, b='world')
    before.limit_energy(state(*SLOW))
    after.follow(before)
    thrown = state(FAST[0], *SLOW[1:])
    assert after.limit_energy(thrown)
    assert energy(thrown) == pytest.approx(energy(state(*SLOW)), rel=1e-9)


def test_what_a_fresh_balance_has_not_seen_is_not_followed() -> None:
    _, before = machine(JointKind.ROD, b='world')
    _, after = machine(JointKind.ROD, b='world')
    after.follow(before)
    assert not after.limit_energy(state(*FAST))


def test_after_a_drive_all_is_kept() -> None:
    _, balance = machine(JointKind.ROD)
    balance.limit_energy(state(*SLOW))
    balance.drive()
    after = state(*FAST)
    assert not balance.limit_energy(after)
    assert after.tolist() == state(*FAST).tolist()


def test_a_motor_may_drive() -> None:
    _, balance = machine(JointKind.MOTOR)
    balance.limit_energy(state(*SLOW))
    assert not balance.limit_energy(state(*FAST))


def test_what_a_loose_body_gains_is_not_taken_from_a_linkage() -> None:
    _, balance = machine(JointKind.ROD)
    balance.limit_energy(state(*SLOW))
    after = state(*SLOW[:2], (30.0, 0.0, 0.0))
    assert not balance.limit_energy(after)
    assert after[2, 3] == 30.0


def test_what_one_gives_another_may_have() -> None:
    _, balance = machine(JointKind.ROD, b='world')
    balance.limit_energy(state((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (2.0, 0.0, 0.0)))
    struck = state((2.0 * 2**0.5, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    assert not balance.limit_energy(struck)


def test_a_joint_that_gave_way_comes_back() -> None:
    world = World(settings=FLOATING)
    spawn(world, 'a/0', Box(width=1.0, height=1.0), (0.0, 0.0, 0.0), mass=1.0)
    weak = JointProperties(max_force=10.0)
    world.apply(
        Join(name='j/0', kind=JointKind.AXLE, points=((0.0, 0.0),), a='a/0', properties=weak)
    )
    world.apply(Command(names=('a/0',), wrenches=((20.0, 0.0, 0.0),)))
    world.step(120)
    assert pose(world, 'a/0')[0] > 0.5
    world.step(2400)
    assert pose(world, 'a/0')[:2] == pytest.approx((0.0, 0.0), abs=0.01)
    assert twist(world, 'a/0')[:2] == pytest.approx((0.0, 0.0), abs=0.01)
