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

"""
The ROS parameters: default, description, unit and range of each.

Law: a value outside its range is refused with a reason and changes nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, fields
import math
from typing import Any

from physsim_ros.drawing import DRAWING_RANGES, DrawingSettings, Tool
from physsim_ros.model.checks import FASTEST, shown
from physsim_ros.model.colors import Color, color_from
from physsim_ros.model.errors import BadProperty, Malformed, UnknownProperty
from physsim_ros.model.settings import RANGES as WORLD_RANGES
from physsim_ros.model.settings import STRONGEST, WorldSettings
from physsim_ros.model.shapes import LARGEST
from physsim_ros.model.snapshot import Answer
from physsim_ros.model.texts import abbreviated, message_text
from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_service import ParameterService

Type = Parameter.Type
_TYPES = {each.value for each in Type}
VIEWERS = ('none', 'spawn', 'web', 'connect', 'auto')
_WORLD = {each.name for each in fields(WorldSettings)}
_DRAWING = {each.name for each in fields(DrawingSettings)}
# Value of draw_color with which each body has another colour.
AUTO = 'auto'


@dataclass(frozen=True, slots=True, kw_only=True)
class Spec:
    """
    The specification of a parameter.

    :param default: its value and type
    :param meaning: description in one line, with the unit
    :param low: least value
    :param high: greatest value
    :param choices: allowed values, empty for any
    :param read_only: whether it is fixed after start
    """

    default: Any
    meaning: str
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    read_only: bool = False

    @property
    def kind(self) -> Type:
        """Return the type of the parameter."""
        if isinstance(self.default, list):
            return Type.DOUBLE_ARRAY
        kind: Type = Type.from_parameter_value(self.default)
        return kind

    @property
    def descriptor(self) -> ParameterDescriptor:
        """Return the descriptor for `ros2 param describe`."""
        descriptor = ParameterDescriptor(
            description=self.meaning,
            read_only=self.read_only,
            type=int(self.kind.value),
        )
        if self.choices:
            descriptor.additional_constraints = 'one of ' + ', '.join(self.choices)
        elif self.low is not None and self.high is not None:
            if self.kind == Type.INTEGER:
                span = IntegerRange(from_value=int(self.low), to_value=int(self.high))
                descriptor.integer_range = [span]
            else:
                spans = FloatingPointRange(from_value=float(self.low), to_value=float(self.high))
                descriptor.floating_point_range = [spans]
        return descriptor


_OF_NODE = {
    'frame_id': Spec(default='world', meaning='name of the world frame', read_only=True),
    'world_file': Spec(
        default='',
        meaning='world loaded at start and by ~/load_world, written by ~/save_world: a path, or '
        'the name of one in config/worlds',
    ),
    'world_dir': Spec(
        default='',
        meaning='after start, worlds are read and written only below this directory; empty is '
        'physsim_ros/worlds in $XDG_DATA_HOME (~/.local/share), made when first needed',
        read_only=True,
    ),
    'physics_rate': Spec(
        default=240.0,
        meaning='fixed step of the physics [Hz]',
        low=60.0,
        high=10000.0,
        read_only=True,
    ),
    'publish_rate': Spec(
        default=60.0,
        meaning='frames out [Hz]; divides physics_rate',
        low=1.0,
        high=10000.0,
        read_only=True,
    ),
    'speed': Spec(
        default=1.0,
        meaning='simulation seconds a second; 0 is paused, negative goes back',
        low=-64.0,
        high=64.0,
    ),
    'fast_speed': Spec(
        default=4.0, meaning='speed of ~/fast_forward and ~/fast_rewind', low=0.0, high=64.0
    ),
    'tool': Spec(
        default='none',
        meaning='what a click on clicked_point does; another one drops what is half drawn',
        choices=tuple(Tool),
    ),
    'history': Spec(
        default=600.0,
        meaning='how far back the world can be rewound [s]; older steps are dropped',
        low=0.0,
        high=86400.0,
    ),
    'publish_clock': Spec(default=True, meaning='whether the clock is published'),
    'publish_tf': Spec(
        default=False,
        meaning='whether the pose of every body is published on /tf, too; needs tf2_msgs',
        read_only=True,
    ),
    'viewer': Spec(
        default='auto',
        meaning='none, spawn (native Rerun), web (served on localhost), connect (to viewer_url), '
        'auto (spawn where there is a display, else web); set again, it begins a recording '
        'that has failed anew, in a file beside it',
        choices=VIEWERS,
    ),
    'trace': Spec(
        default='',
        meaning='names of bodies, separated by commas, whose way and flight the viewer shows',
    ),
    'viewer_url': Spec(default='', meaning='Rerun server to connect to', read_only=True),
    'record_file': Spec(default='', meaning='.rrd file written beside any viewer', read_only=True),
    'sketchpad': Spec(
        default='none',
        meaning='none, or serve: the page in the browser, to draw on',
        choices=('none', 'serve'),
    ),
    'sketchpad_address': Spec(
        default='127.0.0.1',
        meaning='address that the page is served on; another one than of loopback shows it to '
        'the network',
        read_only=True,
    ),
    'sketchpad_port': Spec(
        default=8765,
        meaning='port of the page; where it is taken, one of the next 20; 0 is any',
        low=0,
        high=65535,
        read_only=True,
    ),
}
# Parameters of the world and of drawing, whose defaults and ranges are those of the settings.
_MEANINGS = {
    'iterations': 'solver iterations',
    'gravity': f'of a length up to {STRONGEST:g} [m/s²]',
    'damping': 'share of velocity lost to the air each second',
    'bounds': '[xmin, ymin, xmax, ymax] of walls around the world, each '
    f'{-LARGEST:g} .. {LARGEST:g} [m]; [] is none',
    'density': 'of what is made next without saying [kg/m²]',
    'friction': 'of what is made next without saying',
    'elasticity': 'of what is made next without saying',
    'draw_velocity': f'of what is drawn next, of a length up to {FASTEST:g} [m/s]',
    'draw_color': f"of what is drawn next: '#rrggbb', '#rrggbbaa', or {AUTO}, one for each",
    'snap': 'what is drawn as near as this to something is meant to meet it [m]',
    'sketch_confidence': 'least confidence with which a stroke is taken for something',
    'regroup': 'strokes that follow one another within this time are read together [s]; 0: none',
    'beautify': 'how far a stroke may be from regular and still be meant so: angles [rad], '
    'lengths as a share; 0 keeps it as it was drawn',
    'wall_thickness': 'of walls that are drawn [m]',
    'drag_force': 'greatest force of a hand, in weights of the body',
    'command_timeout': 'of a wrench [s of simulation time]; 0 means no limit',
    'max_bodies': 'a spawn past it is refused',
    'max_shapes': 'convex pieces of all bodies; a request past it is refused',
    'max_overlaps': 'pairs of pieces that would overlap at once; a request past it is refused',
}


def _of_settings() -> dict[str, Spec]:
    defaults = asdict(WorldSettings()) | asdict(DrawingSettings())
    # ROS parameters have no None.
    defaults |= {'bounds': [], 'draw_color': AUTO}
    ranges = WORLD_RANGES | DRAWING_RANGES
    specs = {}
    for name, meaning in _MEANINGS.items():
        default, span = defaults[name], ranges.get(name)
        specs[name] = Spec(
            default=list(default) if isinstance(default, tuple) else default,
            meaning=meaning,
            low=None if span is None else span.low,
            high=None if span is None else span.high,
        )
    return specs


SPECS: dict[str, Spec] = _OF_NODE | _of_settings()


class ParameterServices(ParameterService):
    """
    The parameter services of a node; what they set or refuse is told as answers, too.

    rclpy.parameter_service.ParameterService of ROS 2 Jazzy raises on a type of value that it does
    not know, which ends the node; such a value is refused here.

    :param node: whose parameters are set
    :param tell: called with the answer to each parameter that is set or refused
    """

    def __init__(self, node: Node, tell: Callable[[Answer], None]) -> None:
        super().__init__(node)
        self._tell = tell

    def _set_parameters_callback(
        self, request: SetParameters.Request, response: SetParameters.Response
    ) -> SetParameters.Response:
        _replace_unknown_types(request.parameters)
        response = super()._set_parameters_callback(request, response)
        for parameter, result in zip(request.parameters, response.results, strict=True):
            self._tell_result(parameter.name, result)
        return response

    def _set_parameters_atomically_callback(
        self,
        request: SetParametersAtomically.Request,
        response: SetParametersAtomically.Response,
    ) -> SetParametersAtomically.Response:
        _replace_unknown_types(request.parameters)
        response = super()._set_parameters_atomically_callback(request, response)
        for parameter in request.parameters:
            self._tell_result(parameter.name, response.result)
        return response

    def _tell_result(self, name: str, result: SetParametersResult) -> None:
        """Tell the result for one parameter, whose reason becomes the sentence of the answer."""
        topic = '~/set_parameters'
        if result.successful:
            result.reason = f'{name} is {shown(self._get_node().get_parameter(name).value)}'
            self._tell(Answer(topic=topic, message=result.reason))
            return
        result.reason = message_text(result.reason)
        code, separator, reason = result.reason.partition(': ')
        if not separator or not code.isidentifier():
            # A refusal by rclpy: there is no such parameter, or it is read-only.
            code = BadProperty.code if name in SPECS else UnknownProperty.code
            reason = result.reason
        answer = Answer(topic=topic, message=reason, code=code, field=abbreviated(name))
        self._tell(answer)


def _replace_unknown_types(messages: Iterable[ParameterMessage]) -> None:
    """Replace the types of values that are unknown by NOT_SET, which is refused."""
    for message in messages:
        if message.value.type not in _TYPES:
            message.value.type = Type.NOT_SET.value


def declare(node: Node) -> dict[str, Any]:
    """
    Declare every parameter on a node and return their values.

    :raises PhysSimError: an initial value is out of range
    """
    values = {}
    for name, spec in SPECS.items():
        default = Parameter(name, spec.kind, spec.default).value
        # Declared without type and range: initial values are converted and checked here, so that
        # all refusals are alike.
        node.declare_parameter(name, default, ParameterDescriptor(dynamic_typing=True))
        given = node.get_parameter(name)
        if given.type_ == Type.NOT_SET:
            # rcl passes an empty list of the command line, or of a file, as NOT_SET.
            given = Parameter(name, Type.BYTE_ARRAY, [])
        parameter = _converted(given)
        check(parameter)
        node.set_parameters([parameter])
        node.set_descriptor(name, spec.descriptor)
        values[name] = _plain(parameter.value, spec)
    world_settings(values)
    drawing_settings(values)
    node.add_pre_set_parameters_callback(converted)
    return values


def converted(parameters: Iterable[Parameter]) -> list[Parameter]:
    """Return the parameters with integers and empty lists converted to the declared types."""
    return [_converted(parameter) for parameter in parameters]


def check(parameter: Parameter) -> None:
    """
    Check type and range of a parameter.

    :raises BadProperty: the type is wrong, or the value is out of range
    :raises Malformed: a number is not finite
    """
    spec = SPECS.get(parameter.name)
    if spec is None:
        return
    name, value = parameter.name, parameter.value
    if parameter.type_ != spec.kind:
        raise BadProperty(
            f'{name} must be of type {spec.kind.name.lower()}, not {parameter.type_.name.lower()}',
            field=name,
        )
    numbers = value if isinstance(value, list) else [value]
    if any(isinstance(each, float) and not math.isfinite(each) for each in numbers):
        raise Malformed(f'{name} is not finite', field=name)
    if spec.low is not None and spec.high is not None and not spec.low <= value <= spec.high:
        raise BadProperty(
            f'{name} is {value:g}; it must lie between {spec.low:g} and {spec.high:g}', field=name
        )
    if spec.choices and value not in spec.choices:
        raise BadProperty(f'{name} must be one of {", ".join(spec.choices)}', field=name)


def world_changes(parameters: Iterable[Parameter]) -> dict[str, Any]:
    """Return the settings of the world that parameters change, by name."""
    return {
        parameter.name: _setting(parameter.name, parameter.value)
        for parameter in parameters
        if parameter.name in _WORLD
    }


def world_settings(values: Mapping[str, Any]) -> WorldSettings:
    """
    Return the settings of the world among parameter values.

    :raises PhysSimError: they are refused
    """
    return WorldSettings(**{name: _setting(name, values[name]) for name in _WORLD})


def drawing_settings(values: Mapping[str, Any]) -> DrawingSettings:
    """
    Return the settings of drawing among parameter values.

    :raises PhysSimError: they are refused
    """
    settings = {name: values[name] for name in _DRAWING}
    settings['draw_velocity'] = tuple(values['draw_velocity'])
    settings['draw_color'] = _draw_color(values['draw_color'])
    return DrawingSettings(**settings)


def world_parameters(settings: WorldSettings) -> list[Parameter]:
    """Return the parameters that have the settings of the world as their values."""
    parameters = []
    for name in sorted(_WORLD):
        value = getattr(settings, name)
        if isinstance(value, tuple):
            value = list(value)
        parameters.append(Parameter(name, SPECS[name].kind, [] if value is None else value))
    return converted(parameters)


def _converted(parameter: Parameter) -> Parameter:
    spec = SPECS.get(parameter.name)
    if spec is None:
        return parameter
    value = parameter.value
    if spec.kind == Type.DOUBLE and parameter.type_ == Type.INTEGER:
        return Parameter(parameter.name, Type.DOUBLE, float(value))
    # An empty list has no type: rclpy sends it as bytes, ros2cli as booleans.
    empty = parameter.type_.name.endswith('_ARRAY') and len(value) == 0
    numbers = parameter.type_ in (Type.DOUBLE_ARRAY, Type.INTEGER_ARRAY)
    if spec.kind == Type.DOUBLE_ARRAY and (empty or numbers):
        # A message holds an array.array; the value is always a list.
        return Parameter(parameter.name, Type.DOUBLE_ARRAY, [float(each) for each in value])
    return parameter


def _plain(value: Any, spec: Spec) -> Any:
    return list(value) if isinstance(spec.default, list) else value


def _draw_color(text: str) -> Color | None:
    try:
        return None if text == AUTO else color_from(text)
    except BadProperty as refusal:
        raise BadProperty(f'draw_color: {refusal}, or {AUTO}', field='draw_color') from refusal


def _setting(name: str, value: Any) -> Any:
    if name == 'bounds' and len(value) == 0:
        return None
    return tuple(value) if isinstance(SPECS[name].default, list) else value


def traced_names(value: str) -> tuple[str, ...]:
    """Return the names of bodies in the value of parameter `trace`."""
    return tuple(name for each in value.split(',') if (name := each.strip()))
