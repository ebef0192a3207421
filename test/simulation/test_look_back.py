# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A look at the past, and back at the end, changes no result of any public call."""

from collections.abc import Callable
from typing import Any

import numpy as np
from physsim_ros import (
    find_world,
    load_world,
    Robot,
    robot_spawn,
    SavedMoment,
    Simulation,
)
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.requests import Command, DriveRobot, Grab
from physsim_ros.model.snapshot import Frame
from physsim_ros.sensing import SensedFrame
from physsim_ros.simulation.past import Past
from physsim_ros.simulation.ticks import Ticks
from physsim_ros.simulation.world import World
import pytest

from .driven import OVERDUE

SECOND = 10**9
# Length of the past, the time that is looked at, and one between them [ns].
END, EARLIER, BETWEEN = 2 * SECOND, SECOND // 2, 5 * SECOND // 4
Call = Callable[[Robot], Any]


def of_simulation(call: Callable[[Simulation], Any]) -> Call:
    return lambda robot: call(robot.simulation)


def moved(simulation: Simulation) -> str:
    twists = np.array(((0.1, 0.0, 0.0),))
    poses = np.array(((0.5, 0.0, 0.0),))
    return simulation.perform(Command(names=('robot/0',), poses=poses, twists=twists))


def set_reporting(simulation: Simulation) -> None:
    simulation.reports_contacts = False
    simulation.reports_contacts = True


def set_speed(simulation: Simulation) -> None:
    simulation.speed = -1.0
    simulation.speed = 1.0


def course_left(simulation: Simulation) -> str:
    simulation.seek(BETWEEN)
    moved(simulation)
    return simulation.return_to_course(1)


OF_SIMULATION: dict[str, Call] = {
    'advance': of_simulation(lambda it: it.advance(SECOND)),
    'advance_frame': of_simulation(Simulation.advance_frame),
    'apply_requests': of_simulation(Simulation.apply_requests),
    'begin': of_simulation(lambda it: it.begin(it.save())),
    'checkpoint': of_simulation(Simulation.checkpoint),
    'is_past': of_simulation(lambda it: it.is_past),
    'stamp': of_simulation(lambda it: it.stamp),
    'forces_now': of_simulation(lambda it: it.forces_now(it.frame.snapshot)[1]),
    'frame': of_simulation(lambda it: it.frame),
    'open_world': of_simulation(lambda it: it.open_world(it.save())),
    'keep_driving': of_simulation(
        lambda it: it.keep_driving(DriveRobot(name='robot/0', velocity=(0.1, 0.0, 0.0)))
    ),
    'limit_history': of_simulation(lambda it: it.limit_history(1.0)),
    'limit_memory': of_simulation(lambda it: it.limit_memory(64.0)),
    'load': of_simulation(lambda it: it.load(it.save())),
    'loaded': of_simulation(lambda it: it.loaded),
    'place': of_simulation(lambda it: it.place('robot/0', 0.5, 0.0)),
    'perform': of_simulation(moved),
    'redo': of_simulation(lambda it: (it.undo(), it.redo())),
    'reports_contacts': of_simulation(set_reporting),
    'reset': of_simulation(lambda it: it.reset(3)),
    'restore': of_simulation(lambda it: it.restore(it.checkpoint())),
    'return_to_course': of_simulation(course_left),
    'run': of_simulation(lambda it: it.run(0.5)),
    'saver': of_simulation(Simulation.saver),
    'saver_of_run': of_simulation(Simulation.saver_of_run),
    'save': of_simulation(Simulation.save),
    'seek': of_simulation(lambda it: it.seek(BETWEEN)),
    'settings': of_simulation(lambda it: it.settings),
    'speed': of_simulation(set_speed),
    'status': of_simulation(lambda it: it.status),
    'step': of_simulation(lambda it: it.step),
    'undo': of_simulation(Simulation.undo),
    'sensed': of_simulation(lambda it: it.sensed),
    'world': of_simulation(lambda it: it.world),
}
OF_TICKS: dict[str, Call] = {
    'advance': of_simulation(lambda it: it.ticks.advance(SECOND, OVERDUE)),
    'continue_work': of_simulation(lambda it: it.ticks.continue_work(lambda: False)),
    'pass_frames': of_simulation(lambda it: it.ticks.pass_frames(3)),
    'run': of_simulation(lambda it: it.ticks.run(3)),
}
OF_ROBOT: dict[str, Call] = {
    'battery': Robot.battery,
    'bumped': lambda robot: robot.bumped,
    'description': lambda robot: robot.description,
    'drive': lambda robot: robot.drive(-0.1, 0.5),
    'first_laser': lambda robot: robot.first_laser,
    'odom': Robot.odom,
    'place': lambda robot: robot.place(0.5, 0.0, 1.0),
    'read': lambda robot: robot.read('imu'),
    'scan': Robot.scan,
    'truth': Robot.truth,
}
LOOKS: dict[str, Call] = {
    'world': lambda robot: robot.simulation.world.digest(),
    'frame': lambda robot: robot.simulation.frame,
    'scan': Robot.scan,
    'rewind': lambda robot: robot.simulation.apply_requests(),
}


