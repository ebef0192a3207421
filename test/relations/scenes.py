# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The table of scenes: those of the laws, the shipped worlds, lessons and drawings, and robots.

A scene is the state of a world at its beginning, and for how long it is played.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial
import itertools
import math
import random

from physsim_ros.files import drawings, robot_spawn, shipped_lessons, shipped_worlds, worlds_in
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.requests import Configure, DriveRobot
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon
from physsim_ros.model.states import NEVER
from physsim_ros.simulation.simulation import Simulation

from ..laws.scenes import (
    bar_among_discs,
    floor,
    hanging_chain,
    join,
    NOWHERE,
    pyramid,
    simulation,
    spawn,
    turned,
    walls,
)
from ..laws.test_applied_forces import pulled_block
from ..laws.test_bridges import bridge, put_load
from ..laws.test_dampers import weight_on
from ..laws.test_floor import DRIVE, on_conveyors
from ..laws.test_friction import on_incline
from ..laws.test_impacts import angular_shape, pair_in_flight, round_shape, walled
from ..laws.test_jointed_friction import car, fridge, ladder, stepladder
from ..laws.test_joints import beam_on_joints, double_pendulum, tangle
from ..laws.test_machines import (
    arm_on_motor,
    balls_on_rods,
    bars_in_space,
    beam,
    gears,
    pendulum,
    pendulum_on_box,
    slider,
)
from ..laws.test_random_worlds import random_crowd, random_world
from ..laws.test_ropes import loaded_rope
from ..laws.test_rows import row as row_of_elastic_bodies
from ..laws.test_scale import falls_on_stack
from ..laws.test_tracks import ball_in_track
from ..laws.test_travel import plough
from ..worlds.digests import scene as drawn_scene
from ..worlds.film import state_of

ELL = Polygon(outline=((0.0, 0.0), (2.0, 0.0), (2.0, 0.5), (0.5, 0.5), (0.5, 2.0), (0.0, 2.0)))
PLANK = Box(width=0.6, height=0.3)
PAIR = Compound(element=Disc(radius=0.2), centers=((0.0, 0.0), (1.0, 0.3)))


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """
    A scene.

    :param build: returns its simulation or state at the beginning
    :param seconds: for which it is played [s]
    :param chaotic: whether a displacement of bodies of at most 0.1 µm grows to a thousand times as
        much, so that only invariants can be compared
    """

    build: Callable[[], Simulation | WorldState]
    seconds: float = 1.5
    chaotic: bool = False

    @cached_property
    def state(self):
        """Return its state at the beginning."""
        built = self.build()
        return beginning(built if isinstance(built, WorldState) else built.save())


def beginning(state):
    """Return a state without what it has done, as a file written by hand would have it."""
    bodies = tuple(
        replace(
            held,
            motion=None,
            acting=None,
            driven=held.driven and held.driven._replace(until=NEVER),
        )
        for held in state.bodies
    )
    return replace(state, bodies=bodies, memory=None, lesson=None)


# Laws 1 to 9: flight and impacts


def projectiles():
    sim = simulation()
    for number, shape in enumerate((Disc(radius=0.5), Box(width=1.0, height=0.3), ELL, PAIR)):
        velocity = (3.0 + number, 8.0)
        spawn(sim, f'body/{number}', shape, (4.0 * number, -2.0, 0.4), velocity=velocity, spin=3.0)
    return sim


def projectiles_in_air():
    sim = simulation(damping=0.3)
    spawn(sim, 'disc/0', Disc(radius=0.2), velocity=(8.0, 8.0), spin=3.0)
    spawn(sim, 'box/0', Box(width=1.0, height=0.3), (0.0, 4.0, 0.3), velocity=(-3.0, 1.0))
    return sim


def head_on(elasticity):
    sim = simulation(gravity=NOWHERE, elasticity=elasticity, friction=0.3)
    spawn(sim, 'a/0', Disc(radius=0.3), mass=1.0, velocity=(3.0, 0.0))
    spawn(sim, 'b/0', Disc(radius=0.5), (2.0, 0.0, 0.0), mass=3.0, velocity=(-1.0, 0.0))
    return sim


def meetings():
    sim = simulation(gravity=NOWHERE, friction=0.3)
    for number, elasticity in enumerate((1.0, 0.5, 0.0)):
        for side, shape, mass in ((-1, Disc(radius=0.5), 1.0), (1, Box(width=1, height=1), 3.0)):
            pose = (side * (1.5 + number), 4.0 * number + 0.1 * side, 0.3 * number)
            said = {'mass': mass, 'velocity': (-1.0 * side, 0.05), 'elasticity': elasticity}
            spawn(sim, f'pair/{2 * number + (side > 0)}', shape, pose, **said)
    return sim


