# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A node among disturbances makes the run that it makes alone, to the bit."""

from __future__ import annotations

from contextlib import suppress
import random

from diagnostic_msgs.msg import DiagnosticStatus
from physsim_ros.ros.node_without_qos_events import NodeWithoutQosEvents
from physsim_ros.testing import messages, Refused
import pytest
from rclpy.parameter import Parameter
from sensor_msgs.msg import MultiDOFJointState

from ..slow import slow

psutil = pytest.importorskip('psutil')

GESTURES = 12


def gesture(physsim, number):
    """Carry out one of the requests that both runs have, and go on for a while."""
    physsim.spawn(messages.disc(f'ball/{number}', at=(number % 5 - 2.0, 6.0), diameter=0.5))
    if number % 3 == 2:
        physsim.command(messages.command(f'ball/{number - 1}', twists=[(3.0, 2.0, 5.0)]))
    if number == 3:
        physsim.anchor(tuple(physsim.pose('ball/0'))[:2])
    physsim.run(0.4)
    return physsim.digest()


class Disturber:
    """Disturbances of a node by others, which change nothing in the end."""

    def __init__(self, physsim, client, seed):
        self.physsim, self.client, self.random = physsim, client, random.Random(seed)
        self.deaf = []

    def close(self):
        for node in self.deaf:
            node.destroy_node()

    def disturb(self):
        kinds = (
            self.visit_the_past,
            self.undo_and_redo,
            self.refuse,
            self.listen_and_stop,
            self.change_viewers,
            self.kill_viewers,
            self.read,
        )
        self.random.choice(kinds)()

    def visit_the_past(self):
        here = self.physsim.time
        for _ in range(3):
            self.physsim.seek(self.random.uniform(0.0, here))
        self.physsim.seek(here)

    def undo_and_redo(self):
        assert self.client.call('~/undo').success
        self.physsim.step(self.random.randrange(10))
        assert self.client.call('~/redo').success

    def refuse(self):
        with pytest.raises(Refused):
            self.physsim.spawn(messages.box('ball/0', size=(-1.0, 1.0)))
        with pytest.raises(Refused):
            self.physsim.command(messages.command('nobody/0', twists=[(0.0, 0.0, 0.0)]))

    def listen_and_stop(self):
        # Nothing ever spins it.
        node = NodeWithoutQosEvents(f'deaf_{len(self.deaf)}', context=self.physsim.context)
        node.create_subscription(
            DiagnosticStatus, '/physsim/events', lambda _: None, self.client.qos
        )
        self.deaf.append(node)

    def change_viewers(self):
        for viewer in ('web', 'none', 'web'):
            self.physsim.node.set_parameters([Parameter('viewer', value=viewer)])

    def kill_viewers(self):
        for child in psutil.Process().children():
            with suppress(psutil.NoSuchProcess):
                child.kill()

    def read(self):
        self.client.listen(MultiDOFJointState, '~/contacts')


@pytest.mark.parametrize('seed', [0, slow(1), slow(2)])
def test_a_disturbed_node_makes_the_run_that_it_makes_alone(physsim, client, seed):
    physsim.load('demo')
    alone = [gesture(physsim, number) for number in range(GESTURES)]
    assert client.call('~/reset').success
    disturber = Disturber(physsim, client, seed)

    for number, digest in enumerate(alone):
        assert gesture(physsim, number) == digest
        disturber.disturb()
        assert physsim.digest() == digest

    disturber.close()
    assert 'divergence' not in {event.code for event in client.events}
