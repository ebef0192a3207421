# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Contacts on a page while time stands still."""

from __future__ import annotations

from physsim_ros.model.requests import Configure, Delete, MoveBodies
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.sketchpad.contacts import LastContacts
import pytest

from ..building import BOX, spawn, spawning

YARD = WorldSettings(bounds=(-20.0, 0.0, 20.0, 40.0))


def touching(simulation: Simulation, kept: LastContacts) -> set[str]:
    """Return the names of the bodies that touch anything, as a page would show them."""
    frame = simulation.apply_requests()
    assert frame is not None
    completed = kept.completed(frame)
    assert completed.contacts is not None
    names = completed.snapshot.scene.names
    return {names[row] for row in completed.contacts.pairs[:, 0]}


def test_bodies_that_stay_keep_their_contacts_and_others_lose_them() -> None:
    simulation = Simulation(settings=YARD)
    for number in range(3):
        spawn(simulation.world, f'a/{number}', BOX, (3.0 * number, 0.5, 0.0))
    simulation.reports_contacts = True
    kept = LastContacts(simulation.forces_now)
    for _ in range(60):
        kept.completed(simulation.advance_frame())
    simulation.speed = 0.0

    assert touching(simulation, kept) == {'a/0', 'a/1', 'a/2'}
    simulation.perform(MoveBodies(names=('a/1',), by=(0.0, 4.0)))
    assert touching(simulation, kept) == {'a/0', 'a/2'}
    simulation.perform(Delete(name='a/0'))
    assert touching(simulation, kept) == {'a/2'}
    # A body that is put onto the floor stands on it at once.
    simulation.perform(spawning('b/0', BOX, (12.0, 0.5, 0.0)))
    assert touching(simulation, kept) == {'a/2', 'b/0'}
    simulation.perform(MoveBodies(names=('b/0',), by=(0.0, 4.0)))
    assert touching(simulation, kept) == {'a/2'}


def test_a_world_that_has_not_stepped_has_the_forces_of_media_and_attraction() -> None:
    simulation = Simulation(settings=YARD)
    pool = {'anchored': True, 'sensor': True, 'medium': {'density': 2.0}}
    spawn(simulation.world, 'pool/0', Box(width=30.0, height=10.0), (0.0, 20.0, 0.0), **pool)
    spawn(simulation.world, 'a/0', BOX, (0.0, 20.0, 0.0), density=3.0, charge=2.0)
    spawn(simulation.world, 'b/0', BOX, (4.0, 20.0, 0.0), density=3.0, charge=1.0)
    simulation.reports_contacts = True
    simulation.speed = 0.0
    kept = LastContacts(simulation.forces_now)

    def fields() -> list[list[float]]:
        frame = simulation.apply_requests()
        assert frame is not None
        shown: list[list[float]] = kept.completed(frame).snapshot.fields[1:].tolist()
        return shown

    buoyancy = 2.0 * BOX.width * BOX.height * 9.81
    assert fields() == [pytest.approx((0.0, buoyancy), rel=1e-3, abs=1e-3)] * 2
    simulation.perform(Configure(changes={'coulomb': 8.0}))
    # 8 · 2 · 1 / 4² N.
    a, b = fields()
    assert a == pytest.approx((-1.0, buoyancy), rel=1e-3)
    assert b == pytest.approx((1.0, buoyancy), rel=1e-3)