def quick_meetings():
    """Return discs that meet at some 30 m/s, each by up to its safe depth in a sub-step."""
    sim = simulation(gravity=NOWHERE, elasticity=0.5)
    for number in range(12):
        for side in (-1, 1):
            pose = (side * (0.3 + 0.001 * number), number + 0.015 * side, 0.0)
            said = {'velocity': (side * -(13.0 + number), 0.0)}
            spawn(sim, f'disc/{2 * number + (side > 0)}', Disc(radius=0.1), pose, **said)
    return sim


def pair(kinds, seed):
    sim, _ = pair_in_flight(random.Random(seed), kinds)
    return sim


def on_walls():
    sim = simulation(gravity=NOWHERE, elasticity=1.0, friction=0.2)
    walls(sim, -6.0, -6.0, 6.0, 6.0)
    thin = Chain(points=((0.0, -3.0), (0.0, 3.0)), thickness=0.02)
    spawn(sim, 'thin/0', thin, (2.0, 0.0, 0.4), anchored=True)
    spawn(sim, 'fast/0', Disc(radius=0.1), (-3.0, 0.5, 0.0), velocity=(40.0, 3.0))
    for number in range(4):
        at = (-4.0 + number, -3.0 + number, 0.5)
        spawn(sim, f'box/{number}', Box(width=0.6, height=0.6), at, velocity=(2.0, -3.0), spin=1.0)
    return sim


def bounce(shape, elasticity, turn=0.0):
    sim = simulation(elasticity=elasticity)
    floor(sim)
    spawn(sim, 'body/0', shape, (0.0, 1.3, turn))
    return sim


def flat_polygons():
    """Drop polygons flat, each onto a side of its own."""
    sim = simulation(elasticity=0.7)
    floor(sim)
    outlines = (
        ((-0.5, 0.0), (0.5, 0.0), (0.0, 0.8)),
        ((-0.3, 0.0), (0.5, 0.0), (0.3, 0.4), (-0.2, 0.4)),
        ((-0.2, 0.0), (0.2, 0.0), (0.4, 0.35), (0.2, 0.7), (-0.2, 0.7), (-0.4, 0.35)),
    )
    for number, outline in enumerate(outlines):
        at = (2.0 * number, 1.0 + 0.3 * number, 0.0)
        spawn(sim, f'polygon/{number}', Polygon(outline=outline), at)
    return sim


def bounces():
    sim = simulation(elasticity=0.9)
    floor(sim)
    spawn(sim, 'box/0', Box(width=1.0, height=1.0), (0.0, 3.0, 0.3), anchored=True)
    for number in range(9):
        shape = (Disc(radius=0.2), Box(width=0.4, height=0.4), PAIR)[number % 3]
        spawn(sim, f'body/{number}', shape, (-2.0 + 0.5 * number, 5.0 + number % 4, 0.1 * number))
    return sim


def bouncing_disc():
    sim = simulation()
    floor(sim)
    said = {'velocity': (6.0, -3.0), 'spin': 4.0, 'elasticity': 0.7, 'friction': 0.5}
    spawn(sim, 'disc/0', Disc(radius=0.2), (0.0, 3.0, 0.0), **said)
    return sim


# Laws 10 to 13: friction


def plates(angles):
    """Return a world with anchored plates, 6 m apart, each turned by its angle [°]."""
    sim = simulation()
    plate = Box(width=4.0, height=0.5)
    for number, angle in enumerate(angles):
        pose = (6.0 * number, -0.25, math.radians(angle))
        spawn(sim, f'plate/{number}', plate, pose, anchored=True)
    return sim


def on_plates(elasticity):
    """Drop discs with spins onto plates of several slopes."""
    sim = plates(angles := (0, 20, -35, 10))
    for number, angle in enumerate(angles):
        shape, place = Disc(radius=0.2 + 0.05 * number), (6.0 * number, 1.0, 0.0)
        said = {'velocity': (0.3 * number - 0.2, 0.0), 'spin': 2.0 - angle / 10}
        spawn(sim, f'disc/{number}', shape, place, elasticity=elasticity, **said)
    return sim


def corners_on_plates():
    """Drop bodies with corners onto plates of several slopes."""
    sim = plates((0, 25, -15))
    ell = Polygon(outline=((0.0, 0.0), (0.6, 0.0), (0.6, 0.2), (0.2, 0.2), (0.2, 0.8), (0.0, 0.8)))
    wheels = Compound(element=Disc(radius=0.15), centers=((-0.4, 0.0), (0.4, 0.1)))
    for number, shape in enumerate((Box(width=0.5, height=0.3), ell, wheels)):
        said = {'velocity': (0.5, -1.0), 'spin': 1.0 - number}
        spawn(sim, f'body/{number}', shape, (6.0 * number, 1.5, 0.4), **said)
    return sim


