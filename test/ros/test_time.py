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

"""Time goes back, on and to any moment, over ROS, and what is shown again is so to the bit."""

from __future__ import annotations

from hashlib import blake2b
from itertools import pairwise
import math
from pathlib import Path
import random
import struct
from typing import Any

from physsim_ros.testing import PhysSim, Refused
import pytest
from rclpy.node import Node
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import Float64
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

from ..client import Client, Event
from ..messages import box, command, delete, disc, ELL, point, polygon
from ..outside import Outside

# A frame at speed 1 [ns]; stamps are whole nanoseconds.
PERIOD = 1e9 / 60.0
STEP = 1e9 / 240.0
SECOND = 1_000_000_000


def set_parameter(physsim: PhysSim, name: str, value: object) -> None:
    (result,) = physsim.node.set_parameters([Parameter(name, value=value)])
    assert result.successful, result.reason


def parameter(physsim: PhysSim, name: str) -> Any:
    value = physsim.node.get_parameter(name).value
    return value if isinstance(value, (int, float, str)) else list(value)


def succeeded(response: Trigger.Response) -> str:
    assert response.success, response.message
    return str(response.message)


def failed(response: Trigger.Response) -> str:
    assert not response.success, response.message
    return str(response.message)


def frame_of(message: MultiDOFJointState) -> tuple[int, str]:
    """Return the stamp [ns] of a frame, and a hash of every name and number in it."""
    numbers = []
    for way, twist in zip(message.transforms, message.twist, strict=True):
        spot, turn = way.translation, way.rotation
        numbers += [spot.x, spot.y, spot.z, turn.x, turn.y, turn.z, turn.w]
        numbers += [twist.linear.x, twist.linear.y, twist.angular.z]
    content = ' '.join(message.joint_names).encode() + struct.pack(f'<{len(numbers)}d', *numbers)
    stamp = message.header.stamp
    return stamp.sec * SECOND + stamp.nanosec, blake2b(content, digest_size=8).hexdigest()


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
            self.physsim.node.apply_requests()
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
                more = (box(f'a/{number}', at=at), polygon(f'b/{number}', outline=ELL, at=at))
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


@pytest.fixture
def journey(physsim: PhysSim, client: Client) -> Journey:
    """Give a test a world whose wall clock it turns."""
    return Journey(physsim, client)


def seconds(stamp: float) -> float:
    return stamp * 1e-9


# Back, and on again


@pytest.mark.parametrize(
    ('ask', 'speed', 'known'),
    [('~/rewind', -1.0, 90), ('~/fast_rewind', -4.0, 90), (-0.5, -0.5, 40), (-3.0, -3.0, 90)],
)
def test_what_is_shown_going_back_is_what_was_shown_first(
    journey: Journey, ask: str | float, speed: float, known: int
) -> None:
    journey.live(200)
    if isinstance(ask, str):
        succeeded(journey.client.call(ask))
    else:
        journey.client.ask('~/speed', Float64(data=ask))

    journey.tick()
    before = len(journey.clocks)
    frames = journey.tick(round(known / max(1.0, -speed)))

    assert parameter(journey.physsim, 'speed') == speed
    stamps = [stamp for stamp, _ in frames]
    back = [before - after for before, after in pairwise(stamps)]
    # To a nanosecond or two; half a speed is two steps a frame.
    assert back == pytest.approx([-speed * PERIOD] * len(back), abs=2.0)
    clocks = [each.clock.sec * SECOND + each.clock.nanosec for each in journey.clocks[before:]]
    assert clocks == stamps
    journey.compare(frames, round(0.5 * known / max(1.0, -speed)) - 2)


def test_time_stops_at_the_oldest_step_with_an_event(journey: Journey) -> None:
    journey.live(100)
    journey.client.ask('~/speed', Float64(data=-8.0))
    journey.client.events.clear()

    frames = journey.tick(30)

    assert frames[-1][0] == 0
    journey.compare(frames, 10)
    assert [(event.level, event.name) for event in journey.client.events] == [(0, 'history')]
    assert parameter(journey.physsim, 'speed') == 0.0
    assert journey.tick(5) == []
    assert all(each.clock.sec or each.clock.nanosec for each in journey.clocks)


def test_rewinding_from_the_oldest_step_stays_there(journey: Journey) -> None:
    journey.live(20)
    journey.seek(0.0)

    succeeded(journey.client.call('~/rewind'))
    frames = journey.tick(5)

    assert {stamp for stamp, _ in frames} <= {0}
    assert parameter(journey.physsim, 'speed') == 0.0
    assert journey.client.events[-1].name == 'history'


