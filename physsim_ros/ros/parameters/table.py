# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The table of the parameters: default, meaning and range of each, as their declarations have them.

A setting of the world or of drawing is declared in `model.settings` or `drawing.settings`; all
other parameters are declared here.
"""

from dataclasses import dataclass
from typing import Annotated, Any

from physsim_ros.drawing import DrawingSettings, Tool
from physsim_ros.model.checks import flag, OneOf, text, Vector, Whole, Within
from physsim_ros.model.declarations import Checked, Declaration
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.robots.sensors import angles, LEAST_INCREMENT, MOST_BEAMS
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.transform import Point
from physsim_ros.ros.robots.frames import RobotTf
from physsim_ros.simulation.clock import SPEED
from physsim_ros.simulation.past import DEFAULT_MEMORY, LEAST_MEMORY, MOST_MEMORY
from physsim_ros.view import ViewerMode
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.parameter import Parameter

Type = Parameter.Type

# Value of draw_color with which each body has another colour.
AUTO = 'auto'
# Values of parameters for settings that are None, which ROS does not have.
FOR_NONE = {'bounds': [], 'datum': [], 'laser_angle': [], 'draw_color': AUTO}
# A note of a parameter that is fixed after the start.
READ_ONLY = 'read-only'


# Least angle between the first and the last beam [rad], in which MOST_BEAMS have room.
_NARROWEST = MOST_BEAMS * LEAST_INCREMENT


def _laser_angle(value: object, name: str) -> Point | None:
    """
    Return the first and the last angle of lasers [rad]; None of an empty list.

    :raises Malformed: there are not two numbers
    :raises BadProperty: they are out of range or out of order, or too close together
    """
    if isinstance(value, list | tuple) and not value:
        return None
    first, last = angles(value, name)
    if last - first < _NARROWEST:
        raise BadProperty('{field} must span at least {least:g} rad', field=name, least=_NARROWEST)
    return first, last


@dataclass(frozen=True, slots=True, kw_only=True)
class NodeSettings(Checked):
    """The parameters that are no settings of the world or of drawing."""

    frame_id: Annotated[str, text, 'name of the world frame', READ_ONLY] = 'world'
    world_file: Annotated[
        str,
        text,
        'world to load at the start and by `~/load_world`, and to write by `~/save_world`: a '
        'path, or the name of a world or lesson in `world_dir`, or else of a shipped one. Paths '
        'are relative to `world_dir`; at the start, the working directory comes first',
    ] = ''
    world_dir: Annotated[
        str,
        text,
        'a running node reads and writes worlds only below this directory; empty means '
        '`$XDG_DATA_HOME/physsim_ros/worlds`, usually `~/.local/share/physsim_ros/worlds`, '
        'created when first needed',
        READ_ONLY,
    ] = ''
    lesson_dir: Annotated[
        str, text, 'directory of your own lessons; empty means `lessons` in `world_dir`', READ_ONLY
    ] = ''
    physics_rate: Annotated[
        float,
        Within(60.0, 10000.0, 'Hz'),
        'physics steps per second of simulation time',
        READ_ONLY,
    ] = 240.0
    publish_rate: Annotated[
        float,
        Within(1.0, 10000.0, 'Hz'),
        'frames published per second; must divide `physics_rate`',
        READ_ONLY,
    ] = 60.0
    speed: Annotated[
        float, SPEED, 'simulated seconds per second; 0 is paused, negative goes back'
    ] = 1.0
    fast_speed: Annotated[
        float, Within(0.0, 64.0), 'speed of `~/fast_forward` and, backward, of `~/fast_rewind`'
    ] = 4.0
    tool: Annotated[
        str,
        OneOf(tuple(Tool)),
        'what a click on `clicked_point` does; changing it drops an unfinished gesture',
    ] = 'none'
    history: Annotated[
        float,
        Within(0.0, 86400.0, 's'),
        'how far back the world can be rewound; older steps are dropped',
    ] = 600.0
    history_memory: Annotated[
        float,
        Within(LEAST_MEMORY, MOST_MEMORY, 'MB'),
        'memory of the past: requests, checkpoints, frames, other courses, undone requests; '
        'when it is full, the oldest data is dropped, and the event `history` says so',
    ] = DEFAULT_MEMORY
    publish_clock: Annotated[bool, flag, 'whether the clock is published'] = True
    publish_tf: Annotated[
        bool,
        flag,
        'whether the pose of every body is published on `/tf` as well; needs tf2_msgs',
        READ_ONLY,
    ] = False
    map_resolution: Annotated[float, Within(0.001, 10.0, 'm'), 'side of a cell of `~/map`'] = 0.05
    robot_tf: Annotated[
        str,
        OneOf(tuple(mode.value for mode in RobotTf)),
        'transforms of robots: `prefixed` (on `/tf`, with the namespace in frame names), '
        '`namespaced` (plain names on `<namespace>/tf`) or `none`; they need tf2_msgs',
        READ_ONLY,
    ] = 'prefixed'
    robots_in_past: Annotated[
        str,
        OneOf(('follow', 'freeze')),
        'topics of robots and `clock` while the past is shown: `follow` (they replay it) or '
        '`freeze` (they are silent)',
    ] = 'follow'
    drive_timeout: Annotated[
        float,
        Within(-1.0, 1e6, 's'),
        'simulation time after which a robot stops without another command on `cmd_vel`; 0 is '
        'never, -1 is the `timeout` of each drive',
    ] = -1.0
    laser_beams: Annotated[
        int,
        Whole(0, MOST_BEAMS),
        "number of beams that every laser publishes; 0 is each laser's own number",
    ] = 0
    laser_angle: Annotated[
        Point | None,
        _laser_angle,
        'first and last angle that every laser publishes [rad], counter-clockwise, 0.01 rad to a '
        "full turn apart; empty is each laser's own",
    ] = None
    lockstep: Annotated[
        float,
        Within(0.0, 3600.0, 's'),
        'longest wait after each scan, in wall time, for a `TwistStamped` with the stamp of the '
        'scan or a later one; 0 is no wait',
    ] = 0.0
    viewer: Annotated[
        str,
        OneOf(tuple(mode.value for mode in ViewerMode)),
        '`none`, `spawn` (native Rerun), `web` (served on localhost), `connect` (to '
        '`viewer_url`) or `auto` (`spawn` if there is a display, else `web`); setting it again '
        'opens a viewer that was closed, and restarts a failed recording in a new file beside the '
        'old one',
    ] = 'auto'
    viewer_url: Annotated[
        str,
        text,
        'Rerun server to connect to; empty is `rerun+http://127.0.0.1:9876/proxy`',
        READ_ONLY,
    ] = ''
    record_file: Annotated[
        str,
        text,
        '`.rrd` file to write in addition to any viewer, indexed when the node ends; it replaces '
        'an older recording of that name, but no other file',
        READ_ONLY,
    ] = ''
    sketchpad: Annotated[str, OneOf(('none', 'serve')), '`serve` serves the page to browsers'] = (
        'none'
    )
    sketchpad_address: Annotated[
        str,
        text,
        'address to serve the page on; any address but loopback exposes it to the network',
        READ_ONLY,
    ] = '127.0.0.1'
    sketchpad_port: Annotated[
        int,
        Whole(0, 65535),
        'port of the page; if it is taken, one of the next 20; 0 is any free port',
        READ_ONLY,
    ] = 8765
    sketchpad_frozen: Annotated[
        bool, flag, "pupils' pages cannot change anything; a teacher's can"
    ] = False
    sketchpad_locked: Annotated[
        str,
        text,
        "names of bodies, separated by commas, that pupils' pages cannot change; with `*`, `?` "
        'and `[]` as in a shell, in at most 50 names',
    ] = ''


@dataclass(frozen=True, slots=True)
class Spec:
    """
    The specification of a parameter, of the declaration of its setting.

    :param declaration: of the setting
    """

    declaration: Declaration

    @property
    def default(self) -> Any:
        """Return its value and, by that, its type."""
        name, value = self.declaration.name, self.declaration.default
        if value is None:
            return FOR_NONE[name]
        return list(value) if isinstance(value, tuple) else value

    @property
    def meaning(self) -> str:
        """Return its description as plain text, with the unit."""
        sentence, check = self.declaration.sentence.replace('`', ''), self.declaration.check
        if isinstance(check, Vector):
            return f'{sentence}, {check.span}'
        return (
            f'{sentence} [{check.unit}]' if isinstance(check, Within) and check.unit else sentence
        )

    @property
    def span(self) -> Within | Whole | None:
        """Return the check of a number's range; None for other parameters."""
        check = self.declaration.check
        return check if isinstance(check, Within | Whole) else None

    @property
    def choices(self) -> tuple[str, ...]:
        """Return the allowed words, empty for any."""
        check = self.declaration.check
        return check.words if isinstance(check, OneOf) else ()

    @property
    def read_only(self) -> bool:
        """Return whether it is fixed after the start."""
        return READ_ONLY in self.declaration.notes

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
            description=self.meaning, read_only=self.read_only, type=int(self.kind.value)
        )
        if self.choices:
            descriptor.additional_constraints = 'one of ' + ', '.join(self.choices)
        elif isinstance(self.span, Whole):
            whole = IntegerRange(from_value=self.span.low, to_value=self.span.high)
            descriptor.integer_range = [whole]
        elif self.span is not None:
            span = FloatingPointRange(from_value=self.span.low, to_value=self.span.high)
            descriptor.floating_point_range = [span]
        return descriptor


SPECS: dict[str, Spec] = {
    name: Spec(declaration)
    for each in (NodeSettings, WorldSettings, DrawingSettings)
    for name, declaration in each.FIELDS.items()
}
