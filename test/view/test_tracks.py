# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Entities beside the bodies: plots, the track of time, scans and paths of robots."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from physsim_ros.files import state_from
from physsim_ros.model.preview import Preview
from physsim_ros.model.requests import DriveRobot
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Frame, NO_CONTACTS
from physsim_ros.simulation.simulation import Simulation
import pytest

from .picture_file import body, chunk, contacts, frame, scene


def test_energies_and_momenta_are_plotted(recording):
    now = frame(scene(body()), [(2, 3, 0)])

    recording.draw(now)

    kinetic, potential = now.snapshot.kinetic_energy, now.snapshot.potential_energy
    energies = recording.last('plots/energy', 'Scalars:scalars')
    assert energies == pytest.approx([kinetic, potential, 0.0, kinetic + potential])
    # 2 kg at 1 m/s along x and y, at (2, 3), and a moment of 5/6 kg m² at 1 rad/s.
    assert recording.last('plots/momentum', 'Scalars:scalars') == pytest.approx([2.0, 2.0])
    about = recording.last('plots/angular_momentum', 'Scalars:scalars')
    assert about == pytest.approx(2 * (2 - 3) + 5 / 6)


@pytest.mark.parametrize(('speed', 'factor', 'shown'), [(4.0, 2.0, 0.5), (-1.0, -1.0, 1.0)])
def test_the_real_time_factor_is_by_the_speed_that_was_asked(recording, speed, factor, shown):
    recording.draw(frame(scene(body()), [(0, 3, 0)], speed=speed), real_time_factor=factor)

    assert recording.last('plots/pace', 'Scalars:scalars') == pytest.approx(shown)


@pytest.mark.parametrize(('speed', 'factor'), [(1.0, 0.0), (0.0, 0.5)])
def test_a_world_that_nothing_paces_or_that_has_just_paused_has_no_factor(
    recording, speed, factor
):
    recording.draw(frame(scene(body()), [(0, 3, 0)], speed=speed), real_time_factor=factor)

    assert recording.rows('plots/pace', 'Scalars:scalars') == []


def test_counts_are_those_of_the_scene_and_of_its_contacts(recording):
    two = scene(body(), body('box/1'))
    measured = replace(frame(two, [(0.0, 0.0, 0.0)] * 2), contacts=NO_CONTACTS)
    # Of the others nobody has measured the contacts.
    recording.draw(measured, *(frame(two, [(x, 0.0, 0.0)] * 2) for x in range(1, 20)))

    rows = recording.rows('plots/counts', 'Scalars:scalars')
    assert [(row.frame, [*row.value]) for row in rows] == [(0, [2.0, 0.0, 0.0])]
    assert len(recording.rows('plots/energy', 'Scalars:scalars')) > 1


EMPTY = scene()


def at_speed(speed):
    return frame(EMPTY, [], speed=speed)


def states(recording, *batches):
    """Draw frames, and return what stands on the track: number of the frame, and state."""
    for frames in batches:
        recording.draw(*frames)
    rows = recording.rows('time/run', 'StateChange:state')
    return [(row.frame, str(row.value[0])) for row in rows]


def test_each_change_of_the_run_state_stands_once(recording):
    speeds = [1.0, 1.0, 0.0, 0.0, -1.0, -4.0, -4.0, 4.0, 1.0]
    assert states(recording, [at_speed(speed) for speed in speeds]) == [
        (0, 'play'), (2, 'pause'), (4, 'back'), (5, 'fast back'), (7, 'fast'), (8, 'play')
    ]  # fmt: skip


def colors_of_states(recording):
    """Return the colours of the states of the run, by state."""
    (batch,) = (
        each.to_record_batch()
        for each in chunk.RrdReader(recording.path).stream()
        if each.entity_path == '/time/run' and each.is_static
    )
    columns = {name.rpartition(':')[2]: batch[name].to_pylist()[0] for name in batch.schema.names}
    return dict(zip(columns['values'], columns['colors'], strict=True))