@pytest.mark.parametrize('speed', [1.0, 0.25, 5.0])
def test_what_is_played_again_is_what_was_shown_first(journey: Journey, speed: float) -> None:
    journey.live(230)
    journey.client.ask('~/speed', Float64(data=-4.0))
    journey.tick(40)
    back = journey.states[-1]
    journey.client.ask('~/speed', Float64(data=speed))

    frames = journey.tick(40)

    assert frames[-1][0] > frame_of(back)[0]
    stamps = [stamp for stamp, _ in frames]
    assert stamps == sorted(set(stamps))
    journey.compare(frames, 9)


def test_going_to_and_fro_for_long_changes_nothing(journey: Journey) -> None:
    journey.live(150)
    chance = random.Random(5)

    for _ in range(25):
        speed = chance.choice([-8.0, -4.0, -1.0, -0.5, 0.3, 1.0, 2.0])
        journey.client.ask('~/speed', Float64(data=speed))
        # At the end of what is known there is nothing to compare with; not so far.
        ahead = (journey.end - frame_of(journey.states[-1])[0]) / PERIOD
        most = 8 if speed < 0 else max(0, min(8, int(ahead / speed) - 2))
        journey.compare(journey.tick(most), 0)
    journey.client.ask('~/speed', Float64(data=0.0))
    journey.seek(0.0)
    journey.shown()
    journey.physsim.step(round(journey.end / PERIOD))

    journey.compare(journey.shown(), 150)


def test_fast_forward_has_the_speed_that_is_set_and_the_same_bits(journey: Journey) -> None:
    journey.live(120)
    journey.seek(0.0)
    set_parameter(journey.physsim, 'fast_speed', 3.0)

    succeeded(journey.client.call('~/fast_forward'))
    journey.tick()
    frames = journey.tick(30)

    assert parameter(journey.physsim, 'speed') == 3.0
    on = [after - before for (before, _), (after, _) in pairwise(frames)]
    assert on == pytest.approx([3 * PERIOD] * len(on), abs=2.0)
    journey.compare(frames, 29)


# Seek


def test_any_time_is_sought_and_played_on_from(journey: Journey) -> None:
    journey.live(200)
    chance = random.Random(3)

    for _ in range(15):
        stamp = chance.randrange(journey.end)
        journey.shown()
        answer = journey.seek(stamp)
        assert answer == Event(0, '~/seek', '', answer.message, 'ok', '')
        ((there, bits),) = journey.shown()
        assert abs(there - stamp) <= STEP / 2 + 1
        # As it was shown the first time, and in each frame after that.
        journey.compare([(there, bits)], 0)
        # To a millisecond.
        assert float(answer.message.split()[1]) == pytest.approx(seconds(there), abs=1e-3)
        journey.physsim.step(min(4, round((journey.end - stamp) / PERIOD)))
        journey.compare(journey.shown(), 0)


def test_every_frame_is_sought_in_any_order(journey: Journey) -> None:
    journey.live(150)
    stamps = sorted(journey.first)
    random.Random(4).shuffle(stamps)
    journey.shown()

    for stamp in stamps[:30]:
        assert journey.seek(stamp).code == 'ok'
        assert journey.shown() == [(stamp, journey.first[stamp])]


def test_a_seek_while_time_runs_lets_it_run_on(journey: Journey) -> None:
    journey.live(100)
    succeeded(journey.client.call('~/play'))
    journey.tick(3)

    journey.seek(0.5 * SECOND)
    frames = journey.tick(20)

    assert frames[0][0] == pytest.approx(0.5 * SECOND, abs=2)
    assert frames[-1][0] == pytest.approx(0.5 * SECOND + 19 * PERIOD, abs=2 * PERIOD)
    assert parameter(journey.physsim, 'speed') == 1.0
    journey.compare(frames, 18)


def test_a_seek_while_time_runs_back_lets_it_run_on_back(journey: Journey) -> None:
    journey.live(100)
    succeeded(journey.client.call('~/rewind'))
    journey.tick(3)

    journey.seek(1.5 * SECOND)
    frames = journey.tick(20)

    assert frames[-1][0] < 1.25 * SECOND
    assert parameter(journey.physsim, 'speed') == -1.0
    journey.compare(frames, 18)


@pytest.mark.parametrize(
    'off', [-1_000_000_000, -3_000_000, 3_000_000, 10**9, 2_000_000_000 * 10**9]
)
def test_a_seek_out_of_history_is_refused_and_changes_nothing(journey: Journey, off: int) -> None:
    journey.live(60)
    before, speed = journey.physsim.digest(), parameter(journey.physsim, 'speed')
    journey.shown()

    answer = journey.seek(off if off < 0 else journey.end + off)

    assert answer.level == 2
    assert (answer.code, answer.field) == ('out_of_history', 'clock')
    assert journey.physsim.digest() == before
    assert parameter(journey.physsim, 'speed') == speed
    assert journey.tick(3) == []


