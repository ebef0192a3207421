# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every parameter is what the contract says, takes effect at once, and refuses what is wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import math
from pathlib import Path
import re
import socket
from typing import Any

from physsim_ros.model.attraction import MOST_ATTRACTING
from physsim_ros.model.errors import BadProperty, Malformed, PhysSimError
from physsim_ros.model.requests import Spawn
from physsim_ros.model.shapes import Disc
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.ros.parameters import SPECS
from physsim_ros.ros.requests.parameter_services import MOST_PARAMETERS
from physsim_ros.sketchpad.locks import MOST_PATTERNS
from physsim_ros.sketchpad.server import website
from physsim_ros.testing import box, disc, own_context, PhysSim
import pytest
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import (
    ParameterEvent,
    ParameterType,
    ParameterValue,
    SetParametersResult,
)
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
)
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from std_msgs.msg import Float64

from ..client import Client, Event, message_of, parameter, set_parameter

RANGES = {
    name: spec.span for name, spec in SPECS.items() if spec.span is not None and not spec.read_only
}
LIVE = [name for name, spec in SPECS.items() if not spec.read_only]
FIXED = [name for name, spec in SPECS.items() if spec.read_only]
DOUBLES = [name for name, spec in SPECS.items() if isinstance(spec.default, float)]


def made(name: str, value: object) -> Parameter:
    if value == []:
        return Parameter(name, Parameter.Type.DOUBLE_ARRAY, [])
    return Parameter(name, value=value)


def values_of(physsim: PhysSim) -> dict[str, Any]:
    """Return the values of all parameters."""
    return {name: parameter(physsim, name) for name in SPECS}


def refuse(physsim: PhysSim, name: str, value: object) -> str:
    """Check that a value is refused with a reason and changes nothing."""
    before = values_of(physsim), physsim.digest()
    described = repr(physsim.node.describe_parameter(name))
    (result,) = physsim.node.set_parameters([made(name, value)])
    assert not result.successful
    assert result.reason
    assert (values_of(physsim), physsim.digest()) == before
    assert repr(physsim.node.describe_parameter(name)) == described
    return str(result.reason)


@pytest.fixture
def context(monkeypatch: pytest.MonkeyPatch) -> Iterator[Context]:
    """Give a context in which a test starts nodes of its own."""
    with own_context(monkeypatch) as context:
        yield context


def started(context: Context, **values: object) -> dict[str, Any]:
    """Start a node with parameters, as the command line would, and return what it has."""
    overrides = [made(name, value) for name, value in values.items()]
    node = PhysSimNode(context=context, parameter_overrides=overrides)
    try:
        return {name: node.get_parameter(name).value for name in SPECS}
    finally:
        node.destroy_node()


# Declarations


def test_every_default_is_the_contracts(context: Context) -> None:
    for name, value in started(context).items():
        default = SPECS[name].default
        if isinstance(default, list | tuple):
            assert list(value) == list(default), name
        else:
            assert (value, type(value)) == (default, type(default)), name


def test_every_parameter_is_described_over_ros_with_its_unit_and_range(client: Client) -> None:
    request = DescribeParameters.Request(names=[*SPECS])
    response = client.request(DescribeParameters, '~/describe_parameters', request)
    described = {each.name: each for each in response.descriptors}
    assert [*described] == [*SPECS]
    for name, spec in SPECS.items():
        descriptor = described[name]
        assert descriptor.description, name
        assert descriptor.read_only is spec.read_only, name
        assert descriptor.type == Parameter(name, spec.kind, spec.default).type_.value
        if isinstance(spec.default, bool | str):
            continue
        limited = descriptor.floating_point_range or descriptor.integer_range
        rows = ('gravity', 'wind', 'bounds', 'datum', 'laser_angle', 'draw_velocity')
        assert limited or name in rows, name
        if name in RANGES:
            span = RANGES[name]
            assert (limited[0].from_value, limited[0].to_value) == (span.low, span.high), name
    for name, unit in {'physics_rate': 'Hz', 'publish_rate': 'Hz', 'gravity': 'm/s²'}.items():
        assert unit in described[name].description
    assert 'connect' in described['viewer'].additional_constraints


