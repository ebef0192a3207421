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

"""Going back and the same way again: branches, undo, what is kept, and what is told."""

from __future__ import annotations

from collections.abc import Callable
import gc
from pathlib import Path
from typing import Any

import numpy as np
from physsim_ros.files import load_world, save_world
from physsim_ros.model.errors import OutOfHistory
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import (
    Anchor,
    Command,
    Configure,
    Delete,
    DeleteAll,
    Join,
    Pin,
    Release,
    Request,
    Restore,
    Unjoin,
    UnjoinAll,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Answer, Frame
from physsim_ros.simulation.frame_segment import CachedFrame
from physsim_ros.simulation.records import Entry
from physsim_ros.simulation.simulation import CHECKPOINTS, Simulation
from physsim_ros.simulation.world import World
import pytest

from ..building import BOX, DISC, spawning

FRAME = 4
SECOND = 10**9
FLOOR = WorldSettings(bounds=(-10.0, 0.0, 10.0, 20.0))


class Driven:
    """A simulation, the time that it is handed, and what it showed of each step."""

    def __init__(self, **options: float) -> None:
        self.simulation = Simulation(settings=FLOOR, **options)
        self.now = 0
        self.shown: dict[int, Frame] = {}

    def run(self, speed: float, seconds: float) -> list[Frame]:
        """Run for seconds on the wall, and return the frames."""
        self.simulation.speed = speed
        frames: list[Frame] = []
        for _ in range(round(seconds * 60)):
            frames += self.tick()
        return frames

    def tick(self) -> tuple[Frame, ...]:
        """Go on by a tick of the node, and return its frames."""
        self.now += round(SECOND / 60)
        return self.simulation.advance(self.now)

    def record(self, seconds: float) -> None:
        for frame in self.run(1.0, seconds):
            self.shown[frame.snapshot.step] = frame

    def ask(self, request: Request, *, joined: bool = False) -> None:
        self.simulation.requests.submit(request, topic='~/test', joined=joined)

    def settle(self) -> Frame:
        frame = self.simulation.settle()
        assert frame is not None
        return frame

    @property
    def names(self) -> tuple[str, ...]:
        return self.simulation.world.snapshot().scene.names

    def assert_same(self, frame: Frame) -> None:
        before = self.shown[frame.snapshot.step].snapshot
        np.testing.assert_array_equal(frame.snapshot.poses, before.poses)
        np.testing.assert_array_equal(frame.snapshot.twists, before.twists)
        np.testing.assert_array_equal(frame.snapshot.forces, before.forces)


@pytest.fixture
def driven() -> Driven:
    """Return a world in which boxes have fallen on each other for five seconds."""
    driven = Driven()
    for number in range(5):
        driven.ask(spawning(f'a/{number}', BOX, (0.2 * number, 1.0 + 1.5 * number, 0.1)))
    driven.record(3.0)
    driven.ask(spawning('late/0', BOX, (0.0, 9.0, 0.0)))
    driven.record(2.0)
    return driven


def told(frames: list[Frame], topic: str) -> list[Answer]:
    return [answer for frame in frames for answer in frame.answers if answer.topic == topic]


@pytest.mark.parametrize('speed', [-1.0, -4.0, -2.0, -64.0])
def test_rewinding_shows_every_frame_as_it_was(driven: Driven, speed: float) -> None:
    head = driven.simulation.step
    frames = driven.run(speed, 1.0)
    steps = [frame.snapshot.step for frame in frames]
    # The first tick only says that it goes back from now on.
    assert steps == [max(0, head + number * round(speed) * FRAME) for number in range(len(steps))]
    assert len(steps) > 5
    for frame in frames:
        if frame.snapshot.step:
            driven.assert_same(frame)


def test_slow_motion_goes_back_step_by_step(driven: Driven) -> None:
    frames = driven.run(-0.1, 1.0)
    steps = [frame.snapshot.step for frame in frames]
    assert len(steps) == pytest.approx(24, abs=1)
    assert set(np.diff(steps)) == {-1}
    for frame in frames:
        if frame.snapshot.step % FRAME == 0:
            driven.assert_same(frame)


def test_the_past_is_the_same_where_it_has_to_be_made_again(
    driven: Driven, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(driven.simulation.past.frame_cache, 'budget', 0)
    driven.simulation.past.frame_cache.drop_from(0)
    for frame in driven.run(-1.0, 4.5):
        driven.assert_same(frame)


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Count the steps that all worlds make, from the last number on."""
    counts = [0]
    step = World.step

    def counted(world: World, count: int) -> tuple[str, ...]:
        counts[-1] += count
        return step(world, count)

    monkeypatch.setattr(World, 'step', counted)
    return counts


def most_made(driven: Driven, made: list[int], ticks: int) -> int:
    """Return the number of steps of the tick that made most."""
    first = len(made)
    for _ in range(ticks):
        made.append(0)
        driven.tick()
    return max(made[first:])


@pytest.mark.parametrize('speed', [-1.0, -0.5, -0.1, -2.0])
def test_no_tick_makes_many_steps_while_time_goes_back(made: list[int], speed: float) -> None:
    driven = Driven()
    driven.record(9.0)
    # Of the last seconds nothing is known at first but the frames that were shown.
    driven.run(speed, 0.2)
    # Three seconds are made again while three seconds are shown.
    assert most_made(driven, made, round(240 / -speed)) <= max(2.0, -2 * speed * FRAME)
    assert driven.simulation.step == pytest.approx(5 * 240, abs=100)


@pytest.mark.parametrize('on', [0.5, 2.5])
def test_what_a_seek_left_out_is_made_again_in_time(made: list[int], on: float) -> None:
    driven = Driven()
    driven.record(12.0)
    driven.simulation.past.frame_cache.drop_from(0)
    driven.simulation.seek(round(4.5 * SECOND))
    driven.settle()
    driven.run(1.0, on)
    driven.run(-1.0, 0.05)
    # Three seconds are made again in the time from the seek on.
    assert most_made(driven, made, round(60 * (on + 1.0))) <= 3 * FRAME * CHECKPOINTS / on
    assert driven.simulation.step < 4 * 240


def test_where_frames_were_far_apart_no_others_are_made(made: list[int]) -> None:
    driven = Driven()
    driven.ask(spawning('a/0'))
    driven.run(16.0, 1.0)
    driven.simulation.speed = -16.0
    assert most_made(driven, made, 55) == 0
    assert driven.simulation.step < 2 * 240


def test_what_is_half_made_again_ends_no_earlier_than_time_has_come_since(driven: Driven) -> None:
    driven.simulation.past.frame_cache.drop_from(0)
    driven.simulation.seek(round(4.8 * SECOND))
    driven.settle()
    driven.run(1.0, 0.2)
    # Frames before the seek begin to be replayed, up to now.
    driven.run(-1.0, 0.05)
    driven.run(8.0, 0.1)
    frames = driven.run(-1.0, 1.0)
    assert frames[0].snapshot.step > 1300
    for frame in frames:
        if frame.snapshot.step in driven.shown:
            driven.assert_same(frame)


def test_at_the_oldest_step_time_stops_and_says_so(driven: Driven) -> None:
    frames = driven.run(-64.0, 1.0)
    assert frames[-1].snapshot.step == 0
    assert driven.simulation.speed == 0.0
    assert len(told(frames, 'history')) == 1
    again = driven.run(-1.0, 0.1)
    assert len(told(again, 'history')) == 1
    assert not any(frame.moved for frame in again)
    assert driven.run(0.0, 0.5) == []


@pytest.mark.parametrize('back', [0.5, 2.0, 4.9])
def test_playing_on_from_the_past_gives_the_same_bits(driven: Driven, back: float) -> None:
    head = driven.simulation.step
    driven.run(-1.0, back)
    frames = driven.run(1.0, back)
    assert frames[-1].snapshot.step == pytest.approx(head, abs=2 * FRAME)
    for frame in frames:
        if frame.snapshot.step <= head:
            driven.assert_same(frame)
    assert told(frames, 'divergence') == []


def test_fast_forward_over_the_past_gives_the_same_bits(driven: Driven) -> None:
    driven.simulation.seek(0)
    for frame in driven.run(8.0, 0.5):
        driven.assert_same(frame)


def test_a_request_in_the_past_drops_what_lay_ahead(driven: Driven) -> None:
    driven.run(-1.0, 1.0)
    step = driven.simulation.step
    driven.ask(spawning('other/0', BOX, (5.0, 5.0, 0.0)))
    frame = driven.settle()
    assert [answer.topic for answer in frame.answers] == ['~/test', 'branch']
    assert frame.snapshot.step == step
    with pytest.raises(OutOfHistory, match='not in the history'):
        driven.simulation.seek(round((step + FRAME) / 240 * SECOND))


def test_a_refused_request_in_the_past_drops_nothing(driven: Driven) -> None:
    head = driven.simulation.step
    driven.run(-1.0, 1.0)
    driven.ask(Delete(name='nobody/0'))
    assert driven.settle().answers[0].code == 'unknown_body'
    driven.simulation.seek(round(head / 240 * SECOND))
    driven.assert_same(driven.settle())


@pytest.mark.parametrize('stamp', [-1, 10 * SECOND, 10**18])
def test_what_is_not_in_the_history_is_refused(driven: Driven, stamp: int) -> None:
    step, digest = driven.simulation.step, driven.simulation.world.digest()
    if stamp < 0:
        driven.simulation.history = 1.0
        stamp = 0
    with pytest.raises(OutOfHistory):
        driven.simulation.seek(stamp)
    assert (driven.simulation.step, driven.simulation.world.digest()) == (step, digest)


def test_undo_goes_back_to_the_moment_before(driven: Driven) -> None:
    message = driven.simulation.undo()
    assert driven.simulation.step == pytest.approx(3 * 240, abs=FRAME)
    assert 'late/0' in message
    assert driven.names == tuple(f'a/{number}' for number in range(5))
    shown = driven.settle().snapshot
    np.testing.assert_array_equal(shown.poses, driven.shown[shown.step].snapshot.poses[:5])


def test_redo_returns_to_where_undo_was_asked_for(driven: Driven) -> None:
    step, digest = driven.simulation.step, driven.simulation.world.digest()
    driven.simulation.undo()
    driven.run(1.0, 0.7)
    driven.simulation.redo()
    assert (driven.simulation.step, driven.simulation.world.digest()) == (step, digest)


# Requests and refusals that make a frame without a step, and change nothing.
IDLE: list[Callable[[Driven], object]] = [
    lambda driven: driven.ask(Delete(name='nobody/0')),
    lambda driven: driven.ask(DeleteAll(namespace='nobody')),
    lambda driven: driven.run(0.5, 0.0),
]


@pytest.mark.parametrize('idle', IDLE)
@pytest.mark.parametrize('back', [False, True], ids=['now', 'past'])
def test_a_frame_without_a_step_tells_no_contacts_and_drops_none(
    idle: Callable[[Driven], object], *, back: bool
) -> None:
    driven = Driven()
    driven.ask(spawning('a/0', BOX, (0.0, 0.5, 0.0)))
    driven.simulation.watch_contacts(True)
    driven.run(1.0, 2.0)
    if back:
        driven.run(-1.0, 1.0)
    step = driven.simulation.step

    idle(driven)
    frame = driven.settle()
    driven.run(1.0, 0.5)
    again = [each for each in driven.run(-1.0, 1.0) if each.snapshot.step == step]

    assert frame.snapshot.step == step
    assert frame.contacts is not None
    assert frame.contacts.pairs.tolist() == []
    assert [each.contacts.pairs.tolist() for each in again if each.contacts] == [[[0, -1]]]


@pytest.mark.parametrize('steps', [(238, 240), (239, 240), (240, 240), (237, 239)])
def test_a_seek_from_within_a_frame_shows_all_its_contacts(steps: tuple[int, int]) -> None:
    driven = Driven()
    driven.ask(spawning('a/0', BOX, (0.0, 0.5, 0.0)))
    driven.simulation.watch_contacts(True)
    driven.run(1.0, 2.0)
    impulses = []
    for step in (steps[1], *steps):
        driven.simulation.seek(round(step * SECOND / 240))
        contacts = driven.settle().contacts
        assert contacts is not None
        impulses.append(contacts.impulses.tolist())
    first, _, again = impulses
    assert first
    np.testing.assert_allclose(again, first, rtol=1e-9, atol=1e-12)


def test_redo_shows_the_contacts_of_one_frame(driven: Driven) -> None:
    driven.simulation.watch_contacts(True)
    before = driven.run(1.0, 1.0)[-1].contacts
    driven.ask(spawning('more/0', BOX, (8.0, 18.0, 0.0)))
    driven.settle()
    driven.simulation.undo()
    driven.simulation.redo()
    again = driven.settle().contacts
    assert before is not None
    assert again is not None
    assert again.pairs.tolist() == before.pairs.tolist()
    np.testing.assert_allclose(again.impulses, before.impulses, rtol=1e-9, atol=1e-12)


def test_several_undos_are_redone_one_by_one(driven: Driven) -> None:
    digests = [driven.simulation.world.digest()]
    for _ in range(6):
        driven.simulation.undo()
        digests.append(driven.simulation.world.digest())
    assert driven.names == ()
    with pytest.raises(OutOfHistory, match='nothing to undo'):
        driven.simulation.undo()
    for digest in digests[-2::-1]:
        driven.simulation.redo()
        assert driven.simulation.world.digest() == digest
    with pytest.raises(OutOfHistory, match='nothing to redo'):
        driven.simulation.redo()


def test_what_belongs_together_is_undone_together(driven: Driven) -> None:
    driven.ask(spawning('b/0', BOX, (5.0, 5.0, 0.0)))
    driven.ask(spawning('b/1', BOX, (5.0, 8.0, 0.0)), joined=True)
    driven.settle()
    assert 'and 1 more' in driven.simulation.undo()
    assert not {'b/0', 'b/1'} & set(driven.names)


def test_a_new_request_leaves_nothing_to_redo(driven: Driven) -> None:
    driven.simulation.undo()
    driven.ask(DeleteAll())
    driven.settle()
    with pytest.raises(OutOfHistory):
        driven.simulation.redo()


def test_a_refused_request_leaves_what_there_is_to_redo(driven: Driven) -> None:
    driven.simulation.undo()
    driven.ask(Delete(name='nobody/0'))
    driven.settle()
    driven.simulation.redo()
    assert 'late/0' in driven.names


def test_settings_are_undone_and_follow_time(driven: Driven) -> None:
    driven.ask(Configure(changes={'gravity': (0.0, 0.0)}))
    driven.record(1.0)
    assert driven.simulation.settings.gravity == (0.0, 0.0)
    driven.run(-1.0, 1.5)
    assert driven.simulation.settings.gravity == (0.0, -9.81)
    driven.run(1.0, 1.0)
    assert driven.simulation.settings.gravity == (0.0, 0.0)
    driven.simulation.undo()
    assert driven.simulation.settings.gravity == (0.0, -9.81)


def test_reset_is_undone_too(driven: Driven) -> None:
    step, digest = driven.simulation.step, driven.simulation.world.digest()
    driven.simulation.reset()
    assert (driven.simulation.step, driven.names) == (0, ())
    driven.run(1.0, 0.5)
    later = driven.simulation.step
    driven.simulation.undo()
    assert (driven.simulation.step, driven.simulation.world.digest()) == (step, digest)
    driven.simulation.redo()
    assert later > 100
    assert (driven.simulation.step, driven.names) == (later, ())


def test_what_followed_a_reset_comes_back_with_it(driven: Driven) -> None:
    driven.simulation.reset()
    driven.record(4.0)
    driven.ask(spawning('b/0', BOX, (0.0, 5.0, 0.0)))
    driven.record(3.0)
    step, digest = driven.simulation.step, driven.simulation.world.digest()
    said = [driven.simulation.undo() for _ in range(2)] + [
        driven.simulation.redo() for _ in range(2)
    ]
    assert [each.partition(',')[0] for each in said[:2]] == ['undid spawn b/0', 'undid reset']
    assert (driven.simulation.step, driven.simulation.world.digest()) == (step, digest)
    driven.simulation.seek(SECOND // 2)
    frames = [driven.simulation.advance_frame() for _ in range(step // FRAME - 30)]
    for frame in frames:
        driven.assert_same(frame)
    assert told(frames, 'divergence') == []
    assert driven.simulation.world.digest() == digest


def test_resets_are_undone_and_redone_one_by_one(driven: Driven) -> None:
    moments = [driven.simulation.step]
    for seconds in (1.0, 2.0):
        driven.simulation.reset()
        driven.run(1.0, seconds)
        moments.append(driven.simulation.step)
    backward = []
    for _ in range(2):
        driven.simulation.undo()
        backward.append(driven.simulation.step)
    forward = []
    for _ in range(2):
        driven.simulation.redo()
        forward.append(driven.simulation.step)
    assert backward == moments[1::-1]
    assert forward == moments[1:]


def test_an_undone_load_is_not_what_reset_returns_to(driven: Driven) -> None:
    other = Driven()
    other.ask(spawning('b/0', BOX, (0.0, 5.0, 0.0)))
    driven.simulation.load(other.simulation.save())
    driven.simulation.undo()
    driven.simulation.reset()
    assert driven.names == ()


def test_reset_returns_to_what_was_loaded_longer_ago_than_is_kept() -> None:
    driven = Driven(history=5.0)
    other = Driven()
    other.ask(spawning('b/0', BOX, (0.0, 5.0, 0.0)))
    driven.simulation.load(other.simulation.save())
    driven.run(4.0, 5.0)
    driven.simulation.reset()
    assert driven.names == ('b/0',)


def test_a_moment_that_is_kept_no_more_is_left_for_the_oldest() -> None:
    driven = Driven()
    driven.ask(spawning('a/0', BOX, (0.0, 5.0, 0.0)))
    driven.record(20.0)
    driven.simulation.seek(2 * SECOND)
    driven.simulation.history = 1.0
    frame = driven.settle()
    assert (
        frame.snapshot.step == driven.simulation.past.timeline.history.oldest == 19 * 240 - FRAME
    )
    driven.assert_same(frame)
    assert 'oldest' in told([frame], 'history')[0].message
    driven.ask(spawning('b/0', BOX, (0.0, 8.0, 0.0)))
    frame = driven.simulation.advance_frame()
    assert [answer.code for answer in frame.answers if answer.topic == '~/test'] == ['']
    assert driven.names == ('a/0', 'b/0')


@pytest.mark.parametrize('history', [0.0, 1.0])
def test_what_was_left_is_returned_to_as_far_as_it_is_kept(history: float) -> None:
    driven = Driven()
    driven.ask(spawning('a/0', BOX, (0.0, 5.0, 0.0)))
    driven.record(15.0)
    driven.simulation.seek(2 * SECOND)
    driven.simulation.reset()
    driven.simulation.history = history
    driven.simulation.undo()
    oldest = driven.simulation.past.timeline.history.oldest
    assert driven.simulation.step == oldest == 15 * 240 - FRAME - round(history * 240)
    driven.assert_same(driven.settle())


def test_contacts_come_again_that_nobody_asked_for_the_first_time() -> None:
    driven = Driven()
    driven.ask(spawning('a/0', BOX, (0.0, 0.5, 0.0)))
    driven.run(1.0, 5.0)
    driven.simulation.watch_contacts(True)
    for frame in driven.run(-1.0, 4.0)[1:]:
        assert frame.contacts is not None
        assert frame.contacts.pairs.tolist() == [[0, -1]]


@pytest.mark.parametrize('more', [True, False])
def test_undo_passes_over_nothing_that_is_kept_no_more(*, more: bool) -> None:
    sim = Simulation(history=1.0)
    sim.perform(spawning('ball/0', BOX, anchored=True))
    sim.advance_frame()
    sim.reset()
    if more:
        sim.perform(spawning('ball/1', BOX, anchored=True))
    for _ in range(600):
        sim.advance_frame()

    with pytest.raises(OutOfHistory):
        sim.undo()
    assert ('ball/1' in sim.world) is more
    assert 'ball/0' not in sim.world


def test_the_thousandth_command_to_a_paused_world_costs_no_more_than_the_first(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    looks = [0]

    class Counted(Entry):
        """A request of which each look at whether it was seen is counted."""

        def __getattribute__(self, name: str) -> Any:
            if name == 'seen':
                looks[-1] += 1
            return super().__getattribute__(name)

        def __setattr__(self, name: str, value: Any) -> None:
            if name == 'seen':
                looks[-1] += 1
            super().__setattr__(name, value)

    monkeypatch.setattr('physsim_ros.simulation.timeline.Entry', Counted)
    driven = Driven(speed=0.0)
    driven.ask(spawning('a/0', BOX))
    for _ in range(1000):
        driven.ask(Command(names=('a/0',), wrenches=((1.0, 0.0, 0.0),)))
        looks.append(0)
        driven.settle()
    assert max(looks) < 10
    driven.simulation.seek(0)
    assert driven.simulation.past.timeline.serial == 1001


def test_what_was_loaded_at_the_beginning_cannot_be_undone() -> None:
    first = Driven()
    first.ask(spawning('a/0'))
    first.settle()
    second = Driven()
    second.simulation.begin(first.simulation.save())
    with pytest.raises(OutOfHistory):
        second.simulation.undo()
    assert second.names == ('a/0',)


def test_a_world_that_was_loaded_while_time_ran_is_undone(driven: Driven) -> None:
    names = driven.names
    driven.simulation.load(Driven().simulation.save())
    assert driven.names == ()
    driven.run(1.0, 0.5)
    driven.simulation.undo()
    assert driven.names == names


def test_older_steps_than_are_kept_are_dropped() -> None:
    driven = Driven(history=3.0)
    driven.ask(spawning('a/0', BOX, (0.0, 5.0, 0.0)))
    driven.record(10.0)
    history = driven.simulation.past.timeline.history
    assert history.head - history.oldest == 3 * 240
    assert len(history.checkpoints) <= 3
    frames = driven.run(-64.0, 0.5)
    assert frames[-1].snapshot.step == history.head - 3 * 240
    driven.assert_same(frames[-1])
    with pytest.raises(OutOfHistory):
        driven.simulation.undo()


def test_shots_take_no_more_memory_than_they_may(monkeypatch: pytest.MonkeyPatch) -> None:
    driven = Driven()
    for number in range(50):
        driven.ask(spawning(f'a/{number}', BOX, (0.1 * number, 1.0 + number, 0.0)))
    monkeypatch.setattr(driven.simulation.past.frame_cache, 'budget', 2_000_000)
    driven.record(20.0)
    assert driven.simulation.past.frame_cache.size <= 2_000_000


@pytest.mark.parametrize('bodies', [1, 8])
def test_few_bodies_take_no_more_memory_than_their_poses_would(bodies: int) -> None:
    driven = Driven(history=120.0)
    for number in range(bodies):
        driven.ask(spawning(f'a/{number}', BOX, (1.5 * number - 6.0, 1.0, 0.0)))
    driven.record(20.0)
    a_segment = 60 * CHECKPOINTS * (1000 + bodies * 2 * 24)
    assert driven.simulation.past.frame_cache.size <= max(120 * 60 * 24 * bodies, 3 * a_segment)
    for frame in driven.run(-4.0, 5.0):
        driven.assert_same(frame)


def test_what_is_worked_out_from_the_past_is_not_kept(driven: Driven) -> None:
    driven.ask(spawning('sensor/0', BOX, (0.0, 0.5, 0.0), anchored=True, sensor=True))
    driven.record(4.0)
    driven.simulation.watch_contacts(True)
    # Among them some that are made again, with a sensor's contacts, which take the centres.
    for frame in driven.run(-1.0, 3.5):
        assert frame.snapshot.centers.size
    kept = [each for each in gc.get_objects() if isinstance(each, CachedFrame)]
    shots = [shot for shot in kept if shot.snapshot.scene.names == driven.names]
    assert len(shots) > 100
    # Else it would take memory that nobody counts; but for the one that is shown.
    assert sum('centers' in vars(shot.snapshot) for shot in shots) <= 1


@pytest.mark.parametrize('back', [-1.0, -8.0])
def test_forces_of_joints_come_again(back: float) -> None:
    driven = Driven()
    for number in range(2):
        driven.ask(spawning(f'a/{number}', BOX, (1.0 + number, 8.0, 0.0)))
        b = f'a/{number - 1}' if number else 'world'
        points = ((1.0 * number, 8.0), (1.0 + number, 8.0))
        driven.ask(
            Join(
                name=f'rod/{number}', kind=JointKind.ROD, points=points[::-1], a=f'a/{number}', b=b
            )
        )
    driven.record(7.0)
    checkpoint = driven.simulation.past.timeline.history.checkpoints[2].key.step
    assert driven.shown[checkpoint].snapshot.forces.all()
    driven.simulation.past.frame_cache.drop_from(0)
    driven.simulation.seek(checkpoint * SECOND // 240)
    driven.assert_same(driven.settle())
    for frame in driven.run(1.0, 1.0) + driven.run(back, 1.5):
        driven.assert_same(frame)


def test_other_bits_than_before_are_told(driven: Driven) -> None:
    history = driven.simulation.past.timeline.history
    wrong = history.checkpoints[2]._replace(digest='not that')
    history.checkpoints[2] = wrong
    driven.simulation.seek(0)
    frames = driven.run(8.0, 0.7)
    (answer,) = told(frames, 'divergence')
    assert answer.code == 'divergence'
    assert f'{wrong.step / 240:.3f} s' in answer.message


def test_saving_in_the_past_drops_nothing(driven: Driven) -> None:
    driven.run(-1.0, 1.3)
    step = driven.simulation.step
    state = driven.simulation.save()
    assert len(state.bodies) == 6
    for frame in driven.run(1.0, 1.2):
        driven.assert_same(frame)
    elsewhere = Driven()
    elsewhere.simulation.begin(state)
    np.testing.assert_array_equal(
        elsewhere.simulation.world.snapshot().poses, driven.shown[step].snapshot.poses
    )


@pytest.mark.parametrize('frames', [1, 37, 200])
def test_all_that_go_on_from_what_was_saved_go_on_alike(driven: Driven, frames: int) -> None:
    for _ in range(frames):
        driven.simulation.advance_frame()
    elsewhere, restored = Driven(), Driven()
    elsewhere.simulation.begin(driven.simulation.save())
    restored.simulation.perform(Restore(state=driven.simulation.save()))
    assert elsewhere.simulation.world.save() == driven.simulation.world.save()
    for _ in range(200):
        expected = elsewhere.simulation.advance_frame().snapshot
        snapshot = restored.simulation.advance_frame().snapshot
        np.testing.assert_array_equal(snapshot.poses, expected.poses)
        np.testing.assert_array_equal(snapshot.twists, expected.twists)


# Requests at checkpoints


def collide(driven: Driven) -> None:
    for number in range(4):
        driven.ask(spawning(f'a/{number}', BOX, (0.3 * number, 1.0 + 1.2 * number, 0.2)))


def test_a_request_at_the_step_of_a_checkpoint_is_made_again_where_it_was() -> None:
    driven = Driven()
    collide(driven)
    for _ in range(150):
        driven.simulation.advance_frame()
    checkpoint = driven.simulation.past.timeline.history.checkpoints[-1].step
    driven.simulation.seek(round(checkpoint / 240 * SECOND))
    driven.ask(spawning('b/0', BOX, (0.2, 6.0, 0.5)))
    for _ in range(120):
        frame = driven.simulation.advance_frame()
        driven.shown[frame.snapshot.step] = frame
    driven.simulation.seek(0)
    for _ in range(200):
        frame = driven.simulation.advance_frame()
        if frame.snapshot.step in driven.shown:
            driven.assert_same(frame)
        assert told([frame], 'divergence') == []


def test_a_request_at_a_checkpoint_of_the_past_is_made_again_where_it_was() -> None:
    sim = Simulation(settings=FLOOR)
    # A seek comes from the frame before, for its contacts.
    sim.watch_contacts(True)
    # Deep in the floor, so that it goes on otherwise in a space that is built anew.
    sim.perform(spawning('a/0', DISC, (2.4, 0.1, 3.0), velocity=(1.8, 2.7)))
    sim.advance_frame()
    sim.past.timeline.add_checkpoint()
    for _ in range(14):
        sim.advance_frame()
    sim.seek(round(FRAME * SECOND / 240))
    sim.perform(spawning('a/1', DISC, (-0.2, 3.6, 0.0)))
    sim.advance_frame()
    before = sim.world.digest()

    sim.undo()
    for _ in range(4):
        sim.advance_frame()
    sim.redo()

    assert sim.world.digest() == before


def test_a_seek_to_now_keeps_what_was_just_asked() -> None:
    driven = Driven()
    driven.record(0.5)
    driven.ask(spawning('b/0', BOX, (0.0, 5.0, 0.0)))
    driven.simulation.seek(round(driven.simulation.step / 240 * SECOND))
    assert driven.names == ('b/0',)


def test_reset_keeps_what_was_just_asked_for_undo() -> None:
    driven = Driven()
    driven.record(0.5)
    driven.ask(spawning('b/0', BOX, (0.0, 5.0, 0.0)))
    driven.simulation.reset()
    driven.simulation.undo()
    assert driven.names == ('b/0',)


def test_reset_goes_to_what_was_loaded_since() -> None:
    driven = Driven()
    driven.simulation.reset()
    driven.record(0.2)
    other = Driven()
    other.ask(spawning('b/0', BOX, (0.0, 5.0, 0.0)))
    driven.simulation.load(other.simulation.save())
    driven.record(0.2)
    driven.simulation.seek(0)
    driven.simulation.reset()
    assert driven.names == ('b/0',)


def test_what_changes_nothing_drops_nothing(driven: Driven) -> None:
    same = spawning('c/0', BOX, (5.0, 0.5, 0.0), anchored=True)
    driven.ask(same)
    driven.record(1.0)
    driven.run(-1.0, 0.5)
    for request in (same, UnjoinAll(), DeleteAll(namespace='nobody'), Configure(changes={})):
        driven.ask(request)
        frame = driven.settle()
        assert [answer.code for answer in frame.answers] == ['']
        assert told([frame], 'branch') == []


@pytest.mark.parametrize(
    'request_',
    [Unjoin(name='joint/0'), UnjoinAll(), Release(point=(0.0, 5.0))],
    ids=['unjoin', 'unjoin all', 'release'],
)
def test_a_joint_that_is_taken_out_is_part_of_history(request_: Request) -> None:
    driven = Driven()
    driven.ask(spawning('b/0', BOX, (0.0, 5.0, 0.0)))
    driven.ask(Join(name='joint/0', kind=JointKind.PIN, points=((0.0, 5.0),), a='b/0', b='world'))
    driven.record(1.0)
    hung = driven.simulation.world.snapshot().poses
    driven.ask(request_)
    driven.record(0.5)
    driven.simulation.seek(0)
    for frame in driven.run(1.0, 1.4):
        if frame.snapshot.step:
            driven.assert_same(frame)
    assert driven.simulation.world.snapshot().scene.joints == ()
    driven.simulation.undo()
    assert driven.simulation.world.snapshot().poses == pytest.approx(hung)
    assert len(driven.simulation.world.snapshot().scene.joints) == 1


def test_a_joint_taken_out_in_the_past_begins_a_branch() -> None:
    driven = Driven()
    driven.ask(spawning('b/0', BOX, (0.0, 5.0, 0.0)))
    driven.ask(Pin(point=(0.0, 5.0)))
    driven.record(2.0)
    driven.simulation.seek(SECOND)
    driven.ask(UnjoinAll())
    frames = [driven.settle(), *driven.run(1.0, 2.0)]
    assert len(told(frames, 'branch')) == 1
    assert told(frames, 'divergence') == []
    assert driven.simulation.world.snapshot().scene.joints == ()


def test_a_joint_that_broke_is_told_of_once() -> None:
    driven = Driven()
    driven.ask(spawning('b/0', BOX, (0.0, 5.0, 0.0)))
    driven.ask(
        Join(
            name='joint/0',
            kind=JointKind.SPRING,
            points=((0.0, 5.0), (0.0, 8.0)),
            a='b/0',
            b='world',
            properties=JointProperties(stiffness=20.0, break_force=5.0),
        )
    )
    frames = driven.run(1.0, 2.0)
    assert len(told(frames, 'joint_broken')) == 1
    driven.simulation.seek(0)
    frames = driven.run(1.0, 1.5)
    driven.simulation.seek(SECOND)
    frames.append(driven.settle())
    assert told(frames, 'joint_broken') == []


def test_a_joint_whose_bodies_were_anchored_later_loads_again(tmp_path: Path) -> None:
    driven = Driven()
    driven.ask(spawning('b/0', BOX, (0.0, 5.0, 0.0)))
    driven.ask(Pin(point=(0.0, 5.0)))
    driven.ask(Anchor(point=(0.0, 5.0)))
    driven.settle()
    state = driven.simulation.save()
    path = save_world(state, 'it', world_dir=tmp_path, physics_rate=240.0)
    assert load_world(path, settings=FLOOR, physics_rate=240.0).joints == state.joints


@pytest.mark.parametrize('names', [None, 'a/0', 'a/4'])
def test_what_is_deleted_at_a_checkpoint_is_gone_from_the_contacts(names: str | None) -> None:
    driven = Driven()
    driven.simulation.watch_contacts(True)
    for number in range(5):
        driven.ask(spawning(f'a/{number}', BOX, (0.0, 0.5 + number, 0.0)))
    for _ in range(3):
        while driven.simulation.past.timeline.history.head % 480 or not driven.simulation.step:
            driven.simulation.advance_frame()
        driven.ask(DeleteAll() if names is None else Delete(name=names))
        driven.ask(spawning('a/0' if names is None else names, BOX, (3.0, 0.5, 0.0)))
        for _ in range(3):
            contacts = driven.simulation.advance_frame().contacts
            assert contacts is not None
            assert contacts.pairs.max(initial=-1) < len(driven.names)
