# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Commands of the motors of a robot, by the topics that controllers of arms publish.

`joint_command` is a `sensor_msgs/JointState`, of which each joint has a position, else a velocity,
else an effort, as Isaac Sim has it. `joint_trajectory_controller/joint_trajectory`, and the
arrays on `position_controller/commands`, `velocity_controller/commands` and
`effort_controller/commands`, are those of ros2_control's controllers of these names
(https://control.ros.org/jazzy/doc/ros2_controllers/doc/controllers_index.html).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
import math
from typing import Any

from physsim_ros.model.errors import Malformed, no_joint
from physsim_ros.model.motor_command import CommandPoint, MODES, MotorCommand
from physsim_ros.model.requests import CommandMotors
from physsim_ros.model.robots import JOINT_TOPICS, part_name, Robot
from physsim_ros.ros.robots.command_topic import CommandTopic, MOST_BYTES
from physsim_ros.ros.topics import decoded, Refuse, refusing_another_type
from rclpy.duration import Duration
from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from trajectory_msgs.msg import JointTrajectory

# Of a burst the last ones count.
_DEPTH = 10


class MotorTopic(CommandTopic):
    """
    A topic of commands of motors.

    :param node: that subscribes
    :param topic: its name
    :param kind: type of its messages
    :param commands: returns the commands of a message
    """

    def __init__(
        self, node: Node, topic: str, kind: type, commands: Callable[[Any], list[MotorCommand]]
    ) -> None:
        super().__init__(topic)
        self._node, self._kind, self._commands = node, kind, commands
        # Bytes of the last command: rclpy would take seconds for a trajectory of megabytes.
        self._last: bytes | None = None
        self._subscription = node.create_subscription(kind, topic, self._receive, _DEPTH, raw=True)

    def take(self) -> CommandMotors | None:
        """
        Return the request of the last command since the last call; None where none came.

        :raises Refusal: it is too large or cannot be decoded, names what the robot has not, or a
            value is out of range
        """
        data, self._last = self._last, None
        if data is None:
            return None
        commands = self._commands(decoded(data, self._kind, MOST_BYTES))
        return CommandMotors(commands=tuple(commands))

    def close(self) -> None:
        """Unsubscribe."""
        self._node.destroy_subscription(self._subscription)

    def _receive(self, data: bytes) -> None:
        self._last = data


def motor_topics(
    node: Node, below: str, body: str, robot: Robot, refuse: Refuse
) -> list[MotorTopic]:
    """
    Return the topics of commands of a robot's motors; none where it has none.

    :param node: that subscribes
    :param below: what their names begin with
    :param body: name of the robot's body
    :param robot: that it is
    :param refuse: reports a topic that cannot be
    """
    if not robot.motors:
        return []
    motors = {joint.name: part_name(body, joint.name) for joint in robot.motors}
    kinds: tuple[tuple[type, Callable[..., list[MotorCommand]]], ...] = (
        (JointState, _of_states),
        (JointTrajectory, _of_trajectory),
        *((Float64MultiArray, partial(_of_array, mode)) for mode in MODES),
    )
    topics = []
    for name, (kind, convert) in zip(JOINT_TOPICS, kinds, strict=True):
        topic = f'{below}{name}'
        with refusing_another_type(topic, refuse):
            topics.append(MotorTopic(node, topic, kind, partial(convert, motors)))
    return topics


def _joint(motors: dict[str, str], name: str) -> str:
    """
    Return the name of a joint in the world.

    :param motors: the same by the name in the robot
    :raises UnknownJoint: the robot has no motor of that name
    """
    if name not in motors:
        raise no_joint(name, motors, 'name')
    return motors[name]


def _of_array(mode: str, motors: dict[str, str], message: Float64MultiArray) -> list[MotorCommand]:
    """Return the commands of an array, which has a value for each motor, in their order."""
    if len(message.data) != len(motors):
        template = 'data has {count} values; the motors are {known}'
        raise Malformed(template, field='data', count=len(message.data), known=', '.join(motors))
    return [
        MotorCommand(joint=joint, mode=mode, points=(CommandPoint(0.0, value),))
        for joint, value in zip(motors.values(), message.data, strict=True)
    ]


def _of_states(motors: dict[str, str], message: JointState) -> list[MotorCommand]:
    """Return the commands of states of joints: of each the first array that has a number."""
    columns = [(mode, _column(getattr(message, mode), len(message.name), mode)) for mode in MODES]
    commands = []
    for number, name in enumerate(message.name):
        joint = _joint(motors, name)
        for mode, values in columns:
            if not math.isnan(values[number]):
                point = CommandPoint(0.0, values[number])
                commands.append(MotorCommand(joint=joint, mode=mode, points=(point,)))
                break
        else:
            raise Malformed(
                '{name} has neither position nor velocity nor effort', field='name', name=name
            )
    return commands


def _of_trajectory(motors: dict[str, str], message: JointTrajectory) -> list[MotorCommand]:
    """Return the commands of a trajectory, which begins when it comes."""
    names, points = message.joint_names, message.points
    times = [Duration.from_msg(point.time_from_start).nanoseconds * 1e-9 for point in points]
    rows = {
        field: [_column(getattr(point, field), len(names), field) for point in points]
        for field in ('positions', 'velocities')
    }
    commands = []
    for number, name in enumerate(names):
        values, rates = ([row[number] for row in rows[field]] for field in rows)
        mode = 'position'
        if all(map(math.isnan, values)):
            mode, values, rates = 'velocity', rates, [math.nan] * len(rates)
        path = tuple(map(CommandPoint, times, values, rates))
        commands.append(MotorCommand(joint=_joint(motors, name), mode=mode, points=path))
    return commands


def _column(values: Sequence[float], count: int, field: str) -> Sequence[float]:
    """
    Return the numbers of joints, which are NaN where the message has none.

    :raises Malformed: there are some, but not as many as joints
    """
    if len(values) not in (0, count):
        template = '{field} has {found} values for {count} joints'
        raise Malformed(template, field=field, found=len(values), count=count)
    return values if len(values) else [math.nan] * count