# Refusals


def test_a_read_only_parameter_is_fixed(physsim: PhysSim) -> None:
    for name in FIXED:
        other = 120.0 if name in DOUBLES else 'other'
        assert 'read-only' in refuse(physsim, name, other), name


def test_the_ends_of_a_range_are_taken_and_what_lies_beyond_is_refused(physsim: PhysSim) -> None:
    for name, span in RANGES.items():
        default = SPECS[name].default
        kind = type(default)
        for end in (kind(span.low), kind(span.high)):
            set_parameter(physsim, name, end)
            assert parameter(physsim, name) == end, name
            assert type(parameter(physsim, name)) is kind, name
        if kind is int:
            beyond = [int(span.low) - 1, int(span.high) + 1, -(2**63), 2**63 - 1]
        else:
            least = math.nextafter(span.low, -math.inf)
            beyond = [least, math.nextafter(span.high, math.inf), -1e300, 1e300]
        for value in beyond:
            assert name in refuse(physsim, name, value)
        set_parameter(physsim, name, default)


def test_a_number_that_is_not_finite_is_refused(physsim: PhysSim) -> None:
    for name in DOUBLES:
        for value in (math.nan, math.inf, -math.inf):
            refuse(physsim, name, value)


def test_a_value_of_another_type_is_refused(physsim: PhysSim) -> None:
    for name in LIVE:
        default = SPECS[name].default
        for value in (True, 3, 3.5, 'three', ['three'], [True], [b'3']):
            if type(value) is type(default) and not isinstance(value, list):
                continue
            if isinstance(default, float) and type(value) is int:
                continue
            refuse(physsim, name, value)


def test_a_parameter_cannot_be_deleted(physsim: PhysSim) -> None:
    for name in SPECS:
        before = parameter(physsim, name)
        (result,) = physsim.node.set_parameters([Parameter(name, Parameter.Type.NOT_SET, None)])
        assert not result.successful, name
        assert result.reason
        assert parameter(physsim, name) == before


def test_a_bad_value_is_refused_with_its_code(physsim: PhysSim) -> None:
    set_parameter(physsim, 'bounds', [-5.0, -5.0, 5.0, 5.0])
    for name, value in (
        ('gravity', []),
        ('gravity', [1.0, 2.0, 3.0]),
        ('gravity', [math.nan, 0.0]),
        ('gravity', [0.0, -math.inf]),
        ('gravity', [1e9, 0.0]),
        ('datum', [1.0]),
        ('datum', [91.0, 0.0]),
        ('bounds', [0.0, 0.0, 1.0]),
        ('bounds', [1.0, 0.0, 0.0, 1.0]),
        ('bounds', [0.0, 0.0, math.nan, 1.0]),
        ('laser_angle', [0.0]),
        ('laser_angle', [1.0, 0.0]),
        ('laser_angle', [0.0, 0.001]),
        ('laser_angle', [0.0, math.inf]),
        ('laser_angle', [0.0, 7.0]),
        ('viewer', 'window'),
        ('viewer', ''),
    ):
        code = refuse(physsim, name, value).partition(':')[0]
        assert code in ('malformed', 'bad_property'), (name, value)


def test_attraction_among_too_many_bodies_is_refused(physsim: PhysSim) -> None:
    for number in range(MOST_ATTRACTING + 1):
        row, column = divmod(number, 30)
        spawn = Spawn(name=f'a/{number}', shape=Disc(radius=0.1), pose=(column, row, 0.0))
        physsim.node.simulation.requests.submit(spawn)
    physsim.node.loop.apply_requests()
    assert refuse(physsim, 'gravitation', 0.04).startswith('world_full: ')
    assert physsim.node.boundary.failures == 0