@pytest.mark.parametrize(
    ('topic', 'message'),
    [
        ('~/seek', clock_of(0)),
        ('~/seek', clock_of(10**15)),
        ('~/speed', Float64(data=0.0)),
        ('~/speed', Float64(data=math.nan)),
    ],
)
def test_what_was_asked_before_is_answered_before(
    journey: Journey, topic: str, message: Any
) -> None:
    journey.live(60)
    # Both ways are known before anything is asked.
    journey.client.ask('~/spawn', disc('a/0'))
    journey.client.ask(topic, message)
    told = len(journey.client.events)

    journey.client.publish('~/spawn', disc('b/0'))
    journey.physsim.settle()
    journey.client.ask(topic, message)

    names = [event.name for event in journey.client.events[told:] if event.name[:2] == '~/']
    assert names == ['~/spawn', topic]


# Something else in the past


@pytest.mark.parametrize('way', ['seek', 'rewind'])
def test_a_request_in_the_past_begins_a_branch(journey: Journey, way: str) -> None:
    journey.live(120)
    if way == 'seek':
        journey.seek(SECOND)
    else:
        succeeded(journey.client.call('~/rewind'))
        journey.tick(60)
        succeeded(journey.client.call('~/pause'))
    now = journey.physsim.node.simulation.step * STEP

    events = journey.client.ask('~/spawn', disc('new/0', at=(0.0, 9.0)))

    told = [(each.name, each.level) for each in events]
    assert told[-2:] == [('~/spawn', 0), ('branch', 0)]
    assert 'new/0' in journey.physsim.names
    assert journey.seek(now + PERIOD).code == 'out_of_history'
    # The past is as it was.
    journey.shown()
    for stamp in sorted(journey.first)[:50:7]:
        journey.seek(stamp)
    journey.compare(journey.shown(), 8)


def test_a_branch_is_a_past_of_its_own(journey: Journey) -> None:
    journey.live(100)
    journey.seek(SECOND)
    journey.client.ask('~/spawn', disc('new/0', at=(0.0, 9.0)))
    journey.shown()
    journey.first = {}
    journey.run(100)

    journey.client.ask('~/speed', Float64(data=-1.0))
    back = journey.tick(99)
    journey.client.ask('~/speed', Float64(data=1.0))
    on = journey.tick(90)

    journey.compare(back, 90)
    journey.compare(on, 85)


def test_a_parameter_set_in_the_past_begins_a_branch(journey: Journey) -> None:
    journey.live(60)
    journey.seek(0.5 * SECOND)
    journey.client.events.clear()

    set_parameter(journey.physsim, 'gravity', [0.0, 3.0])
    journey.tick()

    assert [event.name for event in journey.client.events] == ['branch']
    assert journey.seek(journey.end).code == 'out_of_history'


def test_a_refused_request_in_the_past_begins_none(journey: Journey) -> None:
    journey.live(60)
    journey.seek(0.5 * SECOND)

    events = journey.client.ask('~/spawn', delete('nobody/0'))

    assert [(event.name, event.code) for event in events] == [('~/spawn', 'unknown_body')]
    journey.shown()
    assert journey.seek(journey.end).code == 'ok'
    journey.compare(journey.shown(), 1)


def test_looking_and_changing_pace_in_the_past_begins_none(journey: Journey) -> None:
    journey.live(60)
    journey.seek(0.5 * SECOND)
    journey.client.events.clear()

    for service in ('play', 'pause', 'step', 'fast_forward', 'rewind', 'pause'):
        succeeded(journey.client.call(f'~/{service}'))
        journey.tick(2)
    gravity = parameter(journey.physsim, 'gravity')
    set_parameter(journey.physsim, 'gravity', gravity)

    journey.tick()
    assert {event.name for event in journey.client.events} == {
        f'~/{service}' for service in ('play', 'pause', 'step', 'fast_forward', 'rewind')
    }
    assert journey.seek(journey.end).code == 'ok'


# Undo, redo


def test_undo_goes_back_to_the_moment_before_the_last_request(journey: Journey) -> None:
    journey.live(60)
    physsim, before = journey.physsim, journey.physsim.digest()
    names, time = physsim.names, physsim.time
    physsim.spawn(disc('new/0', at=(0.0, 9.0)))
    journey.run(30)

    message = succeeded(journey.client.call('~/undo'))

    assert 'new/0' in message
    assert f'{time:.3f}' in message
    assert physsim.names == names
    assert physsim.time == time
    assert physsim.digest() == before


