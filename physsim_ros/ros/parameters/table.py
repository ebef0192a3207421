# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The table of the parameters: default, meaning, unit and range of each.

A setting of the world or of drawing has only its meaning here; its default and range are those of
`model.settings` and `drawing.settings`.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from physsim_ros.drawing import DRAWING_RANGES, DrawingSettings, Tool
from physsim_ros.model.checks import FASTEST
from physsim_ros.model.settings import RANGES as WORLD_RANGES
from physsim_ros.model.settings import STRONGEST, WorldSettings
from physsim_ros.model.shapes import LARGEST
from physsim_ros.ros.robots.frames import RobotTf
from physsim_ros.simulation.past import DEFAULT_MEMORY, LEAST_MEMORY, MOST_MEMORY
from physsim_ros.view import ViewerMode
from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.parameter import Parameter

Type = Parameter.Type

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
        'the name of a world in world_dir, else of a shipped one',
    ),
    'world_dir': Spec(
        default='',
        meaning='after start, worlds are read and written only below this directory; empty is '
        'physsim_ros/worlds in $XDG_DATA_HOME (~/.local/share), created when first needed',
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
        meaning='what a click on clicked_point does; setting it drops an unfinished gesture',
        choices=tuple(Tool),
    ),
    'history': Spec(
        default=600.0,
        meaning='how far back time can go [s]; older steps are dropped',
        low=0.0,
        high=86400.0,
    ),
    'history_memory': Spec(
        default=DEFAULT_MEMORY,
        meaning='memory of the past [MB]: requests, checkpoints, frames, courses that were left, '
        'undone requests; when it is full the oldest is dropped, with an event (history)',
        low=LEAST_MEMORY,
        high=MOST_MEMORY,
    ),
    'publish_clock': Spec(default=True, meaning='whether the clock is published'),
    'publish_tf': Spec(
        default=False,
        meaning='whether the pose of every body is also published on /tf; needs tf2_msgs',
        read_only=True,
    ),
    'map_resolution': Spec(
        default=0.05, meaning='side of a cell of ~/map [m]', low=0.001, high=10.0
    ),
    'robot_tf': Spec(
        default='prefixed',
        meaning='transforms of robots: prefixed (on /tf, frames named below the namespace), '
        'namespaced (plain names on <namespace>/tf), none; without tf2_msgs there are none',
        choices=tuple(mode.value for mode in RobotTf),
        read_only=True,
    ),
    'robots_in_past': Spec(
        default='follow',
        meaning='topics of robots and the clock while the past is shown: follow (they show it), '
        'freeze (nothing is sent)',
        choices=('follow', 'freeze'),
    ),
    'lockstep': Spec(
        default=0.0,
        meaning='longest wait, by the wall, for the TwistStamped that answers a scan, its stamp '
        'or a later one on it [s]; 0 is no wait',
        low=0.0,
        high=3600.0,
    ),
    'viewer': Spec(
        default='auto',
        meaning='none, spawn (native Rerun), web (served on localhost), connect (to viewer_url), '
        'auto (spawn if there is a display, else web); setting it again restarts a recording '
        'that has failed, in a new file beside the old one',
        choices=tuple(mode.value for mode in ViewerMode),
    ),
    'viewer_url': Spec(default='', meaning='Rerun server to connect to', read_only=True),
    'record_file': Spec(default='', meaning='.rrd file written beside any viewer', read_only=True),
    'sketchpad': Spec(
        default='none',
        meaning='serve: the page in the browser is served, to draw on; none: it is not',
        choices=('none', 'serve'),
    ),
    'sketchpad_address': Spec(
        default='127.0.0.1',
        meaning='address that the page is served on; any other than loopback exposes it to the '
        'network',
        read_only=True,
    ),
    'sketchpad_port': Spec(
        default=8765,
        meaning='port of the page; if it is taken, one of the next 20; 0 is any free port',
        low=0,
        high=65535,
        read_only=True,
    ),
    'sketchpad_frozen': Spec(
        default=False,
        meaning='pages of pupils change nothing; those of a teacher do',
    ),
    'sketchpad_locked': Spec(
        default='',
        meaning='names of bodies, separated by commas, that pages of pupils do not change; with '
        '*, ? and [] as in a shell, in at most 50 names',
    ),
}
# Parameters of the world and of drawing, whose defaults and ranges are those of the settings.
_MEANINGS = {
    'iterations': 'solver iterations of a step, shared out among its four sub-steps',
    'gravity': f'acceleration, of a length up to {STRONGEST:g} [m/s²]',
    'damping': 'share of velocity lost to the air each second',
    'bounds': '[xmin, ymin, xmax, ymax] of walls around the world, each '
    f'{-LARGEST:g} .. {LARGEST:g} [m]; [] is none',
    'density': 'default of new bodies [kg/m²]',
    'friction': 'default coefficient of new bodies',
    'elasticity': 'default coefficient of restitution of new bodies',
    'draw_velocity': f'of new drawn bodies, of a length up to {FASTEST:g} [m/s]',
    'draw_color': f"of new drawn bodies: '#rrggbb', '#rrggbbaa', or {AUTO}, another one for each",
    'snap': 'drawn ends move onto bodies within this distance [m]',
    'sketch_confidence': 'least confidence at which a stroke is recognised',
    'regroup': 'strokes within this time of one another are read together [s]; 0: each alone',
    'beautify': 'tolerance of regularisation: angles [rad], lengths as a share; 0 keeps a stroke '
    'as it was drawn',
    'wall_thickness': 'of drawn walls [m]',
    'drag_force': 'greatest force of a hand, in weights of the body',
    'floor_friction': 'coefficient of friction between bodies and the floor of a world that is '
    'seen from above; 0 is a world that is seen from the side',
    'seed': 'seed of all noise of robots',
    'datum': '[latitude, longitude] of the origin [deg], for receivers of satellite navigation: x '
    'is east there, y north; [] is nowhere',
    'command_timeout': 'duration of a commanded wrench [s of simulation time]; 0 means no limit',
    'max_bodies': 'most bodies; a request beyond it is refused',
    'max_shapes': 'most convex pieces of all bodies; a request beyond it is refused',
    'max_overlaps': 'most pairs of pieces that overlap at once; a request beyond it is refused',
    'max_joints': 'most joints; a joint beyond it is refused',
}


def _of_settings() -> dict[str, Spec]:
    defaults = asdict(WorldSettings()) | asdict(DrawingSettings())
    # ROS parameters have no None.
    defaults |= {'bounds': [], 'datum': [], 'draw_color': AUTO}
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
