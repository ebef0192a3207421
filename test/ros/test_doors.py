# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
An error that nobody expected, at each door in turn: it is told, and the world goes on.

The doors of pages are in `test/sketchpad/test_doors.py`.
"""

from __future__ import annotations

from typing import Any

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped, PoseArray, Twist
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from physsim_ros.drawing import DrawingSession
from physsim_ros.engine.space import Space
from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import StepFailed
from physsim_ros.model.preview import Preview
from physsim_ros.model.requests import Spawn
from physsim_ros.ros import parameters, world_files
from physsim_ros.ros.encoders.preview import PreviewEncoder
from physsim_ros.ros.encoders.streams import PosesEncoder
from physsim_ros.ros.publishers import event_publisher, interactive_markers
from physsim_ros.ros.publishers.timeline_publisher import TimelinePublisher
from physsim_ros.ros.robots.drive_topic import DriveTopic
from physsim_ros.ros.robots.robot_topics import RobotTopics
from physsim_ros.ros.time_control import NodeTimeControl
from physsim_ros.simulation.past.past import Past
from physsim_ros.simulation.world import world
from physsim_ros.testing import box, disc, PhysSim
from physsim_ros.view import Viewer
import pytest
from rcl_interfaces.srv import GetParameters
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import Float64
from visualization_msgs.msg import InteractiveMarkerFeedback, Marker, MarkerArray
from visualization_msgs.srv import GetInteractiveMarkers

from ..client import Client, message_of
from ..doors import Doors, fail

TOPICS = {
    '~/spawn': Marker,
    '~/spawn_array': MarkerArray,
    '~/walls': OccupancyGrid,
    '~/join': Marker,
    '~/pin': PointStamped,
    '~/axle': PointStamped,
    '~/anchor': PointStamped,
    '~/release': PointStamped,
    '~/command': MultiDOFJointState,
    '~/drag/feedback': InteractiveMarkerFeedback,
    'clicked_point': PointStamped,
    '~/stroke': Path,
    '~/speed': Float64,
    '~/seek': Clock,
}
SERVICES: dict[str, tuple[object, str]] = {
    'play': (NodeTimeControl, 'set_speed'),
    'pause': (NodeTimeControl, 'set_speed'),
    'rewind': (NodeTimeControl, 'set_speed'),
    'fast_forward': (NodeTimeControl, 'set_speed'),
    'fast_rewind': (NodeTimeControl, 'set_speed'),
    'step': (Past, 'fit_memory'),
    'undo': (Past, 'undo'),
    'redo': (Past, 'redo'),
    'reset': (Past, 'reset'),
    'instead': (DrawingSession, 'instead'),
    'clear': (Past, 'apply'),
    'load_world': (world_files, 'find_world'),
    'save_world': (world_files, 'save_world'),
}


class NodeDoors(Doors):
    """A world of which a part fails, and a client that hears what it tells of that."""

    def __init__(self, client: Client, *fixtures: Any) -> None:
        super().__init__(client.physsim, *fixtures)
        self.client = client

    def goes_on(self) -> list[str]:
        """Check that errors were told, and the world goes on; return what they are told of."""
        self.repair()
        count = len(self.errors)
        self.node.outputs.report_answers(self.node.boundary.take_events())
        self.client.catch_up()
        failed = [event for event in self.client.events if event.code == 'failed']
        assert 'failure 1 in the log' in failed[0].message
        self.run_on()
        self.physsim.spawn(box('after/0'))
        assert len(self.errors) == count
        return [event.name for event in failed]


@pytest.fixture
def doors(
    client: Client, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> NodeDoors:
    """Give a test a world and what makes its parts fail."""
    return NodeDoors(client, monkeypatch, capfd)


# What comes in


def test_all_topics_are_tried(physsim: PhysSim) -> None:
    topics = {each.topic_name for each in physsim.node.subscriptions}
    assert topics == {f'/{topic}'.replace('/~', '/physsim') for topic in TOPICS}


def test_messages(doors: NodeDoors) -> None:
    doors.fail(doors.node.request_topics, '_decoded')
    for topic, kind in TOPICS.items():
        doors.client.ask(topic, kind())
    assert doors.goes_on() == [*TOPICS]


def test_services(doors: NodeDoors) -> None:
    doors.node.simulation.speed = 0.0
    for service, (owner, name) in SERVICES.items():
        with doors.monkeypatch.context() as patch:
            patch.setattr(owner, name, fail)
            response = doors.client.call(f'~/{service}')
        assert not response.success, service
        assert response.message.startswith('failed: an unexpected error; failure ')
    assert doors.goes_on() == [f'~/{service}' for service in SERVICES]


def test_a_service_of_rviz(doors: NodeDoors) -> None:
    doors.physsim.spawn(disc('a/0'))
    doors.fail(interactive_markers, 'geometry_of')
    response = doors.client.request(
        GetInteractiveMarkers,
        '~/drag/get_interactive_markers',
        GetInteractiveMarkers.Request(),
    )
    assert len(response.markers) == 0
    doors.goes_on()


def test_a_parameter_that_is_read(doors: NodeDoors) -> None:
    doors.fail(doors.node, 'get_parameters')
    doors.fail(doors.node, 'get_parameter')
    response = doors.client.request(
        GetParameters, '~/get_parameters', GetParameters.Request(names=['speed'])
    )
    assert len(response.values) == 0
    doors.goes_on()


def test_a_parameter_that_is_set(doors: NodeDoors) -> None:
    doors.fail(parameters, 'drawing_settings')
    (result,) = doors.client.set_parameters(message_of('snap', 0.5))
    assert not result.successful
    assert result.reason.startswith('failed: an unexpected error')
    assert doors.goes_on() == ['~/set_parameters']
    assert doors.node.get_parameter('snap').value == 0.15


def test_the_effect_of_a_parameter(doors: NodeDoors) -> None:
    doors.fail(doors.node.simulation, 'limit_history')
    doors.node.set_parameters([Parameter('history', value=60.0)])
    assert doors.goes_on() == ['parameters']


def test_a_request_of_which_half_is_done_changes_nothing(
    doors: NodeDoors, monkeypatch: pytest.MonkeyPatch
) -> None:
    doors.physsim.spawn(box('floor/0', size=(9.0, 1.0), text='{anchored: true}'))
    doors.physsim.spawn(disc('a/0', at=(0.0, 3.0)))
    doors.physsim.run(1.0)
    before, spawn = doors.physsim.digest(), world.HANDLERS[Spawn]

    def fail_at_the_end(*args: Any) -> None:
        spawn(*args)
        fail()

    monkeypatch.setitem(world.HANDLERS, Spawn, fail_at_the_end)
    (event,) = doors.client.ask('~/spawn', disc('b/0', at=(0.0, 6.0)))
    assert (event.code, event.hardware_id) == ('failed', 'b/0')
    assert doors.physsim.names == ('floor/0', 'a/0')
    assert doors.physsim.digest() == before
    monkeypatch.undo()
    doors.physsim.run(1.0)
    after = doors.physsim.digest()
    # As the same world without that request goes on.
    doors.physsim.rewind(1.0)
    assert doors.physsim.digest() == before
    doors.physsim.run(1.0)
    assert doors.physsim.digest() == after
    assert len(doors.errors) == 1


def test_a_command_of_a_robot(doors: NodeDoors) -> None:
    doors.physsim.spawn(disc('tb/0', text='{robot: turtlebot3_burger}'))
    publisher = doors.client.node.create_publisher(Twist, '/tb_0/cmd_vel', 10)
    doors.fail(DriveTopic, 'take')
    publisher.publish(Twist())
    doors.physsim.step()
    assert doors.goes_on() == ['/tb_0/cmd_vel']


# What goes out


OUTPUTS: dict[str, tuple[object, str]] = {
    '/physsim/preview': (PreviewEncoder, 'encode'),
    '~/events': (event_publisher, 'encode_event'),
    '/physsim/poses': (PosesEncoder, 'encode'),
    '~/timeline': (TimelinePublisher, 'show'),
    '~/drag/update': (interactive_markers.InteractiveMarkers, 'show'),
    'viewer': (Viewer, 'show'),
    'robots': (RobotTopics, 'publish'),
}


@pytest.mark.parametrize('output', OUTPUTS)
def test_an_output(doors: NodeDoors, output: str) -> None:
    doors.physsim.spawn(box('tb/0', text='{robot: turtlebot3_burger}'))
    doors.client.listen(PoseArray, '~/poses')
    doors.client.listen(MarkerArray, '~/preview')
    doors.client.listen(Odometry, '/tb_0/odom')
    doors.fail(*OUTPUTS[output])
    doors.node._session.preview = Preview(label='a disc')  # noqa: SLF001
    doors.node.outputs.report_answers((Answer(topic='viewer', message='it'),))
    doors.physsim.step(3)
    assert doors.goes_on() == [output]


def test_diagnostics_count_the_errors(doors: NodeDoors, monkeypatch: pytest.MonkeyPatch) -> None:
    received = doors.client.listen(DiagnosticArray, '/diagnostics')
    doors.fail(PosesEncoder, 'encode')
    doors.client.listen(PoseArray, '~/poses')
    doors.physsim.step(3)
    monkeypatch.undo()
    assert len(doors.errors) == 3
    doors.node.start()
    doors.node.tick(0)
    doors.client.spin_until(lambda: received)
    (status,) = received[0].status
    values = {pair.key: pair.value for pair in status.values}
    assert values['unexpected errors'] == '3'
    assert '3 unexpected errors' in status.message
    assert float(values['longest message [ms]'].split()[0]) >= 0.0


def test_diagnostics_themselves(doors: NodeDoors) -> None:
    doors.physsim.step()
    doors.node.start()
    doors.fail(doors.node, 'get_node_names_and_namespaces')
    doors.node.tick(0)
    assert doors.goes_on() == ['/diagnostics']


# In a test


def test_in_a_test_it_is_an_error(physsim: PhysSim, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(physsim.node.request_topics, '_decoded', fail)
    with pytest.raises(ZeroDivisionError, match='by zero'):
        physsim.spawn(disc('a/0'))
    physsim.step()


def test_of_another_thread_too(physsim: PhysSim) -> None:
    physsim.step()
    physsim.node.boundary.failed('page', ZeroDivisionError('by zero'))
    with pytest.raises(ZeroDivisionError, match='by zero'):
        physsim.step()


# In a step


def test_an_error_in_a_step_is_not_caught(
    physsim: PhysSim, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    physsim.spawn(disc('a/0'))
    physsim.node.simulation.speed = 0.0
    monkeypatch.setattr(Space, 'step', fail)
    with pytest.raises(StepFailed, match='by zero'):
        client.call('~/step')
    with pytest.raises(StepFailed):
        physsim.step()