def test_redo_returns_to_where_undo_was_asked_for(journey: Journey) -> None:
    journey.live(60)
    physsim = journey.physsim
    physsim.spawn(disc('new/0', at=(0.0, 9.0)))
    journey.run(30)
    asked, time = physsim.digest(), physsim.time
    succeeded(journey.client.call('~/undo'))
    physsim.step(7)

    message = succeeded(journey.client.call('~/redo'))

    assert f'{time:.3f}' in message
    assert physsim.digest() == asked
    # All of what was cut off is there again.
    journey.shown()
    journey.seek(0.0)
    journey.shown()
    physsim.step(round(journey.end / PERIOD))
    journey.compare(journey.shown(), 85)


def test_redo_in_the_past_returns_to_the_past_and_to_what_lay_ahead(journey: Journey) -> None:
    journey.live(60)
    physsim = journey.physsim
    physsim.spawn(disc('new/0', at=(0.0, 9.0)))
    journey.run(60)
    journey.seek(1.5 * SECOND)
    asked = physsim.digest()

    succeeded(journey.client.call('~/undo'))
    assert journey.seek(1.5 * SECOND).code == 'out_of_history'
    succeeded(journey.client.call('~/redo'))

    assert physsim.digest() == asked
    journey.shown()
    assert journey.seek(journey.end).code == 'ok'
    journey.compare(journey.shown(), 1)


def test_many_requests_are_undone_one_by_one_and_redone(journey: Journey) -> None:
    physsim, call = journey.physsim, journey.client.call
    journey.pause()
    digests = [physsim.digest()]
    for number in range(5):
        physsim.spawn(disc(f'a/{number}', at=(2.0 * number, 1.0)))
        physsim.step(20 * (number % 2))
        digests.append(physsim.digest())

    undone = []
    for _ in range(5):
        succeeded(call('~/undo'))
        undone.append(len(physsim.names))
    assert failed(call('~/undo')).startswith('out_of_history: ')
    assert undone == [4, 3, 2, 1, 0]
    redone = []
    for _ in range(5):
        succeeded(call('~/redo'))
        redone.append(physsim.digest())

    assert failed(call('~/redo')).startswith('out_of_history: ')
    # Redo returns to where undo was asked for: the moments before the next request.
    assert [digest in digests for digest in redone] == [True] * 5
    assert redone[-1] == digests[-1]


def test_an_array_is_undone_whole(journey: Journey) -> None:
    journey.live(30)
    physsim, before = journey.physsim, journey.physsim.digest()
    physsim.spawn(MarkerArray(markers=[disc(f'new/{each}', at=(each, 9)) for each in range(3)]))
    after = physsim.digest()

    message = succeeded(journey.client.call('~/undo'))

    assert physsim.digest() == before, message
    succeeded(journey.client.call('~/redo'))
    assert physsim.digest() == after


@pytest.mark.parametrize('bad', [0, 1, 2])
def test_what_is_refused_in_an_array_joins_it_to_nothing_else(journey: Journey, bad: int) -> None:
    physsim = journey.physsim
    physsim.spawn(disc('alone/0', at=(-3.0, 1.0)))
    before = physsim.digest()
    markers = [disc(f'new/{each}', at=(each, 9), diameter=1.0) for each in range(3)]
    markers[bad].type = 99
    with pytest.raises(Refused):
        physsim.spawn(MarkerArray(markers=markers))
    assert len(physsim.names) == 3

    succeeded(journey.client.call('~/undo'))

    assert physsim.digest() == before


def test_two_arrays_are_undone_one_after_the_other(journey: Journey) -> None:
    physsim = journey.physsim
    for namespace in ('a', 'b'):
        array = MarkerArray(markers=[disc(f'{namespace}/{each}') for each in range(2)])
        journey.client.publish('~/spawn_array', array)
    journey.tick()
    assert len(physsim.names) == 4

    succeeded(journey.client.call('~/undo'))

    assert physsim.names == ('a/0', 'a/1')


def test_a_new_request_makes_redo_impossible(journey: Journey) -> None:
    physsim = journey.physsim
    physsim.spawn(disc('a/0'))
    succeeded(journey.client.call('~/undo'))
    physsim.spawn(disc('b/0'))
    before = physsim.digest()

    assert failed(journey.client.call('~/redo')).startswith('out_of_history: ')

    assert physsim.digest() == before


def test_a_refused_request_leaves_redo_possible(journey: Journey) -> None:
    physsim = journey.physsim
    physsim.spawn(disc('a/0'))
    succeeded(journey.client.call('~/undo'))
    with pytest.raises(Refused):
        physsim.spawn(delete('nobody/0'))

    succeeded(journey.client.call('~/redo'))

    assert physsim.names == ('a/0',)


