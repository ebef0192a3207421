# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The past shows the contacts that were shown, and a paused world those of its last steps."""

import numpy as np
from physsim_ros.model.requests import Command, Configure, Spawn
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.simulation import Simulation
import pytest

PERIOD_NS = round(1e9 / 60)


def test_contacts_of_the_past_are_those_shown_where_a_request_woke_bodies():
    simulation = Simulation(history=60.0)
    simulation.reports_contacts = True
    simulation.requests.submit(Configure(changes={'bounds': (-5.0, 0.0, 5.0, 12.0)}), topic='')
    for number in range(6):
        box, pose = Box(width=0.5, height=0.5), (number * 0.5 - 3.0, 0.25, 0.0)
        simulation.requests.submit(Spawn(name=f'box/{number}', shape=box, pose=pose), topic='')
    ball = Spawn(name='ball/0', shape=Disc(radius=0.3), pose=(3.0, 2.0, 0.0))
    simulation.requests.submit(ball, topic='')
    now, shown = 0, {}

    def run(frames):
        nonlocal now
        for _ in range(frames):
            now += PERIOD_NS
            for frame in simulation.advance(now):
                rows = np.column_stack(
                    (frame.contacts.pairs, frame.contacts.points, frame.contacts.normals)
                )
                rows = sorted(map(tuple, rows.round(6).tolist()))
                if frame.moved:
                    assert shown.setdefault(frame.snapshot.step, rows) == rows

    # The row is asleep, and the request wakes it.
    run(150)
    simulation.requests.submit(Command(names=('box/2',), twists=((0.0, 0.5, 0.0),)), topic='')
    simulation.apply_requests()
    run(60)
    # Nothing that was shown is kept: the past is simulated again.
    simulation.past.frames.drop_from(0)
    simulation.speed = -1.0
    run(200)


@pytest.mark.parametrize(
    ('first', 'second'), [('speed', 'reports_contacts'), ('reports_contacts', 'speed')]
)
def test_a_paused_world_has_the_contacts_of_its_last_steps_once_they_are_reported(first, second):
    simulation = Simulation()
    simulation.perform(Configure(changes={'bounds': (-5.0, 0.0, 5.0, 12.0)}))
    simulation.perform(Spawn(name='box/0', shape=Box(width=1.0, height=1.0), pose=(0.0, 0.5, 0.0)))
    for _ in range(60):
        assert simulation.advance_frame().contacts is None
    step, digest = simulation.step, simulation.world.digest()

    for name in (first, second):
        setattr(simulation, name, {'speed': 0.0, 'reports_contacts': True}[name])
        frame = simulation.apply_requests()

    assert frame.contacts.steps == simulation.frame_steps
    assert len(frame.contacts.pairs) == 1
    assert not frame.moved
    assert (simulation.step, simulation.world.digest()) == (step, digest)
    simulation.reports_contacts = False
    assert simulation.apply_requests() is None
