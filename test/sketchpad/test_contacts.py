# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Contacts on a page while time stands still."""

from __future__ import annotations

from physsim_ros.model.requests import Delete, MoveBodies
from physsim_ros.model.settings import WorldSettings
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.sketchpad.contacts import LastContacts

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