def test_undo_and_redo_of_nothing_are_refused_and_change_nothing(journey: Journey) -> None:
    journey.physsim.step(10)
    before = journey.physsim.digest()

    for service in ('~/undo', '~/redo'):
        assert failed(journey.client.call(service)).startswith('out_of_history: ')

    assert journey.physsim.digest() == before
    assert journey.physsim.time == pytest.approx(10 / 60)


@pytest.mark.parametrize('what', ['clear', 'load_world', 'gravity', 'anchor', 'command', 'change'])
def test_whatever_changes_the_world_is_undone_and_redone(journey: Journey, what: str) -> None:
    journey.live(45)
    physsim = journey.physsim
    physsim.spawn(disc('it/0', at=(0.0, 9.0)))
    set_parameter(physsim, 'world_file', 'demo')
    journey.run(5)
    before, gravity = physsim.digest(), parameter(physsim, 'gravity')
    match what:
        case 'clear' | 'load_world':
            succeeded(journey.client.call(f'~/{what}'))
        case 'gravity':
            set_parameter(physsim, 'gravity', [7.0, 7.0])
        case 'anchor':
            physsim.anchor(physsim.pose('it/0')[:2])
        case 'command':
            physsim.command(command('it/0', twists=[(1.0, 2.0, 3.0)]))
        case 'change':
            physsim.spawn(box('it/0', at=(0.0, 9.0)))
    journey.run(10)
    after = physsim.digest()
    assert after != before

    succeeded(journey.client.call('~/undo'))
    assert physsim.digest() == before
    assert parameter(physsim, 'gravity') == gravity
    succeeded(journey.client.call('~/redo'))

    assert physsim.digest() == after


# Reset


def test_a_reset_is_undone_and_redone(journey: Journey) -> None:
    journey.live(100)
    physsim = journey.physsim
    set_parameter(physsim, 'gravity', [1.0, 2.0])
    journey.run(10)
    before, time = physsim.digest(), physsim.time

    succeeded(journey.client.call('~/reset'))
    assert (physsim.time, physsim.names) == (0.0, ())
    assert parameter(physsim, 'gravity') == [0.0, -9.81]
    succeeded(journey.client.call('~/undo'))

    assert (physsim.digest(), physsim.time) == (before, time)
    assert parameter(physsim, 'gravity') == [1.0, 2.0]
    # Its past is there again.
    journey.shown()
    journey.seek(SECOND)
    journey.compare(journey.shown(), 1)
    journey.seek(journey.end)
    succeeded(journey.client.call('~/redo'))
    assert (physsim.time, physsim.names) == (0.0, ())


def test_a_reset_in_the_past_is_undone_to_there(journey: Journey) -> None:
    journey.live(60)
    journey.seek(0.5 * SECOND)
    before = journey.physsim.digest()

    succeeded(journey.client.call('~/reset'))
    succeeded(journey.client.call('~/undo'))

    assert journey.physsim.digest() == before
    assert journey.seek(journey.end).code == 'ok'


def test_what_is_done_after_a_reset_is_undone_before_it(journey: Journey) -> None:
    journey.live(40)
    physsim, before = journey.physsim, journey.physsim.digest()
    succeeded(journey.client.call('~/reset'))
    physsim.spawn(disc('new/0'))
    physsim.step(10)

    assert 'new/0' in succeeded(journey.client.call('~/undo'))
    assert (physsim.time, physsim.names) == (0.0, ())
    assert 'reset' in succeeded(journey.client.call('~/undo'))

    assert physsim.digest() == before


def test_there_is_nothing_before_or_ahead_of_a_reset(journey: Journey) -> None:
    journey.live(40)

    succeeded(journey.client.call('~/reset'))

    assert journey.seek(PERIOD).code == 'out_of_history'
    succeeded(journey.client.call('~/rewind'))
    assert {stamp for stamp, _ in journey.tick(4)} <= {0}


# Step


def test_a_step_is_exact_in_the_past_too(journey: Journey) -> None:
    journey.live(100)
    for stamp in (0.0, 0.41, 1.0):
        journey.seek(stamp * SECOND)
        journey.shown()
        for _ in range(5):
            succeeded(journey.client.call('~/step'))
        frames = journey.shown()
        # From between two frames, a step leads onto the next.
        on = [after - before for (before, _), (after, _) in pairwise(frames)]
        assert on == pytest.approx([PERIOD] * 4, abs=2.0)
        journey.compare(frames, 5)