def test_many_are_taken_together_or_not_at_all(physsim: PhysSim, client: Client) -> None:
    asked = message_of('density', 2.0), message_of('friction', 99.0)
    assert not client.set_together(*asked).successful
    assert parameter(physsim, 'density') == 1.0
    assert physsim.node.simulation.world.settings.density == 1.0
    results = client.set_parameters(*asked)
    assert [result.successful for result in results] == [True, False]
    assert results[1].reason
    assert physsim.node.simulation.world.settings.density == 2.0
    assert physsim.node.simulation.world.settings.friction == 0.5


def test_a_call_about_more_parameters_than_there_may_be_does_nothing(
    physsim: PhysSim, client: Client
) -> None:
    most = MOST_PARAMETERS
    for kind, field in (
        (DescribeParameters, 'descriptors'),
        (GetParameters, 'values'),
        (GetParameterTypes, 'types'),
    ):
        service = '~/' + re.sub('(?<!^)(?=[A-Z])', '_', kind.__name__).lower()
        for number in (most, most + 1):
            response = client.request(kind, service, kind.Request(names=['speed'] * number))
            assert len(getattr(response, field)) == (number if number <= most else 0)
    client.ask('~/command', MultiDOFJointState())
    client.events.clear()
    results = client.set_parameters(*[message_of('density', 2.0)] * (most + 1))
    client.catch_up()
    (event,) = client.events
    assert event.code == 'malformed'
    assert {each.reason for each in results} == {f'malformed: {event.message}'}
    assert len(results) == most + 1
    assert parameter(physsim, 'density') == 1.0


# Effects that fail


def serve(client: Client) -> tuple[SetParametersResult, Event]:
    """Set parameter `sketchpad` to `serve` over ROS; return the result, and its event."""
    (result,) = client.set_parameters(message_of('sketchpad', 'serve'))
    client.catch_up()
    return result, client.events[-1]