def pairs_of_all_kinds(friction):
    """Return discs, boxes and a chain that collide in pairs."""
    sim = simulation(gravity=NOWHERE, friction=friction)
    bent = Chain(points=((0.0, -1.0), (0.3, 0.0), (0.0, 1.0)), thickness=0.1)
    pairs = (
        (Disc(radius=0.5), Disc(radius=0.3)),
        (Disc(radius=0.5), Box(width=0.6, height=0.8)),
        (Box(width=0.6, height=0.8), Box(width=1.0, height=0.4)),
        (Disc(radius=0.2), bent),
    )
    for number, (one, other) in enumerate(pairs):
        y, said = 5.0 * number, {'velocity': (2.0, 0.1), 'spin': 1.0}
        spawn(sim, f'one/{number}', one, (-2.0, y + 0.2, 0.3), **said)
        spawn(sim, f'other/{number}', other, (1.0, y, 0.1), velocity=(-1.0, 0.0))
    return sim


def incline(angle=0.5):
    sim = simulation()
    floor(sim, angle=angle)
    shapes = (Box(width=1, height=1), Disc(radius=0.5), Box(width=1.0, height=1.0))
    for number, shape in enumerate(shapes):
        at = turned((3.0 * number, 0.5), angle)
        spawn(sim, f'body/{number}', shape, (*at, angle), friction=(0.1, 0.5, 0.9)[number])
    return sim


def block_on_incline(degrees):
    sim, _ = on_incline(Box(width=1.0, height=0.5), 0.25, degrees)
    return sim


def tips_on_incline(share):
    """Lay a box of 0.5 m by 1 m on an incline of a share of the angle at which it tips."""
    degrees = share * math.degrees(math.atan(0.5))
    sim, _ = on_incline(Box(width=0.5, height=1.0), 0.5, degrees, friction=2.0, elasticity=0.0)
    return sim


def leaning_ladder():
    sim, _ = ladder(0.95)
    return sim


def comes_to_roll():
    sim = simulation(friction=0.3)
    floor(sim)
    spawn(sim, 'disc/0', Disc(radius=0.5), (0.0, 0.5, 0.0), velocity=(5.0, 0.0))
    return sim


def sliding_box():
    sim = simulation(friction=0.4)
    floor(sim)
    spawn(sim, 'box/0', Box(width=1.0, height=0.4), (0.0, 0.2, 0.0), velocity=(4.0, 0.0))
    return sim


# Laws 14 to 23: joints


def mass_on_spring(damping=0.0):
    sim = simulation()
    spawn(sim, 'mass/0', Box(width=0.2, height=0.2), (1.5, 0.0, 0.3), mass=2.0)
    said = {'stiffness': 40.0, 'rest_length': 1.0, 'damping': damping}
    points = [(1.5, 0.0), (0.0, 0.0)]
    join(sim, 'joint/0', 'spring', points, a='mass/0', b='world', **said)
    return sim


def pendulum_beside_damper(damping):
    sim = pendulum(0.6)
    points = [(math.sin(0.6), -math.cos(0.6)), (2.0, 0.0)]
    join(sim, 'spring/0', 'spring', points, a='bob/0', b='world', stiffness=0.0, damping=damping)
    return sim


def cradle():
    sim = simulation()
    for number in range(5):
        x = 0.4 * number
        place = (x - 1.5, 5.5, 0.0) if number == 0 else (x, 4.0, 0.0)
        spawn(sim, f'ball/{number}', Disc(radius=0.2), place, friction=0.0, elasticity=1.0)
        anchor = (x, 4.0 + math.hypot(1.5, 1.5) if number == 0 else 6.0)
        join(sim, f'rod/{number}', 'rod', [place[:2], anchor], a=f'ball/{number}', b='world')
    return sim


def four_bars():
    """Return bars that hang on each other from one end, level at first."""
    sim = simulation()
    floor(sim)
    for number in range(4):
        spawn(sim, f'bar/{number}', Box(width=1.0, height=0.1), (number + 0.5, 6.0, 0.0))
        other = f'bar/{number - 1}' if number else 'world'
        join(sim, f'axle/{number}', 'axle', [(float(number), 6.0)], a=f'bar/{number}', b=other)
    return sim


def limited_axle():
    sim = simulation()
    spawn(sim, 'arm/0', Box(width=1.0, height=0.1), (0.5, 0.0, 0.0))
    said = {'lower': -0.7, 'upper': 0.2}
    join(sim, 'joint/0', 'axle', [(0.0, 0.0)], a='arm/0', b='world', **said)
    return sim


def slack_rope():
    sim = simulation()
    spawn(sim, 'ball/0', Disc(radius=0.1), (0.3, 0.0, 0.0))
    points = [(0.3, 0.0), (0.0, 1.0)]
    join(sim, 'joint/0', 'rope', points, a='ball/0', b='world', length=1.5)
    return sim