@pytest.mark.parametrize('speed', [1.0, -1.0, 0.25, -8.0])
def test_a_step_is_refused_unless_time_stands_still(journey: Journey, speed: float) -> None:
    journey.live(60)
    journey.client.ask('~/speed', Float64(data=speed))
    journey.tick(2)
    journey.shown()
    step, head = journey.physsim.node.simulation.step, journey.end

    assert 'pause' in failed(journey.client.call('~/step'))

    assert journey.physsim.node.simulation.step == step
    assert journey.shown() == []
    assert parameter(journey.physsim, 'speed') == speed
    assert journey.seek(head).code == 'ok'


# Parameters follow the time


def test_parameters_are_what_they_were_then(journey: Journey) -> None:
    journey.pause()
    physsim = journey.physsim
    values = {
        'gravity': [[0.0, -9.81], [1.0, -2.0], [0.0, 5.0]],
        'damping': [0.0, 0.1, 0.2],
        'iterations': [10, 11, 12],
        'bounds': [[], [-4.0, 0.0, 4.0, 8.0], [-5.0, -1.0, 5.0, 9.0]],
        'density': [1.0, 2.0, 3.0],
        'friction': [0.5, 0.6, 0.7],
    }
    for number in range(3):
        for name, these in values.items():
            set_parameter(physsim, name, these[number])
        physsim.step(60)

    def now() -> dict[str, Any]:
        return {name: parameter(physsim, name) for name in values}

    for number in (2, 0, 1, 2, 1, 0):
        journey.seek((number + 0.5) * SECOND)
        assert now() == {name: these[number] for name, these in values.items()}
    succeeded(journey.client.call('~/play'))
    for number in (0, 1, 2):
        journey.tick(20)
        assert now() == {name: these[number] for name, these in values.items()}
        journey.tick(40)
    journey.client.ask('~/speed', Float64(data=-3.0))
    for number in (2, 1, 0):
        journey.tick(20)
        assert now() == {name: these[number] for name, these in values.items()}
    assert all(
        event.name in {'~/seek', '~/speed', '~/play', '~/pause', 'history'}
        for event in journey.client.events
    )


def test_parameters_that_are_not_the_worlds_stay(journey: Journey) -> None:
    journey.live(30)
    for name, value in {'fast_speed': 7.0, 'history': 300.0, 'world_file': 'demo'}.items():
        set_parameter(journey.physsim, name, value)

    journey.seek(0.0)
    journey.tick()

    assert parameter(journey.physsim, 'fast_speed') == 7.0
    assert parameter(journey.physsim, 'history') == 300.0
    assert parameter(journey.physsim, 'world_file') == 'demo'


# History


def test_history_is_how_far_back_it_goes(journey: Journey) -> None:
    journey.live(200)
    last = round(journey.end / STEP)
    set_parameter(journey.physsim, 'history', 1.0)

    for stamp in (journey.end - SECOND - 1.1 * STEP, 0.0):
        assert journey.seek(stamp).code == 'out_of_history'
    journey.shown()
    succeeded(journey.client.call('~/rewind'))
    frames = journey.tick(80)

    journey.compare(frames, 58)
    assert round(frames[-1][0] / STEP) == last - 240
    assert journey.client.events[-1].name == 'history'
    assert parameter(journey.physsim, 'speed') == 0.0


def test_a_short_history_moves_along(journey: Journey) -> None:
    set_parameter(journey.physsim, 'history', 1.0)
    journey.live(260)

    assert journey.seek(journey.end - 1.1 * SECOND).code == 'out_of_history'
    journey.shown()
    assert journey.seek(journey.end - SECOND).code == 'ok'
    journey.physsim.step(60)

    journey.compare(journey.shown(), 60)


def test_no_history_is_a_world_without_a_past(journey: Journey) -> None:
    set_parameter(journey.physsim, 'history', 0.0)
    journey.live(100)

    succeeded(journey.client.call('~/rewind'))
    journey.tick(5)

    assert {stamp for stamp, _ in journey.shown()} <= {journey.end}
    assert parameter(journey.physsim, 'speed') == 0.0
    journey.physsim.step(10)
    assert seconds(journey.end) + 10 / 60 == pytest.approx(journey.physsim.time)


@pytest.mark.parametrize('way', ['seek', 'rewind'])
def test_a_moment_that_is_dropped_while_it_is_shown_can_be_left(
    journey: Journey, way: str
) -> None:
    journey.live(300)
    if way == 'seek':
        journey.seek(0.5 * SECOND)
    else:
        journey.client.ask('~/speed', Float64(data=-8.0))
        journey.tick(33)
        succeeded(journey.client.call('~/pause'))
        assert journey.physsim.node.simulation.step < 240
    journey.shown()

    set_parameter(journey.physsim, 'history', 1.0)
    journey.tick(3)
    succeeded(journey.client.call('~/play'))
    journey.tick(20)
    succeeded(journey.client.call('~/pause'))

    # Wherever it goes from there, it is what was so then.
    journey.compare(journey.shown(), 0)
    assert journey.seek(journey.end).code == 'ok'
    journey.compare(journey.shown(), 1)