def test_a_page_that_cannot_be_served_is_refused_and_the_node_goes_on(
    start: Callable[..., PhysSim], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(website, '_MORE_PORTS', 0)
    with socket.create_server(('127.0.0.1', 0)) as taken:
        physsim = start(sketchpad_port=taken.getsockname()[1])
        client = Client(physsim)
        result, event = serve(client)

        assert not result.successful
        assert (event.level, event.code, event.field) == (2, 'bad_property', 'sketchpad')
        assert result.reason == f'bad_property: {event.message}'
        assert parameter(physsim, 'sketchpad') == 'none'
        assert physsim.spawn(disc('a/0')) == 'a/0'

    result, event = serve(client)
    assert result.successful
    assert event.code == 'ok'
    assert parameter(physsim, 'sketchpad') == 'serve'


def test_no_page_is_served_where_another_parameter_beside_it_is_refused(
    start: Callable[..., PhysSim],
) -> None:
    too_many = ','.join(f'b{number}/*' for number in range(MOST_PATTERNS + 1))
    physsim = start(sketchpad_port=0)
    wanted = [made('sketchpad', 'serve'), made('sketchpad_locked', too_many)]
    result = physsim.node.set_parameters_atomically(wanted)
    assert not result.successful
    assert 'wildcards' in result.reason
    assert parameter(physsim, 'sketchpad') == 'none'
    assert physsim.node.outputs.sketchpad is None


# Conversions


def test_a_whole_number_is_taken_for_a_double_over_ros(physsim: PhysSim, client: Client) -> None:
    # 1 is beyond what `beautify` may be.
    names = [name for name in DOUBLES if name in LIVE and name != 'beautify']
    results = client.set_parameters(*(message_of(name, 1) for name in names))
    for name, result in zip(names, results, strict=True):
        assert result.successful, result.reason
        assert parameter(physsim, name) == 1.0
        assert isinstance(parameter(physsim, name), float)


@pytest.mark.parametrize(
    ('name', 'numbers', 'beyond'),
    [
        ('gravity', [1.5, -2.0], [math.nan, 0.0]),
        ('bounds', [-9.0, 0.0, 9.5, 9.0], [-9.0, 0.0, math.inf, 9.0]),
        ('draw_velocity', [1.0, 2.5], [2e5, 0.0]),
    ],
)
def test_lists_of_doubles_are_taken_and_checked_over_ros(
    physsim: PhysSim, client: Client, name: str, numbers: list[float], beyond: list[float]
) -> None:
    (result,) = client.set_parameters(message_of(name, numbers))
    assert result.successful, result.reason
    assert parameter(physsim, name) == numbers
    (result,) = client.set_parameters(message_of(name, beyond))
    assert not result.successful
    assert result.reason.partition(':')[0] in ('malformed', 'bad_property')
    assert parameter(physsim, name) == numbers


def test_a_value_of_no_type_is_refused(physsim: PhysSim, client: Client) -> None:
    values = values_of(physsim)
    messages = [
        ParameterMessage(name=name, value=ParameterValue(type=kind))
        for name in ('speed', 'gravity', 'use_sim_time', 'nobody')
        for kind in (10, 255)
    ]
    results = client.set_parameters(*messages)
    assert [result.successful for result in results] == [False] * len(messages)
    assert not any(client.set_together(message).successful for message in messages)
    assert values_of(physsim) == values


def test_lists_of_whole_numbers_and_empty_ones_are_taken(physsim: PhysSim, client: Client) -> None:
    def set_(message: ParameterMessage) -> None:
        (result,) = client.set_parameters(message)
        assert result.successful, result.reason

    set_(message_of('bounds', [-9, 0, 9, 9]))
    assert parameter(physsim, 'bounds') == [-9.0, 0.0, 9.0, 9.0]
    set_(message_of('gravity', [1, -2]))
    assert parameter(physsim, 'gravity') == [1.0, -2.0]
    # The type of an empty list depends on its sender.
    for kind in range(
        ParameterType.PARAMETER_BYTE_ARRAY, ParameterType.PARAMETER_STRING_ARRAY + 1
    ):
        set_(message_of('bounds', [-9, 0, 9, 9]))
        set_(ParameterMessage(name='bounds', value=ParameterValue(type=kind)))
        assert parameter(physsim, 'bounds') == []
        assert physsim.node.simulation.world.settings.bounds is None


def test_whole_numbers_are_taken_for_doubles_at_the_start(context: Context) -> None:
    values = started(
        context,
        physics_rate=480,
        publish_rate=120,
        speed=2,
        gravity=[0, -9],
        bounds=[-1, -2, 3, 4],
        density=3,
    )
    assert values['physics_rate'] == 480.0
    assert values['speed'] == 2.0
    assert all(isinstance(values[name], float) for name in ('physics_rate', 'speed', 'density'))
    assert list(values['gravity']) == [0.0, -9.0]
    assert list(values['bounds']) == [-1.0, -2.0, 3.0, 4.0]


@pytest.mark.parametrize(
    ('values', 'error'),
    [
        ({'speed': 65.0}, BadProperty),
        ({'speed': math.nan}, Malformed),
        ({'speed': 'fast'}, BadProperty),
        ({'iterations': 2.5}, BadProperty),
        ({'publish_rate': 7.0}, BadProperty),
        ({'gravity': [0.0]}, Malformed),
        ({'viewer': 'window'}, BadProperty),
        ({'publish_clock': 1}, BadProperty),
        ({'sketchpad_locked': ','.join(f'{each}*' for each in range(51))}, BadProperty),
        ({'world_file': 'nowhere'}, PhysSimError),
    ],
)
def test_a_node_does_not_start_with_a_bad_value(
    context: Context, values: dict[str, Any], error: type
) -> None:
    with pytest.raises(error) as caught:
        started(context, **values)
    assert str(caught.value)
    other = Node('other', context=context)
    assert other.get_node_names() == ['other']
    other.destroy_node()


@pytest.mark.parametrize(('physics', 'publish'), [(240.0, 240.0), (1000.0, 50.0), (60.0, 1.0)])
def test_any_publish_rate_that_divides_the_physics_rate_is_good(
    context: Context, physics: float, publish: float
) -> None:
    values = started(context, physics_rate=physics, publish_rate=publish)
    assert (values['physics_rate'], values['publish_rate']) == (physics, publish)


# Effects


def test_a_speed_makes_one_parameter_event_by_whichever_door_it_is_set(
    physsim: PhysSim, client: Client
) -> None:
    events = client.listen(ParameterEvent, '/parameter_events')
    physsim.step()
    doors: list[tuple[float, Callable[[], object]]] = [
        (2.0, lambda: client.ask('~/speed', Float64(data=2.0))),
        (-1.0, lambda: client.call('~/rewind')),
        (0.5, lambda: client.set_parameters(message_of('speed', 0.5))),
        (0.0, lambda: client.call('~/pause')),
    ]
    for speed, set_speed in doors:
        events.clear()
        set_speed()
        assert physsim.node.simulation.speed == speed
        client.spin_until(lambda: events)
        client.catch_up()
        changed = [each for event in events for each in event.changed_parameters]
        assert [(each.name, each.value.double_value) for each in changed] == [('speed', speed)]


def test_setting_what_is_set_changes_nothing(physsim: PhysSim) -> None:
    physsim.spawn(disc('a/0'))
    physsim.step(3)
    before = physsim.digest()
    for name in LIVE:
        if name != 'viewer':
            set_parameter(physsim, name, parameter(physsim, name))
    assert physsim.digest() == before


def test_the_clock_can_be_switched_off_and_on_again(physsim: PhysSim, client: Client) -> None:
    clocks = client.listen(Clock, '/clock')
    physsim.step(3)
    assert len(clocks) == 3
    set_parameter(physsim, 'publish_clock', value=False)
    physsim.step(3)
    assert len(clocks) == 3
    set_parameter(physsim, 'publish_clock', value=True)
    physsim.step(3)
    assert len(clocks) == 6


def test_the_clock_may_be_off_from_the_start(start: Callable[..., PhysSim]) -> None:
    physsim = start(publish_clock=False)
    clocks = Client(physsim).listen(Clock, '/clock')
    physsim.step(3)
    assert clocks == []


def test_parameters_tell_what_a_loaded_world_has_set(physsim: PhysSim, tmp_path: Any) -> None:
    (tmp_path / 'moon.yaml').write_text(
        'format: 1\ngravity: [0, -1.6]\nbounds: [-1, -1, 1, 1]\niterations: 20\nfriction: 0.25\n'
    )
    set_parameter(physsim, 'density', 7.0)
    physsim.load('moon')
    assert parameter(physsim, 'gravity') == [0.0, -1.6]
    assert parameter(physsim, 'bounds') == [-1.0, -1.0, 1.0, 1.0]
    assert parameter(physsim, 'iterations') == 20
    assert parameter(physsim, 'friction') == 0.25
    # Settings that the file does not name stay.
    assert parameter(physsim, 'density') == 7.0


def test_the_world_frame_is_named_by_a_parameter(start: Callable[..., PhysSim]) -> None:
    world = start(frame_id='map')
    world.spawn(box('a/0', at=(1.0, 2.0), frame='map'))
    assert world.pose('a/0') == (1.0, 2.0, 0.0)


def test_a_world_may_be_loaded_at_the_start(start: Callable[..., PhysSim], tmp_path: Path) -> None:
    path = tmp_path / 'one.yaml'
    path.write_text('format: 1\ngravity: [0, -1]\nbodies: [{name: a/0, circle: {radius: 1}}]\n')
    world = start(world_file=str(path))
    assert world.names == ('a/0',)
    assert parameter(world, 'gravity') == [0.0, -1.0]
    world.spawn(box('a/1', at=(5.0, 0.0)))
    world.step()
    world.node.simulation.reset()
    assert world.names == ('a/0',)