def test_every_speed_is_a_state_that_has_a_colour_and_the_faster_is_darker(recording):
    speeds = [-64.0, -4.0, -1.001, -1.0, -0.1, 0.0, 0.1, 0.999, 1.0, 3.0, 64.0]
    rows = states(recording, [at_speed(speed) for speed in speeds])
    names = [state for _, state in rows]
    assert names == ['fast back', 'back', 'slowly back', 'pause', 'slow', 'play', 'fast']
    colors = colors_of_states(recording)
    # Of red, green and blue, a byte each, before alpha.
    light = [sum((colors[state] >> 8 * byte) & 255 for byte in (1, 2, 3)) for state in names]
    assert light[0] < light[1] < light[2]
    assert light[4] > light[5] > light[6]


def test_a_state_goes_on_from_one_batch_to_the_next(recording):
    rows = states(recording, [at_speed(1.0)] * 3, [at_speed(1.0)] * 3, [at_speed(0.0)])
    assert rows == [(0, 'play'), (6, 'pause')]


def test_the_past_that_is_played_is_told(recording):
    sim = Simulation(physics_rate=240, publish_rate=60)
    frames = []
    for tick in range(40):
        if tick in {10, 15}:
            sim.speed = -sim.speed
        frames += sim.advance(tick * 16_666_667)
    rows = states(recording, frames)
    assert [state for _, state in rows] == ['play', 'back', 'past', 'play']


LEGEND = 'world/camera/legend/labels'
TEN_A_SECOND = [
    ('plots/energy', 'Scalars:scalars'),
    ('world/labels', 'Points3D:positions'),
    ('world/camera/legend/time', 'Points2D:labels'),
]
POSITIONS, STRIPS = 'Points3D:positions', 'LineStrips3D:strips'
WALL = {'name': 'wall/0', 'box': {'width': 0.2, 'height': 9}, 'at': [2.1, 0], 'anchored': True}
ROBOT = {'name': 'tb3/0', 'robot': 'turtlebot3_burger', 'at': [0, 0]}


def frames_of(*bodies, count=60, skipped=0, velocity=None):
    """Return the frames of a second of a world that is seen from above."""
    simulation = Simulation(settings=WorldSettings())
    content = {'format': 1, 'gravity': [0, 0], 'bodies': [*bodies]}
    simulation.load(state_from(content, simulation.settings, simulation.physics_rate))
    for each in bodies if velocity else ():
        simulation.perform(DriveRobot(name=each['name'], velocity=velocity))
    simulation.world.step(4 * skipped)
    frames = []
    for _ in range(count):
        frames.append(Frame(snapshot=simulation.world.snapshot(), contacts=None))
        simulation.world.step(4)
    return frames


def test_beams_that_hit_are_points_where_they_hit_at_the_rate_of_the_laser(recording):
    recording.draw(*frames_of(WALL, ROBOT))

    rows = recording.rows('world/scans', POSITIONS)
    # 5 Hz, and the first frame.
    assert 5 <= len(rows) <= 6
    assert rows[0].frame == 0
    # The wall is in reach from 2 m away on: some 110 of 360 beams, with noise of 1 cm.
    assert 90 < len(rows[0].value) < 130
    assert rows[0].value[:, 0] == pytest.approx(np.full(len(rows[0].value), 2.0), abs=0.1)


def test_scans_go_with_the_last_robot(recording):
    recording.draw(*frames_of(WALL, ROBOT, count=2))
    recording.draw(*frames_of(WALL, count=2))

    first, last = recording.rows('world/scans', POSITIONS)
    assert len(first.value)
    assert not len(last.value)


def test_a_world_without_robots_has_no_scans(recording):
    recording.draw(*frames_of(WALL, count=2))

    assert recording.rows('world/scans', POSITIONS) == []


