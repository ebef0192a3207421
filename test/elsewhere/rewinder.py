# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Travel through a world's time by its topics alone, and note every frame bit for bit.

Given a seed: disturb a running world at random, then go back, on, and to any time.
"""

from __future__ import annotations

from hashlib import blake2b
import random
import struct
import sys
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PointStamped, Transform, Twist, Wrench
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import Float64
from visitor import disc, stamp_of, Visitor
from visualization_msgs.msg import Marker, MarkerArray

# A frame at speed 1 [ns], and so the first time [frames].
PERIOD = 1e9 / 60.0
FIRST = 320
BUTTONS = ('play', 'pause', 'rewind', 'fast_rewind', 'step', 'undo', 'redo')
# Bodies at most.
MANY = 30


def frame_of(message: MultiDOFJointState) -> tuple[int, str]:
    """Return the stamp [ns] of a frame, and a hash of every name and number in it."""
    numbers = []
    for way, twist in zip(message.transforms, message.twist, strict=True):
        spot, turn = way.translation, way.rotation
        numbers += [spot.x, spot.y, spot.z, turn.x, turn.y, turn.z, turn.w]
        numbers += [twist.linear.x, twist.linear.y, twist.angular.z]
    content = ' '.join(message.joint_names).encode() + struct.pack(f'<{len(numbers)}d', *numbers)
    return stamp_of(message), blake2b(content, digest_size=8).hexdigest()


def clock_of(stamp: int) -> Clock:
    message = Clock()
    message.clock.sec, message.clock.nanosec = divmod(stamp, 1_000_000_000)
    return message


class Traveller(Visitor):
    """Someone who sends a world through its time."""

    def __init__(self) -> None:
        super().__init__(*(f'/physsim/{name}' for name in BUTTONS))
        self.client(GetParameters, '/physsim/get_parameters')
        self.client(SetParameters, '/physsim/set_parameters')
        self.states = self.listen(MultiDOFJointState, '/physsim/states')
        self.events = self.listen(DiagnosticStatus, '/physsim/events')
        self.clocks = self.listen(Clock, '/clock')
        self.topics: dict[str, Any] = {}
        for topic, kind in {
            'spawn': Marker,
            'spawn_array': MarkerArray,
            'command': MultiDOFJointState,
            'anchor': PointStamped,
            'release': PointStamped,
            'speed': Float64,
            'seek': Clock,
        }.items():
            self.topics[topic] = self.publisher(kind, f'/physsim/{topic}')
        self.asked = 0

    def ask(self, topic: str, message: Any, answers: int = 1) -> None:
        self.topics[topic].publish(message)
        self.asked += answers

    @property
    def answered(self) -> int:
        return sum(each.name[2:] in self.topics for each in self.events)

    def parameter(self, name: str) -> Any:
        request = GetParameters.Request(names=[name])
        (value,) = self.request('/physsim/get_parameters', request).values
        if value.type == ParameterType.PARAMETER_INTEGER:
            return value.integer_value
        if value.type == ParameterType.PARAMETER_DOUBLE:
            return value.double_value
        return list(value.double_array_value)

    def set_parameter(self, name: str, value: Any) -> None:
        kinds: dict[type, tuple[int, str]] = {
            int: (ParameterType.PARAMETER_INTEGER, 'integer_value'),
            float: (ParameterType.PARAMETER_DOUBLE, 'double_value'),
            list: (ParameterType.PARAMETER_DOUBLE_ARRAY, 'double_array_value'),
        }
        kind, field = kinds[type(value)]
        given = Parameter(name=name, value=ParameterValue(type=kind, **{field: value}))
        request = SetParameters.Request(parameters=[given])
        (result,) = self.request('/physsim/set_parameters', request).results
        assert result.successful, result.reason

    def call_well(self, service: str) -> str:
        success, message = self.call(f'/physsim/{service}')
        assert success, message
        return message

    def meet(self) -> None:
        """Ask for nothing until that is answered: then both directions have met."""
        self.greet(self.events, self.topics['spawn'])

    def step(self) -> tuple[int, str]:
        """Make a step of a paused world, and return the frame that it ends with."""
        seen = len(self.states)
        # It is said with what it ends, in whole microseconds.
        said = self.call_well('step')
        end = float(said.split()[1])
        self.spin_until(
            lambda: any(abs(stamp_of(each) * 1e-9 - end) < 1e-5 for each in self.states[seen:]),
            f'the frame of a step: {said}',
        )
        return frame_of(self.states[-1])

    def collect(self, count: int, *, forward: bool) -> list[tuple[int, str]]:
        """Return the frames from now on, until so many have come or time has stopped."""
        begin, told = len(self.states), len(self.events)

        def done() -> bool:
            stopped = any(each.name == 'history' for each in self.events[told:])
            return len(self.states) - begin >= count or (stopped and not forward)

        self.spin_until(done, f'{count} frames')
        return [frame_of(each) for each in self.states[begin:]]

    def seek(self, stamp: int) -> list[str]:
        """Go to a time, and return code, sentence and field of the answer."""
        begin = len(self.events)
        self.ask('seek', clock_of(stamp))

        def answers() -> list[DiagnosticStatus]:
            return [each for each in self.events[begin:] if each.name == '~/seek']

        self.spin_until(answers, 'an answer to a seek')
        (answer,) = answers()
        values = {pair.key: pair.value for pair in answer.values}
        return [values['code'], answer.message, values.get('field', '')]


class Disturber:
    """Asks for something or other at random, by way of a topic or a parameter."""

    def __init__(self, traveller: Traveller, seed: int) -> None:
        self._traveller = traveller
        self._chance = random.Random(seed)
        self._number = 0

    def disturb(self, names: list[str]) -> None:
        """Ask for one thing, of the bodies that there are."""
        acts = [self.spawn] * 8 + [self.spawn_array] * 2 + [self.configure] * 4
        if len(names) > MANY:
            acts = []
        if names:
            acts += [self.delete, self.command, self.anchor, self.anchor, self.release] * 2
        self._chance.choice(acts)(self._chance.choice(names) if names else '')

    def body(self) -> Marker:
        chance, self._number = self._chance, self._number + 1
        spot = (chance.uniform(-3.0, 3.0), chance.uniform(1.0, 8.0))
        text = f'{{velocity: [{chance.uniform(-3, 3)}, 0], elasticity: {chance.random()}}}'
        result = disc('body', self._number, *spot, chance.uniform(0.3, 1.0), text)
        if self._number % 2:
            result.type = Marker.CUBE
            result.scale.y = chance.uniform(0.3, 1.0)
        if self._number % 5 == 0:
            result.lifetime.sec = 1
        return result

    def spawn(self, _: str) -> None:
        self._traveller.ask('spawn', self.body())

    def spawn_array(self, _: str) -> None:
        array = MarkerArray(markers=[self.body() for _ in range(3)])
        self._traveller.ask('spawn_array', array, 3)

    def configure(self, _: str) -> None:
        chance = self._chance
        name, value = chance.choice(
            [
                ('gravity', [chance.uniform(-3.0, 3.0), chance.uniform(-12.0, -5.0)]),
                ('damping', chance.uniform(0.0, 0.3)),
                ('iterations', chance.randrange(5, 20)),
                ('bounds', [chance.uniform(-6.0, -4.0), chance.uniform(-1.0, 0.0), 5.0, 15.0]),
            ]
        )
        self._traveller.set_parameter(name, value)

    def delete(self, name: str) -> None:
        namespace, _, number = name.partition('/')
        marker = Marker(ns=namespace, id=int(number), action=Marker.DELETE)
        self._traveller.ask('spawn', marker)

    def command(self, name: str) -> None:
        chance, command = self._chance, MultiDOFJointState(joint_names=[name])
        kind = chance.choice(['twist', 'wrench', 'pose'])
        if kind == 'twist':
            command.twist = [Twist()]
            command.twist[0].linear.x = chance.uniform(-5.0, 5.0)
            command.twist[0].angular.z = chance.uniform(-5.0, 5.0)
        elif kind == 'wrench':
            command.wrench = [Wrench()]
            command.wrench[0].force.x = chance.uniform(-5.0, 5.0)
            command.wrench[0].torque.z = chance.uniform(-1.0, 1.0)
        else:
            command.transforms = [Transform()]
            command.transforms[0].translation.x = chance.uniform(-3.0, 3.0)
            command.transforms[0].translation.y = chance.uniform(2.0, 8.0)
        self._traveller.ask('command', command)

    def anchor(self, name: str) -> None:
        self._hold('anchor', name)

    def release(self, name: str) -> None:
        self._hold('release', name)

    def _hold(self, topic: str, name: str) -> None:
        # The origin of the body's own frame; a body that is gone by then is refused.
        point = PointStamped()
        point.header.frame_id = name
        self._traveller.ask(topic, point)


class Travel:
    """A journey through a world's time, of which everything is noted in `seen`."""

    def __init__(self, traveller: Traveller, seed: int) -> None:
        self.traveller = traveller
        self.seed = seed
        self.end = 0
        self.seen: dict[str, Any] = {}

    def settings(self) -> dict[str, Any]:
        names = ('gravity', 'damping', 'iterations', 'bounds')
        return {name: self.traveller.parameter(name) for name in names}

    def the_first_time(self) -> None:
        traveller, states = self.traveller, self.traveller.states
        chance, disturber = random.Random(-self.seed), Disturber(traveller, self.seed)
        traveller.set_parameter('bounds', [-5.0, 0.0, 5.0, 15.0])
        self.seen['original'] = self.settings()
        traveller.call_well('play')
        begin = len(states)
        while len(states) - begin < FIRST:
            seen = len(states)
            traveller.spin_until(lambda: len(states) > seen, 'a frame')  # noqa: B023
            if chance.random() < 0.35 and len(states) - begin < FIRST - 20:
                disturber.disturb(list(states[-1].joint_names))
        traveller.call_well('pause')
        traveller.spin_until(lambda: traveller.answered >= traveller.asked, 'all answers')
        self.end = traveller.step()[0]
        self.seen |= {
            'end': self.end,
            # Of frames of one time, the last: with what was asked while time stood still.
            'first': dict(frame_of(each) for each in states),
            'asked': traveller.asked,
            'answered': traveller.answered,
            'refused': sum(each.level != DiagnosticStatus.OK for each in traveller.events),
            'most': max(len(each.joint_names) for each in states),
            'settings': self.settings(),
        }

    def back_and_on(self) -> None:
        traveller, told = self.traveller, len(self.traveller.clocks)
        passes: dict[str, list[tuple[int, str]]] = {}

        def go(what: str, count: int, *, forward: bool = False) -> None:
            word, _, speed = what.partition(' ')
            if speed:
                traveller.ask('speed', Float64(data=float(speed)))
            else:
                traveller.call_well(word)
            passes[what] = traveller.collect(count, forward=forward)
            traveller.call_well('pause')
            # Here and below: the frame of a step comes after all that was shown before.
            passes[f'a step after {what}'] = [traveller.step()]

        go('rewind', 60)
        twice = [traveller.call('/physsim/rewind') for _ in range(2)]
        self.seen['twice'] = twice
        self.seen['step while rewinding'] = traveller.call('/physsim/step')
        traveller.call_well('pause')
        traveller.step()
        go('speed -0.5', 40)
        go('fast_rewind', 20)
        go('play', 40, forward=True)
        go('speed -8', 10)
        traveller.ask('speed', Float64(data=-16.0))
        begin = len(traveller.states)
        traveller.collect(10**6, forward=False)
        self.seen |= {
            'passes': passes,
            'clocks': [
                each.clock.sec * 1_000_000_000 + each.clock.nanosec for each in traveller.clocks
            ],
            'clocks before': told,
            'stopped': [
                [each.level[0], each.message]
                for each in traveller.events
                if each.name == 'history'
            ],
            'speed then': traveller.parameter('speed'),
            'settings at the oldest': self.settings(),
        }
        traveller.step()
        passes['to the oldest'] = [frame_of(each) for each in traveller.states[begin:-1]]

    def all_again(self) -> None:
        traveller, states = self.traveller, self.traveller.states
        begin = len(states)
        traveller.set_parameter('speed', 2.0)
        traveller.spin_until(lambda: stamp_of(states[-1]) >= self.end, 'the end again')
        frames = [frame_of(each) for each in states[begin:]]
        self.seen['all again'] = [each for each in frames if each[0] <= self.end]
        traveller.call_well('pause')
        self.seen['settings again'] = self.settings()

    def to_any_time(self) -> None:
        traveller, chance = self.traveller, random.Random(self.seed)
        seeks = []
        for _ in range(14):
            stamp = chance.randrange(self.end - 40_000_000)
            seeks.append((stamp, traveller.seek(stamp), traveller.step()))
        self.seen['seeks'] = seeks
        nowhere = (self.end + 3600 * 10**9, -(10**9))
        self.seen['seeks to nowhere'] = [traveller.seek(stamp) for stamp in nowhere]
        self.seen['a step after them'] = traveller.step()

    def something_else(self) -> None:
        traveller = self.traveller
        middle = round(round(self.end / 2 / PERIOD) * PERIOD)
        traveller.seek(middle)
        begin = len(traveller.events)
        traveller.ask('spawn', disc('other', 0, 0.0, 9.0, 0.5))
        traveller.spin_until(
            lambda: any(each.hardware_id == 'other/0' for each in traveller.events), 'its answer'
        )
        self.seen['other'] = traveller.step()
        self.seen['branch'] = [each.name for each in traveller.events[begin:]]
        self.seen['seek to what is dropped'] = traveller.seek(self.end)
        begin = len(traveller.states)
        self.seen['undo'] = traveller.call('/physsim/undo')
        traveller.spin_until(lambda: len(traveller.states) > begin, 'the frame before it')
        self.seen['after undo'] = frame_of(traveller.states[-1])
        self.seen['redo'] = traveller.call('/physsim/redo')
        traveller.seek(middle)
        self.seen['after redo'] = traveller.step()
        self.seen['middle'] = middle


def travel(traveller: Traveller, seed: int) -> dict[str, Any]:
    journey = Travel(traveller, seed)
    traveller.meet()
    journey.the_first_time()
    journey.back_and_on()
    journey.all_again()
    journey.to_any_time()
    journey.something_else()
    return journey.seen


def main() -> None:
    traveller = Traveller()
    traveller.finish(**travel(traveller, int(sys.argv[1])))


if __name__ == '__main__':
    main()
