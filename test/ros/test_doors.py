# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
An error that nobody expected, at each door in turn: it is told, and the world goes on.

The doors of pages are in `test/sketchpad/test_doors.py`.
"""

from __future__ import annotations

from collections.abc import Callable
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
from physsim_ros.ros.encoders.streams import PosesEncoder
from physsim_ros.ros.publishers import interactive_markers, publishers, status_publishers
from physsim_ros.ros.publishers.status_publishers import TimelinePublisher
from physsim_ros.ros.robots.commands import Commands
from physsim_ros.ros.robots.robot_topics import RobotTopics
from physsim_ros.simulation.past.past import Past
from physsim_ros.simulation.world import world
from physsim_ros.testing import box, disc, PhysSim
from physsim_ros.view import Viewer
import pytest
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import Float64
from visualization_msgs.msg import InteractiveMarkerFeedback, Marker, MarkerArray
from visualization_msgs.srv import GetInteractiveMarkers

from ..client import Client, Event

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


@pytest.fixture
def errors(physsim: PhysSim) -> list[BaseException]:
    """Give a test the errors that would end it."""
    errors: list[BaseException] = []
    physsim.node.boundary.on_error = errors.append
    return errors


@pytest.fixture
def goes_on(
    physsim: PhysSim,
    client: Client,
    errors: list[BaseException],
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> Callable[[], Event]:
    """Give a test a check that an error was told, and that the world goes on without it."""

    def check() -> Event:
        assert {type(each) for each in errors} == {ZeroDivisionError}
        monkeypatch.undo()
        physsim.node.outputs.report_answers(physsim.node.boundary.take_events())
        physsim.node.apply_requests()
        physsim.settle()
        failed = [event for event in client.events if event.code == 'failed']
        assert 'failure 1 in the log' in failed[0].message
        log = capfd.readouterr().err
        assert 'failure 1, ' in log
        assert 'ZeroDivisionError: by zero' in log
        before, count = physsim.time, len(errors)
        physsim.run(0.1)
        assert physsim.time == pytest.approx(before + 0.1)
        physsim.spawn(box('after/0'))
        assert len(errors) == count
        return failed[0]

    return check


# What comes in


def test_all_topics_are_tried(physsim: PhysSim) -> None:
    topics = {each.topic_name for each in physsim.node.subscriptions}
    assert topics == {f'/{topic}'.replace('/~', '/physsim') for topic in TOPICS}


@pytest.mark.parametrize('topic', TOPICS)
def test_a_message(
    physsim: PhysSim,
    client: Client,
    goes_on: Callable[[], Event],
    monkeypatch: pytest.MonkeyPatch,
    topic: str,
) -> None:
    monkeypatch.setattr(physsim.node.requests, '_decoded', fail)
    client.publish(topic, TOPICS[topic]())
    client.spin_until(lambda: physsim.node.boundary.failures)
    assert goes_on().name == topic


@pytest.mark.parametrize('service', SERVICES)
def test_a_service(
    physsim: PhysSim,
    client: Client,
    goes_on: Callable[[], Event],
    monkeypatch: pytest.MonkeyPatch,
    service: str,
) -> None:
    physsim.node.simulation.speed = 0.0
    monkeypatch.setattr(*SERVICES[service], fail)
    response = client.call(f'~/{service}')
    assert not response.success
    assert response.message.startswith('failed: an unexpected error; failure 1 in the log')
    assert goes_on().name == f'~/{service}'


def test_a_service_of_rviz(
    physsim: PhysSim,
    client: Client,
    goes_on: Callable[[], Event],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    physsim.spawn(disc('a/0'))
    monkeypatch.setattr(interactive_markers, 'geometry_of', fail)
    response = client.request(
        GetInteractiveMarkers,
        '~/drag/get_interactive_markers',
        GetInteractiveMarkers.Request(),
    )
    assert len(response.markers) == 0
    goes_on()


def test_a_parameter_that_is_read(
    physsim: PhysSim,
    client: Client,
    goes_on: Callable[[], Event],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(physsim.node, 'get_parameters', fail)
    monkeypatch.setattr(physsim.node, 'get_parameter', fail)
    response = client.request(
        GetParameters, '~/get_parameters', GetParameters.Request(names=['speed'])
    )
    assert len(response.values) == 0
    goes_on()


def test_a_parameter_that_is_set(
    physsim: PhysSim,
    client: Client,
    goes_on: Callable[[], Event],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(parameters, 'drawing_settings', fail)
    message = Parameter('snap', value=0.5).to_parameter_msg()
    response = client.request(
        SetParameters, '~/set_parameters', SetParameters.Request(parameters=[message])
    )
    (result,) = response.results
    assert not result.successful
    assert result.reason.startswith('failed: an unexpected error')
    assert goes_on().name == '~/set_parameters'
    assert physsim.node.get_parameter('snap').value == 0.15


def test_the_effect_of_a_parameter(
    physsim: PhysSim, goes_on: Callable[[], Event], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(physsim.node.simulation, 'limit_history', fail)
    physsim.node.set_parameters([Parameter('history', value=60.0)])
    assert goes_on().name == 'parameters'


def test_a_request_of_which_half_is_done_changes_nothing(
    physsim: PhysSim,
    client: Client,
    errors: list[BaseException],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    physsim.spawn(box('floor/0', size=(9.0, 1.0), text='{anchored: true}'))
    physsim.spawn(disc('a/0', at=(0.0, 3.0)))
    physsim.run(1.0)
    before, spawn = physsim.digest(), world.HANDLERS[Spawn]

    def fail_at_the_end(*args: Any) -> None:
        spawn(*args)
        fail()

    monkeypatch.setitem(world.HANDLERS, Spawn, fail_at_the_end)
    (event,) = client.ask('~/spawn', disc('b/0', at=(0.0, 6.0)))
    assert (event.code, event.hardware_id) == ('failed', 'b/0')
    assert physsim.names == ('floor/0', 'a/0')
    assert physsim.digest() == before
    monkeypatch.undo()
    physsim.run(1.0)
    after = physsim.digest()
    # As the same world without that request goes on.
    physsim.rewind(1.0)
    assert physsim.digest() == before
    physsim.run(1.0)
    assert physsim.digest() == after
    assert len(errors) == 1


def test_a_command_of_a_robot(
    physsim: PhysSim,
    client: Client,
    goes_on: Callable[[], Event],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    physsim.spawn(disc('tb/0', text='{robot: turtlebot3_burger}'))
    publisher = client.node.create_publisher(Twist, '/tb_0/cmd_vel', 10)
    monkeypatch.setattr(Commands, 'take', fail)
    publisher.publish(Twist())
    physsim.step()
    assert goes_on().name == '/tb_0/cmd_vel'


# What goes out


OUTPUTS: dict[str, tuple[object, str]] = {
    '~/preview': (publishers, 'preview_message'),
    '~/events': (status_publishers, 'encode_event'),
    '/physsim/poses': (PosesEncoder, 'encode'),
    '~/timeline': (TimelinePublisher, 'publish'),
    '~/drag/update': (interactive_markers.InteractiveMarkers, 'show'),
    'viewer': (Viewer, 'show'),
    'robots': (RobotTopics, 'publish'),
}


@pytest.mark.parametrize('output', OUTPUTS)
def test_an_output(
    physsim: PhysSim,
    client: Client,
    goes_on: Callable[[], Event],
    monkeypatch: pytest.MonkeyPatch,
    output: str,
) -> None:
    physsim.spawn(box('tb/0', text='{robot: turtlebot3_burger}'))
    client.listen(PoseArray, '~/poses')
    client.listen(Odometry, '/tb_0/odom')
    monkeypatch.setattr(*OUTPUTS[output], fail)
    monkeypatch.setattr(physsim.node._session, 'preview', Preview(label='a disc'))  # noqa: SLF001
    physsim.node.outputs.publish_preview()
    physsim.node.outputs.report_answers((Answer(topic='viewer', message='it'),))
    physsim.step(3)
    assert goes_on().name == output


def test_diagnostics_count_the_errors(
    physsim: PhysSim, client: Client, errors: list[BaseException], monkeypatch: pytest.MonkeyPatch
) -> None:
    received = client.listen(DiagnosticArray, '/diagnostics')
    monkeypatch.setattr(PosesEncoder, 'encode', fail)
    client.listen(PoseArray, '~/poses')
    physsim.step(3)
    monkeypatch.undo()
    assert len(errors) == 3
    physsim.node.start()
    physsim.node.tick(0)
    client.spin_until(lambda: received)
    (status,) = received[0].status
    values = {pair.key: pair.value for pair in status.values}
    assert values['unexpected errors'] == '3'
    assert '3 unexpected errors' in status.message
    assert float(values['longest message [ms]'].split()[0]) >= 0.0


def test_diagnostics_themselves(
    physsim: PhysSim, goes_on: Callable[[], Event], monkeypatch: pytest.MonkeyPatch
) -> None:
    physsim.step()
    physsim.node.start()
    monkeypatch.setattr(physsim.node, 'count_nodes', fail)
    physsim.node.tick(0)
    assert goes_on().name == '/diagnostics'


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