def four_bar():
    """Return a crank that turns a rocker by a coupler."""
    sim = simulation()
    points = ((0.0, 0.0), (0.0, 0.4), (1.2, 0.9), (1.4, 0.0))
    names = ['world']
    for number, (one, other) in enumerate(itertools.pairwise(points)):
        middle = ((one[0] + other[0]) / 2, (one[1] + other[1]) / 2)
        yaw = math.atan2(other[1] - one[1], other[0] - one[0])
        bar = Box(width=math.dist(one, other), height=0.05)
        spawn(sim, f'bar/{number}', bar, (*middle, yaw), group=1)
        names.append(f'bar/{number}')
        kind, said = ('motor', {'rate': 6.0}) if number == 0 else ('axle', {})
        join(sim, f'joint/{number}', kind, [one], a=names[-1], b=names[-2], **said)
    join(sim, 'joint/3', 'axle', [points[-1]], a=names[-1], b='world')
    return sim


def sled_on_rope():
    """Return a box that a falling weight pulls over the floor by a rope."""
    sim = simulation(friction=0.3, elasticity=0.0)
    floor(sim)
    spawn(sim, 'sled/0', Box(width=1.0, height=0.4), (0.0, 0.2, 0.0), mass=2.0)
    spawn(sim, 'tug/0', Box(width=0.6, height=0.4), (2.0, 0.2, 0.0), mass=3.0, velocity=(3.0, 0.0))
    points = [(1.7, 0.2), (0.5, 0.2)]
    join(sim, 'rope/0', 'rope', points, a='tug/0', b='sled/0', length=1.5)
    return sim


def driving_car(share):
    sim, _ = car(share)
    return sim


def seesaw():
    sim = simulation(elasticity=0.0)
    floor(sim)
    spawn(sim, 'plank/0', Box(width=4.0, height=0.1), (0.0, 1.0, 0.0))
    join(sim, 'axle/0', 'axle', [(0.0, 1.0)], a='plank/0', b='world')
    for number, (x, y) in enumerate(((-1.8, 1.3), (1.8, 2.5))):
        spawn(sim, f'box/{number}', Box(width=0.4, height=0.4), (x, y, 0.0), mass=1.0 + number)
    return sim


def bridge_with_load(kind, slack, ratio):
    sim, middle = bridge(kind, slack)
    put_load(sim, Box(width=1.0, height=1.0), ratio, middle)
    return sim


def rope_on_drum(ratio):
    sim, _ = loaded_rope(ratio, 0.02)
    return sim


def contradictory(seed):
    sim, _ = tangle(seed)
    return sim


# Laws 18, 19, 21, 24, 36, 43 to 48, 55: piles, gases, walls


def stack(count, size=0.5, *, order=1):
    sim = simulation()
    floor(sim)
    for level in range(count)[::order]:
        place = (0.0, size * (level + 0.5), 0.0)
        spawn(sim, f'box/{level}', Box(width=size, height=size), place)
    return sim


def stack_in_bounds():
    sim = simulation()
    walls(sim, -5.0, 0.0, 5.0, 20.0)
    for level in range(4):
        place = (0.1 * level, 0.5 * (level + 0.5), 0.0)
        spawn(sim, f'box/{level}', Box(width=0.5, height=0.5), place)
    return sim


def arch():
    """Return two posts with a lintel, and a ball that rests on it."""
    sim = simulation()
    floor(sim)
    for number, x in enumerate((-1.0, 1.0)):
        spawn(sim, f'post/{number}', Box(width=0.4, height=2.0), (x, 1.0, 0.0))
    spawn(sim, 'lintel/0', Box(width=2.8, height=0.3), (0.0, 2.15, 0.0))
    spawn(sim, 'ball/0', Disc(radius=0.3), (0.0, 2.6, 0.0))
    return sim


def pile(size, gap):
    sim = simulation()
    floor(sim)
    pyramid(sim, size, gap)
    return sim