# Worlds that are saved


def test_a_saved_world_goes_on_in_another_process_as_it_does_here(
    journey: Journey, outside: Outside, tmp_path: Path
) -> None:
    journey.live(100)
    journey.run(80)
    set_parameter(journey.physsim, 'world_file', 'mine')
    succeeded(journey.client.call('~/save_world'))
    journey.shown()

    journey.physsim.step(240)
    here = journey.shown()
    with outside.start_world(world_file=tmp_path / 'mine.yaml', speed=0.0) as world:
        world.wait_for('ready')
        there = outside.run_program('rewinder', 'step', 240)['frames']
        assert world.interrupt() == 0

    assert len(here) == len(there) == 240
    assert [one == other for (_, one), (_, other) in zip(here, there, strict=True)] == [True] * 240


def test_saving_changes_nothing_of_what_is_shown_again(journey: Journey) -> None:
    journey.live(60)
    set_parameter(journey.physsim, 'world_file', 'mine')
    succeeded(journey.client.call('~/save_world'))
    journey.run(60)
    journey.seek(0.5 * SECOND)
    succeeded(journey.client.call('~/save_world'))
    journey.shown()

    journey.physsim.step(80)

    journey.compare(journey.shown(), 80)
    assert 'branch' not in [event.name for event in journey.client.events]


def test_a_load_can_be_rewound_through(journey: Journey) -> None:
    journey.live(60)
    set_parameter(journey.physsim, 'world_file', 'demo')
    bounds = parameter(journey.physsim, 'bounds')
    succeeded(journey.client.call('~/load_world'))
    journey.run(60)

    succeeded(journey.client.call('~/rewind'))
    back = journey.tick(100)
    assert parameter(journey.physsim, 'bounds') == bounds
    succeeded(journey.client.call('~/play'))
    on = journey.tick(80)

    journey.compare(back, 95)
    journey.compare(on, 75)


# Nothing twice


@pytest.mark.parametrize(
    'service', ['play', 'pause', 'rewind', 'fast_forward', 'fast_rewind', 'save_world']
)
def test_a_service_does_nothing_twice(journey: Journey, tmp_path: Path, service: str) -> None:
    journey.live(60)
    set_parameter(journey.physsim, 'world_file', 'mine')

    messages, digests, speeds = [], [], []
    for _ in range(2):
        messages.append(succeeded(journey.client.call(f'~/{service}')))
        digests.append(journey.physsim.digest())
        speeds.append(parameter(journey.physsim, 'speed'))
        files = [path.read_bytes() for path in tmp_path.iterdir()]

    assert messages[0] == messages[1]
    assert digests[0] == digests[1]
    assert speeds[0] == speeds[1]
    assert len(files) == (service == 'save_world')
    assert journey.seek(journey.end).code == 'ok'


def test_a_reset_after_a_reset_leaves_the_first_to_be_undone(journey: Journey) -> None:
    journey.live(60)
    before = journey.physsim.digest()

    succeeded(journey.client.call('~/reset'))
    succeeded(journey.client.call('~/reset'))
    succeeded(journey.client.call('~/undo'))

    assert journey.physsim.digest() == before


def test_a_clear_after_a_clear_leaves_the_first_to_be_undone(journey: Journey) -> None:
    journey.live(60)
    before = journey.physsim.digest()

    succeeded(journey.client.call('~/clear'))
    succeeded(journey.client.call('~/clear'))
    succeeded(journey.client.call('~/undo'))

    assert journey.physsim.digest() == before


# In other people's tests


def test_seek_in_a_test_goes_to_a_time_and_on_from_there(physsim: PhysSim) -> None:
    physsim.load('demo')
    physsim.run(1.0)
    at_one = physsim.digest()
    physsim.run(2.0)
    at_three = physsim.digest()

    physsim.seek(1.0)
    assert physsim.time == 1.0
    assert physsim.digest() == at_one
    physsim.run(2.0)
    assert physsim.digest() == at_three
    physsim.seek(0.0)

    physsim.until(lambda: physsim.time >= 3.0)
    assert physsim.digest() == at_three