@pytest.mark.parametrize('skipped', [0, 30])
def test_odometry_without_slip_is_the_way_and_with_slip_it_parts_from_it(recording, skipped):
    robots = [
        {
            'name': f'{name}/0',
            'at': [1, y, 0.5],
            'robot': {'from': 'turtlebot3_burger', 'odometry': {'slip': [slip, slip]}},
        }
        for y, name, slip in ((0, 'exact', 0), (2, 'slips', 0.2))
    ]
    frames = frames_of(*robots, count=25, skipped=skipped, velocity=(0.2, 0.0, 0.5))

    recording.draw(*frames)

    truth, odometry = (
        recording.rows(f'world/ways/{which}', STRIPS) for which in ('truth', 'odometry')
    )
    assert [row.frame for row in truth] == [0, 6, 12, 18, 24]
    places = np.array([row.value for row in truth])[:, :, 1, :2]
    poses = np.array([frame.snapshot.poses[:, :2] for frame in frames[::6]])
    assert places == pytest.approx(poses, abs=1e-6)
    reckoned = np.array([row.value for row in odometry])[:, :, 1, :2]
    # Both begin where the robot is as it is first seen.
    off = np.linalg.norm(reckoned - places, axis=2)
    assert off[0] == pytest.approx(0.0, abs=1e-6)
    assert off[:, 0] == pytest.approx(0.0, abs=1e-5)
    assert off[-1, 1] > 1e-4


@pytest.mark.parametrize('between', [[WALL], [{**ROBOT, 'name': 'other/0'}]])
def test_a_robot_that_is_new_has_no_way_of_one_of_its_name(recording, between):
    recording.draw(*frames_of(ROBOT, count=7, velocity=(0.2, 0.0, 0.5)))
    recording.draw(*frames_of(*between, count=7))
    # It has driven before it is seen.
    new = {**ROBOT, 'at': [3, 4, 1.0]}
    recording.draw(*frames_of(new, count=7, skipped=30, velocity=(0.2, 0.0, 0.5)))

    truth, odometry = (
        recording.rows(f'world/ways/{which}', STRIPS)[-1].value for which in ('truth', 'odometry')
    )

    assert odometry[0, 1] == pytest.approx(truth[0, 1], abs=0.02)


def test_the_image_of_the_world_tells_time_and_that_it_goes_back(recording):
    forth, back = frame(EMPTY, []), at_speed(-1.0)
    recording.draw(replace(forth, snapshot=replace(forth.snapshot, stamp=1_250_000_000)))
    recording.draw(back)

    labels = recording.rows('world/camera/legend/time', 'Points2D:labels')
    assert [str(row.value[0]) for row in labels] == ['1.25 s  play', '0.00 s  back']


@pytest.mark.parametrize('rate', [30, 60, 1000])
def test_rows_are_as_far_apart_in_time_at_every_rate_of_frames(recording, rate):
    box, read = scene(body(label='box')), Preview(lines=(((0, 0), (3, 4)),), label='wall 90%')
    frames = []
    for number in range(4 * rate + 1):
        pushed = contacts((0.0, -19.0 / rate))
        each = frame(box, [(number / rate, 0, 0)], contacts=pushed, preview=read)
        snapshot = replace(each.snapshot, stamp=round(number * 1e9 / rate))
        frames.append(replace(each, snapshot=snapshot))

    recording.draw(*frames)
    recording.draw(replace(frames[-1], speed=0.0, stepped=False))

    for entity, column in TEN_A_SECOND:
        assert len(recording.rows(entity, column)) == pytest.approx(41, abs=1)
    assert len(recording.rows('world/velocities', 'Arrows3D:vectors')) == pytest.approx(27, abs=2)
    shown, ended = recording.rows('world/preview/lines', 'LineStrips3D:strips')[:2]
    assert (ended.recorded - shown.recorded) * 1e-9 == pytest.approx(3.0, abs=1 / rate)
    legend = [str(row.value[0]) for row in recording.rows(LEGEND, 'Points2D:labels')]
    assert [text.startswith('contact force: this length = 20 N ') for text in legend] == [True]
    states = recording.rows('time/run', 'StateChange:state')
    assert (states[-1].recorded * 1e-9) == pytest.approx(4.0 + 1 / rate)