def gas(count):
    sim = simulation(gravity=NOWHERE, elasticity=1.0, friction=0.0)
    walls(sim, -5.0, -5.0, 5.0, 5.0)
    chance = random.Random(21)
    for number in range(count):
        at = (number % 10 - 4.5, number // 10 - 4.5, 0.0)
        velocity = (chance.uniform(-5, 5), chance.uniform(-5, 5))
        shape = Disc(radius=chance.uniform(0.1, 0.3))
        spawn(sim, f'disc/{number}', shape, at, velocity=velocity)
    return sim


def row(kind, struck):
    return row_of_elastic_bodies(
        kind, struck=struck, gap=0.0, flight=0.0273, speed=2.0, rate=240.0
    )


def clay():
    sim = simulation(elasticity=0.0)
    floor(sim)
    spawn(sim, 'plate/0', Box(width=2.0, height=0.1), (0.0, 0.05, 0.0), mass=0.1)
    spawn(sim, 'clay/0', Box(width=0.5, height=0.5), (0.1, 2.35, 0.0), mass=2.0)
    return sim


def ball_between_walls():
    sim = walled(0.5)
    spawn(sim, 'ball/0', Disc(radius=0.05), (0.2, 0.0, 0.0), mass=1.0, velocity=(10.0, 0.0))
    return sim


def ball_in_loop():
    sim, _ = ball_in_track(200, 8.0, turns=0.98)
    return sim


def ploughed():
    sim = simulation(gravity=NOWHERE)
    plough(sim, speed=8.0)
    for number in range(6):
        at = (1.0 + 0.15 * number, 0.1 * number - 0.2, 0.0)
        spawn(sim, f'disc/{number}', Disc(radius=0.05), at, mass=1.0)
    return sim


def bar():
    sim, _ = bar_among_discs(20.0)
    return sim


def crowd(count):
    """Drop discs and boxes into a bin."""
    sim, pick = simulation(), random.Random(55)
    walls(sim, -1.5, 0.0, 1.5, 40.0)
    for number in range(count):
        shape = Disc(radius=0.1) if number % 2 else Box(width=0.2, height=0.2)
        x = -1.2 + 0.3 * (number % 9) + pick.uniform(-0.02, 0.02)
        spawn(sim, f'body/{number}', shape, (x, 0.2 + 0.3 * (number // 9), 0.1 * number))
    return sim


def kinematic_pusher():
    sim = simulation(elasticity=0.0)
    floor(sim)
    said = {'kinematic': True, 'velocity': (1.0, 0.0)}
    spawn(sim, 'pusher/0', Box(width=0.2, height=1.0), (-1.0, 0.5, 0.0), **said)
    spawn(sim, 'box/0', Box(width=0.5, height=0.5), (0.0, 0.25, 0.0))
    spawn(sim, 'disc/0', Disc(radius=0.25), (1.0, 0.25, 0.0))
    return sim


# Laws 75 and 76: what rises through one-way platforms, falls onto them, and rolls to rest


def platforms():
    sim = simulation()
    walls(sim, -4.0, 0.0, 4.0, 12.0)
    for number in range(3):
        said = {'anchored': True, 'one_way': (0.0, 1.0), 'closed_sides': number == 1}
        pose = (number - 1.0, 1.0 + number, 0.1 * number)
        spawn(sim, f'platform/{number}', Box(width=3.0, height=0.2), pose, **said)
    wedge = Polygon(outline=((-0.2, -0.1), (0.2, -0.1), (-0.1, 0.2)))
    shapes = (Disc(radius=0.2), Box(width=0.4, height=0.3), wedge)
    for number in range(5):
        said = {'velocity': (0.2 - 0.1 * number, 9.0), 'rolling_resistance': 0.05}
        pose = (1.3 * number - 2.6, 0.4, 0.1 * number)
        spawn(sim, f'thrown/{number}', shapes[number % 3], pose, **said)
    return sim


# Laws 37 to 41 and 51 to 54: floors seen from above, robots, people, applied forces


def sliding_on_floor():
    sim = simulation(gravity=NOWHERE, floor_friction=0.5)
    spawn(sim, 'box/0', Box(width=0.4, height=0.2), velocity=(2.0, 0.5), spin=4.0)
    spawn(sim, 'disc/0', Disc(radius=0.2), (2.0, 0.3, 0.0))
    return sim


def robot(drive, velocity):
    """Have a robot drive against a box that stands before a wall."""
    sim = simulation(gravity=NOWHERE, floor_friction=0.3)
    own = {} if drive['kind'] != 'differential' else {'track': 0.16}
    said = {'drive': {**drive, **own, 'timeout': 0.0}}
    spawn(sim, 'robot/0', Disc(radius=0.1), (0.0, 0.1, 0.1), mass=2.0, robot=said)
    spawn(sim, 'box/0', Box(width=0.2, height=0.2), (0.5, 0.1, 0.0), mass=0.6)
    spawn(sim, 'wall/0', Box(width=0.2, height=2.0), (1.0, 0.0, 0.0), anchored=True)
    sim.perform(DriveRobot(name='robot/0', velocity=velocity))
    return sim


def shipped_robot(name):
    sim = simulation(gravity=NOWHERE, floor_friction=0.5)
    sim.perform(robot_spawn(name))
    spawn(sim, 'box/0', Box(width=0.3, height=0.3), (0.4, 0.05, 0.0), mass=0.3)
    sim.perform(DriveRobot(name='robot/0', velocity=(0.3, 0.0, 0.5)))
    return sim


def people(kind):
    sim = simulation(gravity=NOWHERE, floor_friction=0.3)
    spawn(sim, 'wall/0', Box(width=8.0, height=0.2), (0.0, -2.5, 0.0), anchored=True)
    for number in range(6):
        x, y = 2.0 * math.cos(number), 2.0 * math.sin(number)
        walks = {'kind': kind, 'points': [[-x, -y], [x, y]]}
        spawn(sim, f'person/{number}', Disc(radius=0.2), (x, y, 0.0), mass=70.0, actor=walks)
    return sim


def carts():
    sim = simulation(gravity=NOWHERE, floor_friction=0.3)
    points = [[0.0, 2.0, 0.0], [1.0, 2.0, 1.0], [1.0, 3.0, -2.0]]
    for number in range(3):
        path = {'kind': 'path', 'points': points, 'speed': 0.8, 'start': {'time': 0.2 * number}}
        said = {'kinematic': number == 0, 'actor': path}
        spawn(sim, f'cart/{number}', Box(width=0.2, height=0.3), (0.4 * number, 2.0, 0.0), **said)
    return sim


def thruster():
    sim = simulation(gravity=(0.0, 0.0))
    forces = [{'force': [0.0, 2.0], 'at': [0.5, 0.0], 'axes': 'body'}, {'force': [1.0, 0.0]}]
    spawn(sim, 'body/0', ELL, mass=4.0, forces=forces)
    return sim


def windy_stack():
    """Return a stack that a wind presses on, short of pushing it over."""
    sim = stack(3)
    sim.perform(Configure(changes={'friction': 0.8}))
    wind = [{'force': [0.15, 0.0]}]
    spawn(sim, 'sail/0', Box(width=0.3, height=0.5), (0.0, 1.75, 0.0), forces=wind)
    return sim


# Laws 70 and 71: media


def floats():
    """Return bodies that fall into water; one sinks, one is in a current."""
    sim = simulation(elasticity=0.0)
    said = {'anchored': True, 'sensor': True}
    water = {'density': 10.0, 'drag': 0.0, 'viscosity': 0.1}
    spawn(sim, 'pool/0', Box(width=20.0, height=6.0), (0.0, -3.0, 0.0), medium=water, **said)
    river = {'density': 3.0, 'flow': (1.0, 0.0), 'viscosity': 0.5}
    spawn(sim, 'river/0', Disc(radius=2.0), (8.0, -2.0, 0.4), medium=river, **said)
    spawn(sim, 'box/0', Box(width=1.0, height=0.5), (0.0, 0.2, 0.3), density=5.0)
    spawn(sim, 'disc/0', Disc(radius=0.3), (2.0, 0.5, 0.0), density=4.0)
    spawn(sim, 'ell/0', ELL, (-4.0, 0.1, 0.2), density=6.0)
    log = Chain(points=((-0.6, 0.0), (0.6, 0.0)), thickness=0.3)
    spawn(sim, 'log/0', log, (4.0, 0.3, 0.4), density=5.0)
    spawn(sim, 'pair/0', PAIR, (7.0, -1.0, 0.1), density=3.0)
    spawn(sim, 'stone/0', Disc(radius=0.2), (-7.0, -1.0, 0.0), density=30.0)
    return sim


def leaves():
    """Return bodies that fall in a wind."""
    sim = simulation(air_density=0.05, air_viscosity=0.01, wind=(-3.0, 0.5))
    spawn(sim, 'ell/0', ELL, (0.0, 0.0, 0.2), mass=1.0, spin=1.0)
    spawn(sim, 'disc/0', Disc(radius=0.3), (4.0, 0.0, 0.0), mass=0.1, velocity=(2.0, 5.0))
    spawn(sim, 'pair/0', PAIR, (8.0, 0.0, 0.1), mass=0.2, velocity=(6.0, 0.0))
    triangle = Polygon(outline=((0.0, 0.0), (1.0, 0.0), (0.0, 0.3)))
    spawn(sim, 'leaf/0', triangle, (-4.0, 0.0, 0.0), mass=0.05)
    return sim


# Law 72: attraction


def planets():
    """Return a sun with two planets and a comet, and two charges on one of the planets' ways."""
    sim = simulation(gravity=NOWHERE, gravitation=1.0, coulomb=2.0)
    spawn(sim, 'sun/0', Disc(radius=0.1), mass=4.0, anchored=True)
    for number, (radius, mass) in enumerate(((1.0, 0.01), (1.6, 0.02))):
        said = {'mass': mass, 'velocity': (0.0, math.sqrt(4.0 / radius))}
        spawn(sim, f'planet/{number}', Disc(radius=0.03), (radius, 0.0, 0.0), **said)
    spawn(sim, 'comet/0', ELL, (-5.0, 3.0, 0.2), mass=1e-3, velocity=(1.0, 0.2), charge=0.01)
    spawn(sim, 'ion/0', Disc(radius=0.05), (0.0, 3.0, 0.0), mass=0.1, charge=0.2)
    spawn(sim, 'ion/1', Disc(radius=0.05), (1.0, 3.0, 0.0), mass=0.1, charge=-0.1)
    return sim


@cache
def far_away():
    """Return a world of much that could change what happens far from it."""
    sim, _ = tangle(3)
    said = {'a': 'spun/0', 'b': 'world', 'rate': 3.0, 'max_torque': 50.0}
    spawn(sim, 'spun/0', Box(width=1.0, height=0.1), (8.0, 4.0, 0.0))
    join(sim, 'motor/0', 'motor', [(8.0, 4.0)], **said)
    spawn(sim, 'grain/0', Disc(radius=0.002), (-8.0, 0.002, 0.0))
    pick = random.Random(4)
    for number in range(20):
        place = (10.0 + 0.5 * (number % 5), 0.5 + 0.5 * (number // 5), 0.0)
        said = {'elasticity': 1.0, 'velocity': (pick.uniform(-3.0, 3.0), 0.0)}
        spawn(sim, f'disc/{number}', Disc(radius=0.2), place, **said)
    return beginning(sim.save())


@cache
def _drawn(name):
    return drawn_scene(f'drawings/{name}').save()


# Of laws of flight, impacts, friction and pendulums: each is played in 20 ms.
SMALL = {
    'projectiles': Scene(build=projectiles),
    'projectiles in air': Scene(build=projectiles_in_air),
    'head-on, elastic': Scene(build=partial(head_on, 1.0)),
    'head-on, clay': Scene(build=partial(head_on, 0.0)),
    'pairs that meet': Scene(build=meetings),
    'discs that meet fast': Scene(build=quick_meetings),
    'walls, thin ones too': Scene(build=on_walls, seconds=0.75),
    'disc bounces': Scene(build=partial(bounce, Disc(radius=0.2), 0.8)),
    'box falls flat': Scene(build=partial(bounce, PLANK, 0.5)),
    'polygons fall flat': Scene(build=flat_polygons),
    'box falls on a corner': Scene(build=partial(bounce, PLANK, 0.5, 0.4)),
    'nine bounce': Scene(build=bounces, seconds=0.75),
    'disc with spin bounces': Scene(build=bouncing_disc),
    'discs on plates': Scene(build=partial(on_plates, 0.9)),
    'dull discs on plates': Scene(build=partial(on_plates, 0.3)),
    'corners on plates': Scene(build=corners_on_plates, seconds=0.6),
    'smooth pairs': Scene(build=partial(pairs_of_all_kinds, 0.0)),
    'rough pairs': Scene(build=partial(pairs_of_all_kinds, 0.5)),
    'incline': Scene(build=incline),
    'block that sticks': Scene(build=partial(block_on_incline, 26.0)),
    'block that slides': Scene(build=partial(block_on_incline, 28.0)),
    'box that tips': Scene(build=partial(tips_on_incline, 1.05)),
    'box that does not tip': Scene(build=partial(tips_on_incline, 0.95)),
    'fridge pushed high': Scene(build=partial(fridge, 1.2)),
    'fridge pushed low': Scene(build=partial(fridge, 0.6)),
    'ladder': Scene(build=leaning_ladder),
    'disc that comes to roll': Scene(build=comes_to_roll),
    'box that slides': Scene(build=sliding_box),
    'pendulum': Scene(build=partial(pendulum, math.pi / 2)),
    'double pendulum': Scene(build=double_pendulum),
    'spring': Scene(build=mass_on_spring),
    'damped spring': Scene(build=partial(mass_on_spring, 2.0)),
    'pendulum beside a damper': Scene(build=partial(pendulum_beside_damper, 0.1)),
    'cradle': Scene(build=cradle),
    'balls on rods': Scene(build=partial(balls_on_rods, 30.0)),
    'one-way platforms': Scene(build=platforms, seconds=2.5),
}


def _laws():
    """Return the other scenes of laws, by name."""
    chaotic = partial(Scene, chaotic=True)
    yield from {
        'four bars': Scene(build=four_bars),
        'chain of 5': Scene(build=partial(hanging_chain, 5)),
        'chain of 30': Scene(build=partial(hanging_chain, 30)),
        'beam': Scene(build=partial(beam, 0.0)),
        'beam with a load': Scene(build=partial(beam, 2.0)),
        'beam on 3 ropes': Scene(build=partial(beam_on_joints, 'rope', 3)),
        'motor': Scene(build=partial(arm_on_motor, 100.0)),
        'motor that stalls': Scene(build=partial(arm_on_motor, 1.0)),
        'gears': Scene(build=partial(gears, -2.0)),
        'slider between limits': Scene(build=slider),
        'axle between limits': Scene(build=limited_axle),
        'rope that becomes taut': Scene(build=slack_rope),
        'rod that is too weak': Scene(build=partial(weight_on, 'rod', 0.0, 20.0)),
        'four-bar linkage': Scene(build=four_bar),
        'sled on a rope': Scene(build=sled_on_rope),
        'car': Scene(build=partial(driving_car, 0.5)),
        'car that lifts its front': Scene(build=partial(driving_car, 1.04), seconds=0.6),
        'stepladder': Scene(build=partial(stepladder, 0.9)),
        'seesaw': chaotic(build=seesaw),
        'bridge': Scene(build=partial(bridge_with_load, 'axle', 0.05, 10.0), seconds=1.0),
        'rope on a drum': Scene(build=partial(rope_on_drum, 2.4), seconds=0.5),
        'stack of 3': Scene(build=partial(stack, 3)),
        'stack of 10': Scene(build=partial(stack, 10)),
        'stack of 10 from the top': Scene(build=partial(stack, 10, order=-1)),
        'stack in bounds': Scene(build=stack_in_bounds),
        'arch': Scene(build=arch),
        'box falls on a stack': Scene(build=partial(falls_on_stack, 1.0)),
        'coin falls on a stack': Scene(build=partial(falls_on_stack, 0.01)),
        'house falls on a stack': Scene(build=partial(falls_on_stack, 10.0)),
        'clay on a plate': Scene(build=clay),
        'ball between walls': Scene(build=ball_between_walls),
        'ball in a loop': Scene(build=ball_in_loop),
        'plough': Scene(build=ploughed, seconds=0.5),
        'pusher': Scene(build=kinematic_pusher),
        'pyramid of 105': Scene(build=partial(pile, 0.5, 0.1), seconds=0.75),
        'gas of 60': chaotic(build=partial(gas, 60)),
        'bar among discs': chaotic(build=bar, seconds=0.5),
        'crowd of 60': chaotic(build=partial(crowd, 60)),
        'slides on a floor': Scene(build=sliding_on_floor),
        'conveyor': Scene(build=partial(on_conveyors, 0.4)),
        'people of ORCA': Scene(build=partial(people, 'orca')),
        'people of social forces': Scene(build=partial(people, 'social_force')),
        'carts on paths': Scene(build=carts),
        'thruster': Scene(build=thruster),
        'block that is pulled': Scene(build=partial(pulled_block, 8.0)),
        'stack in the wind': Scene(build=windy_stack),
        'floats': Scene(build=floats),
        'leaves in the wind': Scene(build=leaves),
        'planets and ions': Scene(build=planets),
    }.items()
    for kind in ('axle', 'rod', 'rope'):
        yield f'pendulum by a(n) {kind} on a box', Scene(build=partial(pendulum_on_box, kind))
    for kind in ('axle', 'rod', 'slider'):
        yield f'two bars by a(n) {kind} in space', Scene(build=partial(bars_in_space, kind))
    for kind, struck in itertools.product(('discs', 'boxes', 'mixed'), (1, 2)):
        yield (
            f'row of {kind}, {struck} struck',
            Scene(build=partial(row, kind, struck), seconds=0.4),
        )
    for seed, kinds in enumerate(
        ((round_shape, round_shape), (round_shape, angular_shape), (angular_shape,) * 2)
    ):
        yield f'pair in flight {seed}', Scene(build=partial(pair, kinds, seed), seconds=0.5)
    for seed in range(3):
        machine, tangled = partial(random_world, seed), partial(contradictory, seed)
        yield f'random machine {seed}', Scene(build=machine, chaotic=seed == 0)
        yield f'tangle {seed}', Scene(build=tangled, chaotic=seed == 2)
        yield f'random crowd {seed}', chaotic(build=partial(random_crowd, seed))
    for kind, velocity in (
        ('differential', (0.4, 0.0, 0.3)),
        ('omni', (0.4, 0.1, 0.0)),
        ('car', (0.4, 0.0, 0.2)),
    ):
        drive = {**DRIVE, 'kind': kind} if kind == 'differential' else {'kind': kind}
        yield f'{kind} robot', Scene(build=partial(robot, drive, velocity))


# Of shipped worlds and drawings.
CHAOTIC = {'world catapult', 'world galton', 'drawing catapult', 'drawing seesaw'}


def _shipped():
    """Return the shipped worlds, lessons, drawings and robots, by name."""
    for name in sorted(worlds_in(shipped_worlds())):
        yield f'world {name}', partial(state_of, name)
    for name in sorted(worlds_in(shipped_lessons())):
        yield f'lesson {name}', partial(state_of, name)
    for name in sorted(drawings()):
        yield f'drawing {name}', partial(_drawn, name)
    for name in ('mouse', 'turtlebot3_burger', 'omni', 'car'):
        yield f'robot {name}', partial(shipped_robot, name)


SCENES = SMALL | dict(_laws())
SCENES |= {name: Scene(build=build, chaotic=name in CHAOTIC) for name, build in _shipped()}