def driven() -> Robot:
    """Return a robot that has driven to the end of its past, and drives on."""
    simulation = Simulation(checkpoints=0.5)
    simulation.begin(load_world(find_world('corridor')))
    simulation.perform(robot_spawn('turtlebot3_burger', name='robot/0', at=(0.0, 0.0)))
    robot = Robot(simulation, 'robot/0')
    while simulation.stamp < END:
        if simulation.step % 120 == 0:
            robot.drive(0.2, 0.1)
        simulation.advance_frame()
    return robot


def look_back(robot: Robot, look: Call | None) -> None:
    """Go to the past, look at it in a way, and return to the end, whose frame is cached."""
    robot.simulation.seek(EARLIER)
    if look is not None:
        look(robot)
    robot.simulation.seek(END)


def told(result: Any) -> object:
    """Return what can be compared of a result."""
    match result:
        case SavedMoment():
            simulation = Simulation()
            simulation.restore(result)
            return result.checkpoint.step, simulation.world.digest()
        case WorldState():
            simulation = Simulation()
            simulation.begin(result)
            return simulation.world.digest()
        case Past():
            return result.cursor.moment
        case World():
            return result.digest()
        case _ if callable(result):
            # It saves.
            return told(result())
        case SensedFrame():
            return told(result.frame)
        case Frame():
            return result.snapshot.step, result.snapshot.poses.tobytes(), result.past
        case tuple() if result and isinstance(result[0], Frame):
            return [told(each) for each in result]
        case np.ndarray():
            return result.tobytes()
    return str(result)


def outcome(call: Call, look: Call | None) -> tuple[object, ...]:
    """Return what a call tells after a look back, and the world after it and half a second on."""
    robot = driven()
    look_back(robot, look)
    result = told(call(robot))
    simulation = robot.simulation
    step, digest = simulation.step, simulation.world.digest()
    simulation.run(0.5)
    return result, step, digest, simulation.world.digest()


def public_names(kind: type) -> set[str]:
    return {name for name in dir(kind) if not name.startswith('_')}


def test_all_public_names_are_called():
    assert OF_SIMULATION.keys() == public_names(Simulation)
    assert OF_TICKS.keys() == public_names(Ticks)
    assert OF_ROBOT.keys() == public_names(Robot)


CALLS = [*OF_SIMULATION.items(), *OF_ROBOT.items(), *OF_TICKS.items()]


@pytest.mark.parametrize('call', [pytest.param(call, id=name) for name, call in CALLS])
def test_a_look_back_changes_no_public_call(call):
    assert outcome(call, LOOKS['world']) == outcome(call, None)


@pytest.mark.parametrize('look', LOOKS)
def test_no_kind_of_look_changes_a_checkpoint(look):
    call = OF_SIMULATION['checkpoint']
    assert outcome(call, LOOKS[look]) == outcome(call, None)


def test_a_checkpoint_after_a_look_back_has_no_grip_of_a_hand():
    robot = driven()
    robot.simulation.perform(Grab(hand='hand', point=robot.truth().pose[:2]))
    robot.simulation.advance_frame()
    end = robot.simulation.frame.snapshot.stamp
    robot.simulation.seek(EARLIER)
    robot.simulation.world.digest()
    robot.simulation.seek(end)
    moment = robot.simulation.checkpoint()
    assert moment.checkpoint.step == round(end * 240 / SECOND)
    robot.simulation.restore(moment)
    assert not robot.simulation.world.grips
