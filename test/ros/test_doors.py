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
from physsim_ros.model.errors import StepFailed
from physsim_ros.model.requests import Spawn
from physsim_ros.model.snapshot import Answer, Preview
from physsim_ros.ros import parameters, world_files
from physsim_ros.ros.encoders.preview import PreviewEncoder
from physsim_ros.ros.encoders.streams import PosesEncoder
from physsim_ros.ros.publishers import interactive_markers, status_publishers
from physsim_ros.ros.publishers.status_publishers import TimelinePublisher
from physsim_ros.ros.robots.commands import Commands
from physsim_ros.ros.robots.robot_topics import RobotTopics
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

from ..client import Client, Event, message_of

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
    'play': (parameters, 'set_value'),
    'pause': (parameters, 'set_value'),
    'rewind': (parameters, 'set_value'),
    'fast_forward': (parameters, 'set_value'),
    'fast_rewind': (parameters, 'set_value'),
    'step': (Past, 'fit_memory'),
    'undo': (Past, 'undo'),
    'redo': (Past, 'redo'),
    'reset': (Past, 'reset'),
    'instead': (DrawingSession, 'instead'),
    'clear': (Past, 'apply'),
    'load_world': (world_files, 'find_world'),
    'save_world': (world_files, 'save_world'),
}


def fail(*_: object, **__: object) -> Any:
    raise ZeroDivisionError('by zero')


class Doors:
    """The world of a test, of which a part fails from some moment on."""

    def __init__(self, client: Client, monkeypatch: pytest.MonkeyPatch, read_log: Any) -> None:
        self.client = client
        self.physsim = client.physsim
        self.node = client.physsim.node
        self._monkeypatch = monkeypatch
        self._read_log = read_log
        # Those that would end the test.
        self.errors: list[BaseException] = []
        self.node.boundary.on_error = self.errors.append

    def fail(self, owner: object, name: str) -> None:
        """Have a part raise an error that nobody expects."""
        self._monkeypatch.setattr(owner, name, fail)

    def goes_on(self) -> Event:
        """Check that the error was told, and that the world goes on; return its event."""
        physsim, errors = self.physsim, self.errors
        assert {type(each) for each in errors} == {ZeroDivisionError}
        self._monkeypatch.undo()
        self.node.outputs.report_answers(self.node.boundary.take_events())
        self.node.apply_requests()
        physsim.settle()
        failed = [event for event in self.client.events if event.code == 'failed']
        assert 'failure 1 in the log' in failed[0].message
        log = self._read_log()
        assert 'failure 1, ' in log
        assert 'ZeroDivisionError: by zero' in log
        before, count = physsim.time, len(errors)
        physsim.run(0.1)
        assert physsim.time == pytest.approx(before + 0.1)
        physsim.spawn(box('after/0'))
        assert len(errors) == count
        return failed[0]


@pytest.fixture
def doors(
    client: Client, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> Doors:
    """Give a test a world and what makes its parts fail."""
    return Doors(client, monkeypatch, lambda: capfd.readouterr().err)


# What comes in


def test_all_topics_are_tried(physsim: PhysSim) -> None:
    topics = {each.topic_name for each in physsim.node.subscriptions}
    assert topics == {f'/{topic}'.replace('/~', '/physsim') for topic in TOPICS}


@pytest.mark.parametrize('topic', TOPICS)
def test_a_message(doors: Doors, topic: str) -> None:
    doors.fail(doors.node.requests, '_decoded')
    doors.client.publish(topic, TOPICS[topic]())
    doors.client.spin_until(lambda: doors.node.boundary.failures)
    assert doors.goes_on().name == topic


@pytest.mark.parametrize('service', SERVICES)
def test_a_service(doors: Doors, service: str) -> None:
    doors.node.simulation.speed = 0.0
    doors.fail(*SERVICES[service])
    response = doors.client.call(f'~/{service}')
    assert not response.success
    assert response.message.startswith('failed: an unexpected error; failure 1 in the log')
    assert doors.goes_on().name == f'~/{service}'


def test_a_service_of_rviz(doors: Doors) -> None:
    doors.physsim.spawn(disc('a/0'))
    doors.fail(interactive_markers, 'geometry_of')
    response = doors.client.request(
        GetInteractiveMarkers,
        '~/drag/get_interactive_markers',
        GetInteractiveMarkers.Request(),
    )
    assert len(response.markers) == 0
    doors.goes_on()


def test_a_parameter_that_is_read(doors: Doors) -> None:
    doors.fail(doors.node, 'get_parameters')
    doors.fail(doors.node, 'get_parameter')
    response = doors.client.request(
        GetParameters, '~/get_parameters', GetParameters.Request(names=['speed'])
    )
    assert len(response.values) == 0
    doors.goes_on()


def test_a_parameter_that_is_set(doors: Doors) -> None:
    doors.fail(parameters, 'drawing_settings')
    (result,) = doors.client.set_parameters(message_of('snap', 0.5))
    assert not result.successful
    assert result.reason.startswith('failed: an unexpected error')
    assert doors.goes_on().name == '~/set_parameters'
    assert doors.node.get_parameter('snap').value == 0.15


def test_the_effect_of_a_parameter(doors: Doors) -> None:
    doors.fail(doors.node.simulation, 'limit_history')
    doors.node.set_parameters([Parameter('history', value=60.0)])
    assert doors.goes_on().name == 'parameters'


def test_a_request_of_which_half_is_done_changes_nothing(
    doors: Doors, monkeypatch: pytest.MonkeyPatch
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


def test_a_command_of_a_robot(doors: Doors) -> None:
    doors.physsim.spawn(disc('tb/0', text='{robot: turtlebot3_burger}'))
    publisher = doors.client.node.create_publisher(Twist, '/tb_0/cmd_vel', 10)
    doors.fail(Commands, 'take')
    publisher.publish(Twist())
    doors.physsim.step()
    assert doors.goes_on().name == '/tb_0/cmd_vel'


# What goes out


OUTPUTS: dict[str, tuple[object, str]] = {
    '/physsim/preview': (PreviewEncoder, 'encode'),
    '~/events': (status_publishers, 'encode_event'),
    '/physsim/poses': (PosesEncoder, 'encode'),
    '~/timeline': (TimelinePublisher, 'publish'),
    '~/drag/update': (interactive_markers.InteractiveMarkers, 'show'),
    'viewer': (Viewer, 'show'),
    'robots': (RobotTopics, 'publish'),
}


@pytest.mark.parametrize('output', OUTPUTS)
def test_an_output(doors: Doors, output: str) -> None:
    doors.physsim.spawn(box('tb/0', text='{robot: turtlebot3_burger}'))
    doors.client.listen(PoseArray, '~/poses')
    doors.client.listen(MarkerArray, '~/preview')
    doors.client.listen(Odometry, '/tb_0/odom')
    doors.fail(*OUTPUTS[output])
    doors.node._session.preview = Preview(label='a disc')  # noqa: SLF001
    doors.node.outputs.report_answers((Answer(topic='viewer', message='it'),))
    doors.physsim.step(3)
    assert doors.goes_on().name == output


def test_diagnostics_count_the_errors(doors: Doors, monkeypatch: pytest.MonkeyPatch) -> None:
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


def test_diagnostics_themselves(doors: Doors) -> None:
    doors.physsim.step()
    doors.node.start()
    doors.fail(doors.node, 'count_nodes')
    doors.node.tick(0)
    assert doors.goes_on().name == '/diagnostics'


# In a test


def test_in_a_test_it_is_an_error(physsim: PhysSim, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(physsim.node.requests, '_decoded', fail)
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
