# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A robot: a drive, odometry, sensors, parts, and the namespace of its topics.

Law: the topics of a robot have different names, which ROS allows.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
import re
from typing import Annotated

from physsim_ros.model.checks import ListOf, Numbers, shown, text, Within
from physsim_ros.model.declarations import Checked
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.latency import delays, LATENCY_WORDS, MESSAGE_RATE
from physsim_ros.model.motor_command import MODES
from physsim_ros.model.robots.battery import Battery
from physsim_ros.model.robots.drives import Drive, drive_from
from physsim_ros.model.robots.part_names import BASE, part_name
from physsim_ros.model.robots.parts import check_tree, Link, LinkJoint, TREE_KINDS
from physsim_ros.model.robots.sensors import Sensor, sensor_from, topic_name
from physsim_ros.model.transform import ORIGIN, Point, Pose


@dataclass(frozen=True, slots=True, kw_only=True)
class Odometry(Checked):
    """
    Odometry, and its drift.

    Errors are random walks: their variance grows with the distance.

    :raises Malformed: a number is not finite
    :raises BadProperty: a value is of the wrong kind or out of range
    """

    rate: Annotated[float, MESSAGE_RATE, 'messages a second'] = 30.0
    slip: Annotated[
        Point,
        Numbers((Within(0.0, 1.0),) * 2),
        'standard deviations of its drift, 0 .. 1: of the path after 1 m [m], of the heading '
        'after 1 m or 1 rad [rad]; 0 is exact as long as no wheel slips',
    ] = (0.0, 0.0)
    latency: Annotated[
        Point,
        delays,
        'least and greatest time from a pose to its messages on `odom` and `/tf`, as of a sensor '
        '[s]',
        LATENCY_WORDS,
    ] = (0.0, 0.0)


# Names of topics that every robot has beside that of its commands.
OWN_TOPICS = ('odom', 'ground_truth', 'robot_description', 'tf', 'tf_static')
# Name of the further topic of a robot with a battery.
BATTERY_TOPIC = 'battery_state'
# Names of the further topics of a robot whose joints have motors.
JOINT_TOPICS = (
    'joint_command',
    'joint_trajectory_controller/joint_trajectory',
    *(f'{mode}_controller/commands' for mode in MODES),
)
# Names of its frames; that of a sensor is its name.
_OWN_FRAMES = ('base_footprint', 'base_link')
# Greatest number of sensors of a robot, of its links, and of its joints.
MOST_SENSORS = MOST_PARTS = 64
# Characters of a namespace: topics of ROS have 255 at most.
_LONGEST = 150
# Tokens of ROS (https://design.ros2.org/articles/topic_and_service_names.html).
_NAMESPACE = re.compile(r'([A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*)?')


def check_namespace(value: object, name: str) -> str:
    """
    Return a namespace without a slash at its beginning; it may be empty.

    :param name: of the field, for the refusal
    :raises BadProperty: ROS does not allow it
    """
    namespace = text(value, name, BadProperty).removeprefix('/')
    if len(namespace) > _LONGEST or not _NAMESPACE.fullmatch(namespace):
        raise BadProperty(
            '{field} {value} is not a ROS name: letters, digits and _, separated by /; no part '
            'begins with a digit, at most {most} characters',
            field=name,
            value=shown(value),
            most=_LONGEST,
        )
    return namespace