@pytest.mark.parametrize('time', [-1.0, 1.5, 1e6])
def test_seek_in_a_test_raises_what_is_refused(physsim: PhysSim, time: float) -> None:
    physsim.spawn(disc(at=(0.0, 5.0)))
    physsim.run(1.0)
    before = physsim.digest()

    with pytest.raises(Refused) as refused:
        physsim.seek(time)

    assert (refused.value.code, refused.value.field) == ('out_of_history', 'clock')
    assert (physsim.digest(), physsim.time) == (before, 1.0)


def test_after_a_seek_other_nodes_have_the_time_and_the_parameters_of_then(
    physsim: PhysSim,
) -> None:
    robot = Node('robot', context=physsim.context)
    physsim.add(robot)
    physsim.run(1.0)
    set_parameter(physsim, 'gravity', [0.0, 0.0])
    physsim.run(1.0)

    physsim.seek(0.5)

    assert seconds(robot.get_clock().now().nanoseconds) == pytest.approx(0.5)
    assert parameter(physsim, 'gravity') == [0.0, -9.81]
    physsim.run(1.0)
    assert seconds(robot.get_clock().now().nanoseconds) == pytest.approx(1.5)
    assert parameter(physsim, 'gravity') == [0.0, 0.0]


def test_a_test_tries_one_moment_in_two_ways(physsim: PhysSim) -> None:
    physsim.spawn(disc(at=(0.0, 5.0)))
    physsim.run(0.5)

    heights = []
    for speed in (3.0, -3.0, 3.0):
        physsim.seek(0.5)
        physsim.command(command('body/0', twists=[(0.0, speed, 0.0)]))
        physsim.run(0.5)
        heights.append(physsim.pose('body/0').y)

    assert heights[0] == heights[2] > heights[1]


# From a process that knows nothing of the package


@pytest.mark.parametrize('seed', [1])
def test_somebody_elsewhere_travels_through_time(outside: Outside, seed: int) -> None:
    with outside.start_world(speed=0.0) as world:
        world.wait_for('ready')
        seen = outside.run_program('rewinder', 'travel', seed)
        assert world.interrupt() == 0
        assert 'Traceback' not in ''.join(world.lines)

    # As JSON has it, keys are words.
    first = {int(stamp): bits for stamp, bits in seen['first'].items()}
    assert len(first) > 200, 'the machine is too slow to see enough'
    assert seen['most'] > 10
    assert seen['answered'] == seen['asked'] > 70
    assert seen['refused'] < seen['asked'] / 4

    def different(frames: list[list[Any]]) -> list[int]:
        return [stamp for stamp, bits in frames if first.get(stamp, bits) != bits]

    def known(frames: list[list[Any]]) -> int:
        return sum(stamp in first for stamp, _ in frames)

    passes = seen['passes']
    assert {what: different(frames) for what, frames in passes.items()} == {
        what: [] for what in passes
    }
    assert {what for what, frames in passes.items() if not known(frames)} == set()
    for what in ('rewind', 'speed -0.5', 'fast_rewind', 'speed -8', 'to the oldest'):
        stamps = [stamp for stamp, _ in passes[what]]
        assert stamps == sorted(set(stamps), reverse=True), what
    assert all(seen['clocks'])
    falls = sum(after < before for before, after in pairwise(seen['clocks']))
    assert falls > 60
    assert [success for success, _ in seen['twice']] == [True, True]
    assert seen['step while rewinding'][0] is False

    ((level, message),) = seen['stopped']
    assert (level, seen['speed then']) == (0, 0.0)
    assert 'oldest' in message
    assert passes['to the oldest'][-1][0] == 0
    assert seen['settings at the oldest']['gravity'] == seen['original']['gravity']
    assert seen['settings'] != seen['original']

    assert different(seen['all again']) == []
    assert known(seen['all again']) > 100
    assert seen['settings again'] == seen['settings']

    for stamp, (code, message, _), (after, bits) in seen['seeks']:
        assert code == 'ok', message
        assert 0 < after - stamp < PERIOD + STEP
        assert first.get(after, bits) == bits
    for code, message, field in seen['seeks to nowhere']:
        assert (code, field) == ('out_of_history', 'clock'), message
    assert different([seen['a step after them']]) == []

    assert 'branch' in seen['branch']
    assert seen['seek to what is dropped'][0] == 'out_of_history'
    middle = seen['middle']
    assert seen['other'][0] == pytest.approx(middle + PERIOD, abs=2)
    assert seen['undo'][0], seen['undo']
    assert 'other/0' in seen['undo'][1]
    # The steps ahead of it are gone, but not the moment itself.
    assert seen['after undo'] == [middle, first.get(middle, seen['after undo'][1])]
    assert seen['redo'][0], seen['redo']
    assert seen['after redo'] == seen['other']
