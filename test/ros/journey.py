# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A world over ROS whose wall clock a test turns, and the frames that it showed."""

from __future__ import annotations

from hashlib import blake2b
import random
import struct

from physsim_ros.simulation.entries import Origin
from physsim_ros.testing import box, command, delete, disc, PhysSim, point, polygon
import pytest
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import MarkerArray

from ..building import ELL
from ..client import Client, Event, set_parameter, stamp_of, succeeded

# A frame at speed 1 [ns]; stamps are whole nanoseconds.
PERIOD = 1e9 / 60.0
STEP = 1e9 / 240.0
SECOND = 1_000_000_000


def frame_of(message: MultiDOFJointState) -> tuple[int, str]:
    """Return the stamp [ns] of a frame, and a hash of every name and number in it."""
    numbers = []
    for way, twist in zip(message.transforms, message.twist, strict=True):
        spot, turn = way.translation, way.rotation
        numbers += [spot.x, spot.y, spot.z, turn.x, turn.y, turn.z, turn.w]
        numbers += [twist.linear.x, twist.linear.y, twist.angular.z]
    content = ' '.join(message.joint_names).encode() + struct.pack(f'<{len(numbers)}d', *numbers)
    return stamp_of(message), blake2b(content, digest_size=8).hexdigest()


def clock_of(stamp: float) -> Clock:
    message = Clock()
    message.clock.sec, message.clock.nanosec = divmod(round(stamp), SECOND)
    return message


class Journey:
    """A world whose time goes as a clock on the wall has it, which the test turns."""

    def __init__(self, physsim: PhysSim, client: Client) -> None:
        self.physsim = physsim
        self.client = client
        self.states = client.listen(MultiDOFJointState, '~/states')
        self.clocks = client.listen(Clock, '/clock')
        # The last frame of each stamp, when it was shown the first time.
        self.first: dict[int, str] = {}
        self._now = 1e12
        self._shown = 0
        self.tick()

    def tick(self, periods: int = 1) -> list[tuple[int, str]]:
        """Let wall time go by, and return the frames that were shown."""
        for _ in range(periods):
            # Messages that were sent arrive before it.
            self.physsim.settle()
            self._now += PERIOD
            self.physsim.node.tick(round(self._now))
            # All that is shown goes out before more wall time goes by.
            self.physsim.node.loop.apply_requests()
        return self.shown()

    def shown(self) -> list[tuple[int, str]]:
        """Return the frames that were shown since the last call."""
        self.physsim.settle()
        begin, self._shown = self._shown, len(self.states)
        return [frame_of(message) for message in self.states[begin:]]

    def live(self, frames: int, seed: int = 1) -> None:
        """Let it run at speed 1, disturbed at random, and keep what is shown."""
        chance = random.Random(seed)
        set_parameter(self.physsim, 'bounds', [-5.0, 0.0, 5.0, 12.0])
        for number in range(frames):
            if chance.random() < 0.4:
                self._disturb(chance, number)
            self.first |= dict(self.tick())
        self.pause()

    def _disturb(self, chance: random.Random, number: int) -> None:
        names, publish = self.physsim.node.frame.snapshot.scene.names, self.client.publish
        kind = chance.choice(['disc', 'box', 'array'] * 2 + ['gravity', 'damping', 'iterations'])
        if len(names) > 4 and chance.random() < 0.5:
            kind = chance.choice(['delete', 'anchor', 'release', 'pose', 'twist', 'wrench'])
        at = (chance.uniform(-3.0, 3.0), chance.uniform(2.0, 9.0), chance.uniform(-3.0, 3.0))
        name = chance.choice(names) if names else ''
        match kind:
            case 'disc':
                publish('~/spawn', disc(f'disc/{number}', at=at, diameter=chance.uniform(0.3, 1)))
            case 'box':
                publish('~/spawn', box(f'box/{number}', at=at, lifetime=chance.choice((0, 0.5))))
            case 'array':
                more = (
                    box(f'a/{number}', at=at),
                    polygon(f'b/{number}', outline=ELL.outline, at=at),
                )
                publish('~/spawn_array', MarkerArray(markers=more))
            case 'gravity':
                value = [chance.uniform(-3.0, 3.0), chance.uniform(-12.0, -5.0)]
                set_parameter(self.physsim, 'gravity', value)
            case 'damping':
                set_parameter(self.physsim, 'damping', chance.uniform(0.0, 0.3))
            case 'iterations':
                set_parameter(self.physsim, 'iterations', chance.randrange(5, 20))
            case 'delete':
                publish('~/spawn', delete(name))
            case 'anchor' | 'release':
                publish(f'~/{kind}', point(0.0, 0.0, frame=name))
            case _:
                # Refused where it is anchored; that changes nothing.
                publish('~/command', command(name, **{f'{kind}s'.replace('hs', 'hes'): [at]}))

    def pause(self) -> None:
        """Let time stand still, and see what was asked last."""
        succeeded(self.client.call('~/pause'))
        self.first |= dict(self.tick())

    def run(self, frames: int) -> None:
        """Go on undisturbed, and keep what is shown and has just been shown."""
        self.physsim.step(frames)
        self.first |= dict(self.shown())

    def seek(self, stamp: float) -> Event:
        """Go to a time [ns], and return the answer."""
        events = self.client.ask('~/seek', clock_of(stamp))
        (answer,) = (event for event in events if event.name == '~/seek')
        return answer

    @property
    def end(self) -> int:
        """Return the last time that was shown the first time [ns]."""
        return max(self.first)

    def compare(self, frames: list[tuple[int, str]], at_least: int) -> None:
        """Compare frames with those of the first time, where there were any."""
        known = [frame for frame in frames if frame[0] in self.first]
        assert len(known) >= at_least
        assert [frame for frame in known if self.first[frame[0]] != frame[1]] == []


def begin_seek(physsim: PhysSim, monkeypatch: pytest.MonkeyPatch) -> None:
    """Begin a seek as with ticks, which bring the world to the cached frame that is shown."""
    physsim.run(1.0)
    monkeypatch.setattr(physsim.node.loop, 'started', True)
    physsim.node.simulation.requests.submit_seek(500_000_000, Origin('~/seek'))