@dataclass(frozen=True, slots=True, kw_only=True)
class Robot(Checked):
    """
    That what makes a body a robot.

    :raises Malformed: a number is not finite
    :raises BadProperty: a value is of the wrong kind or out of range, or two topics have one name
    """

    drive: Annotated[
        Drive | None,
        drive_from,
        'how it moves: a mapping, see below; by default it has no wheels, and may be anchored',
    ] = None
    odometry: Annotated[
        Odometry, Odometry.from_value, 'rate and errors of `odom`: a mapping, see below'
    ] = field(default_factory=Odometry)
    battery: Annotated[
        Battery | None,
        Battery.from_value,
        'of its drive: a mapping, see below; by default it never ends',
    ] = None
    sensors: Annotated[
        tuple[Sensor, ...],
        ListOf(sensor_from, 'mappings', MOST_SENSORS),
        f'a list of mappings, at most {MOST_SENSORS}; each with its own topic',
    ] = ()
    links: Annotated[
        tuple[Link, ...],
        ListOf(Link.from_value, 'mappings', MOST_PARTS),
        f'a list of mappings, at most {MOST_PARTS}: further bodies, see below',
    ] = ()
    joints: Annotated[
        tuple[LinkJoint, ...],
        ListOf(LinkJoint.from_value, 'mappings', MOST_PARTS),
        f'a list of mappings, at most {MOST_PARTS}: what holds the links, see below',
    ] = ()
    namespace: Annotated[
        str | None,
        check_namespace,
        'namespace of topics; may be empty; by default the name of the body, with `_` for `/`. '
        'Robots of a world must differ in namespaces, topics and frames (a sensor `x/odom` in '
        '`tb` and a robot in `tb/x` collide)',
    ] = None
    command_topic: Annotated[str, topic_name, 'topic of the commands, below its namespace'] = (
        'cmd_vel'
    )

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        if self.battery is not None and self.drive is None:
            raise BadProperty('a battery is that of a drive, and there is none', field='battery')
        check_tree(self.links, self.joints)
        links = [BASE, *(link.name for link in self.links)]
        topics = [*self._topics]
        for sensor in self.sensors:
            if sensor.link not in links:
                raise BadProperty(
                    '{name} is on a link {link}; there are {known}',
                    field='link',
                    name=sensor.name,
                    link=sensor.link,
                    known=', '.join(links),
                )
        for topic in topics:
            if topic in (*_OWN_FRAMES, *links):
                raise BadProperty('{topic} is a frame of the robot', field='sensors', topic=topic)
            if topics.count(topic) > 1:
                raise BadProperty('a robot has two topics {topic}', field='sensors', topic=topic)

    @property
    def topic_count(self) -> int:
        """Return the number of its topics."""
        return len(self._topics)

    @property
    def motors(self) -> tuple[LinkJoint, ...]:
        """Return its joints that have a motor which obeys commands, in their order."""
        return tuple(each for each in self.joints if each.properties.effort)

    def joint_above(self, link: str) -> LinkJoint:
        """Return the joint that a link hangs on."""
        return next(each for each in self.joints if each.a == link and each.kind in TREE_KINDS)

    def place_of(self, link: str) -> Pose:
        """Return the pose of a link in the frame of the robot's body, joints at 0."""
        return next((each.at for each in self.links if each.name == link), ORIGIN)

    @property
    def _topics(self) -> tuple[str, ...]:
        commands = JOINT_TOPICS if self.motors else ()
        return (
            self.command_topic,
            *OWN_TOPICS,
            *commands,
            *(() if self.battery is None else (BATTERY_TOPIC,)),
            *(sensor.name for sensor in self.sensors),
        )

    def namespace_of(self, body: str) -> str:
        """
        Return the namespace of its topics, without a slash at its beginning.

        :param body: name of the body
        """
        return body.replace('/', '_') if self.namespace is None else self.namespace

    def names_below(self, namespace: str) -> list[str]:
        """
        Return the names of its topics and frames in the world, without a slash at their beginning.

        :param namespace: of its topics, without a slash at its beginning
        """
        names = [*self._topics, *_OWN_FRAMES, *(link.name for link in self.links)]
        return [f'{namespace}/{name}' for name in names] if namespace else names


def whole_of(name: str, robot_of: Callable[[str], Robot | None]) -> str:
    """
    Return the name of the robot of which a body is a part, else that of the body.

    :param name: of the body
    :param robot_of: returns the robot of that name; None if that is no robot, or not there
    """
    whole = name.removesuffix('/0').rpartition('/')[0]
    robot = robot_of(whole)
    links = () if robot is None else robot.links
    return whole if name in (part_name(whole, link.name) for link in links) else name
