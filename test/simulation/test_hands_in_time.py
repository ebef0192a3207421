# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Hands in the time of a world: its past, its pause, its other courses."""

import math

import numpy as np
from physsim_ros.model.requests import Grab, HandRequest, LetGo, MoveHand, Spawn
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Compound, Disc
from physsim_ros.simulation.entries import Origin
from physsim_ros.simulation.simulation import Simulation
import pytest

from .driven import SLAB
from ..building import BOX, DISC, NOWHERE, spawning

PERIOD = 1e9 / 60
TOPIC = '~/drag/feedback'


def use(sim: Simulation, *requests: HandRequest) -> None:
    """Submit requests of hands."""
    for request in requests:
        sim.requests.submit(request, Origin(TOPIC))


def holding() -> Simulation:
    """Return a world in which a hand is about to grab the only body."""
    sim = Simulation(settings=NOWHERE)
    sim.perform(spawning('a/0', DISC))
    use(sim, Grab(hand='h', point=(0.0, 0.0)))
    return sim


def drag(sim: Simulation, *, frames: int = 120) -> None:
    """Drag `a/0` along a circle among other bodies, throw it, and go on for as long."""
    sim.perform(SLAB)
    for number in range(8):
        sim.perform(spawning(f'a/{number}', BOX, (number / 10, 0.5 + number, 0.0)))
    use(sim, Grab(hand='h', point=(0.0, 0.5)))
    for number in range(frames):
        angle = number / 15
        use(sim, MoveHand(hand='h', point=(2.0 * math.sin(angle), 1.5 - math.cos(angle))))
        sim.advance_frame()
    use(sim, LetGo(hand='h'))
    for _ in range(frames):
        sim.advance_frame()


def test_a_drag_is_one_gesture_to_undo_and_to_redo():
    sim = Simulation()
    drag(sim, frames=20)
    last = sim.world.digest()

    sim.undo()

    assert sim.step == 0
    assert len(sim.world) == 9
    assert sim.world.grips == ()
    sim.redo()
    assert sim.world.digest() == last


def test_only_the_grab_and_its_end_are_answered():
    sim = holding()
    frames = [sim.advance_frame()]
    for x in range(10):
        use(sim, MoveHand(hand='h', point=(x / 10, 0.0)))
        frames.append(sim.advance_frame())
    use(sim, LetGo(hand='h'))
    frames.append(sim.advance_frame())

    told = [answer.message for frame in frames for answer in frame.answers]
    assert told == ['grabbed a/0', 'let go of a/0']


def test_a_thousand_moves_between_two_frames_are_logged_as_one():
    sim = holding()
    for number in range(1001):
        use(sim, MoveHand(hand='h', point=(number / 1000, 0.0)))
    frame = sim.advance_frame()

    assert frame.snapshot.grips[0].target == (1.0, 0.0)
    logged = [type(entry.request) for entry in sim.past.line.nodes_between(1, 9)]
    assert logged == [Grab, MoveHand]


def test_moves_do_not_pass_what_a_hand_does_in_between():
    sim = holding()
    use(
        sim,
        MoveHand(hand='h', point=(0.1, 0.0)),
        LetGo(hand='h'),
        Grab(hand='h', point=(0.0, 0.1)),
        MoveHand(hand='h', point=(0.0, 0.2)),
    )

    (grip,) = sim.advance_frame().snapshot.grips
    assert (grip.anchor, grip.target) == ((0.0, 0.1), (0.0, 0.2))


def test_a_silent_hand_lets_go_after_five_seconds_of_running_time():
    sim = holding()
    answers = []
    for number in range(400):
        if number == 60:
            use(sim, MoveHand(hand='h', point=(0.5, 0.0)))
        for frame in sim.advance(round(number * PERIOD)):
            answers += [(number, answer.message) for answer in frame.answers]

    (_, grabbed), (number, told) = answers
    assert (grabbed, told) == ('grabbed a/0', 'released a/0: no message from h')
    assert number == pytest.approx(60 + 300, abs=3)
    # It is one gesture still.
    sim.undo()
    assert (sim.step, sim.world.grips) == (0, ())


def test_the_release_of_a_silent_hand_is_undone_with_the_gesture_before_which_is_redone():
    sim = holding()
    sim.advance_frame()
    sim.perform(spawning('b/0', DISC, (5.0, 0.0, 0.0)))
    sim.applier.hands.clear()
    sim.advance_frame()
    assert not sim.world.grips

    sim.undo()
    # Nobody holds the body here either.
    frame = sim.advance_frame()

    assert frame.snapshot.scene.names == ('a/0',)
    assert not sim.world.grips
    assert sim.status.redo == 'redo spawn b/0 and 1 more'
    sim.redo()
    assert sim.world.scene.names == ('a/0', 'b/0')


def test_a_pause_is_no_silence():
    sim = holding()
    sim.advance(0)
    sim.speed = 0.0
    for seconds in range(1, 60):
        sim.advance(seconds * 10**9)
    sim.speed = 1.0

    assert sim.advance_frame().snapshot.grips


def test_a_hand_that_grabbed_at_another_time_changes_nothing():
    sim = Simulation(settings=NOWHERE)
    sim.perform(spawning('a/0', DISC))
    sim.advance_frame()
    use(sim, Grab(hand='h', point=(0.0, 0.0)))
    for _ in range(60):
        sim.advance_frame()
    end = sim.world.stamp
    sim.seek(10**9 // 2)
    before = sim.world.digest()

    use(sim, MoveHand(hand='h', point=(7.0, 0.0)), LetGo(hand='h'))
    frame = sim.apply_requests()

    assert [answer.message for answer in frame.answers] == ['h holds no body']
    assert sim.world.digest() == before
    # The hand of the past lets go where its past ends.
    while sim.world.stamp < end:
        assert sim.advance_frame().snapshot.grips
    assert not sim.advance_frame().snapshot.grips


@pytest.mark.parametrize('action', ['reset', 'undo'])
def test_a_hand_lives_through_a_change_of_course(action):
    sim = holding()
    sim.advance_frame()
    getattr(sim, action)()

    use(sim, MoveHand(hand='h', point=(7.0, 0.0)), LetGo(hand='h'))
    frame = sim.advance_frame()

    assert [answer.message for answer in frame.answers][-1] == 'h holds no body'
    assert not frame.snapshot.grips


# In a paused world


def paused(*spawns: Spawn) -> Simulation:
    sim = Simulation(speed=0.0)
    for request in spawns:
        sim.perform(request)
    return sim


def test_in_a_paused_world_the_body_is_placed_and_turned():
    sim = paused(spawning('a/0', BOX, (0.0, 3.0, 0.0), velocity=(1.0, 2.0)))
    use(sim, Grab(hand='h', point=(0.4, 3.0)), MoveHand(hand='h', point=(5.4, 4.0)))
    (frame,) = sim.advance(0)
    assert frame.snapshot.poses[0] == pytest.approx([5.0, 4.0, 0.0])

    use(sim, MoveHand(hand='h', point=(5.4, 4.0), yaw=math.pi / 2), LetGo(hand='h'))
    (frame,) = sim.advance(1)

    assert frame.snapshot.poses[0] == pytest.approx([5.4, 3.6, math.pi / 2])
    assert frame.snapshot.twists[0] == pytest.approx([1.0, 2.0, 0.0])
    assert frame.snapshot.step == 0


def test_placing_is_one_gesture_and_the_same_bits_again():
    sim = paused(SLAB, spawning('a/0', BOX, (0.0, 0.5, 0.0)), spawning('a/1', BOX, (0, 1.5, 0)))
    sim.advance_frame()
    before = sim.world.digest()
    use(sim, Grab(hand='h', point=(0.0, 1.5)))
    for number in range(10):
        use(sim, MoveHand(hand='h', point=(number / 5, 1.5)))
        sim.advance(number)
    use(sim, LetGo(hand='h'))
    for _ in range(60):
        sim.advance_frame()
    last, end = sim.world.digest(), sim.world.stamp

    sim.seek(0)
    sim.seek(end)
    assert sim.world.digest() == last
    sim.undo()
    assert sim.world.digest() == before


def test_in_a_paused_world_a_wall_can_be_placed_but_what_moves_comes_first():
    sim = paused(spawning('a/0', DISC), spawning('wall/0', BOX, anchored=True))
    for number, (hand, point) in enumerate((('g', (0.0, 0.0)), ('h', (0.45, 0.45)))):
        to = (point[0] + 3.0, point[1] + number)
        use(sim, Grab(hand=hand, point=point), MoveHand(hand=hand, point=to))

    (frame,) = sim.advance(0)

    assert frame.snapshot.poses[:, :2] == pytest.approx(np.array([[3.0, 0.0], [3.0, 1.0]]))


def test_a_body_grabbed_in_a_paused_world_is_dragged_when_time_goes_on():
    sim = paused(spawning('a/0', DISC, (0.0, 3.0, 0.0)))
    use(sim, Grab(hand='h', point=(0.0, 3.0)))
    sim.advance(0)
    sim.speed = 1.0
    for number in range(60):
        sim.advance(round(number * PERIOD))
    use(sim, MoveHand(hand='h', point=(1.0, 3.0)))
    for number in range(60, 120):
        sim.advance(round(number * PERIOD))

    assert sim.world.snapshot().poses[0, :2] == pytest.approx([1.0, 3.0], abs=0.02)


def test_a_body_is_not_placed_where_too_much_would_overlap():
    heap = Compound(element=Disc(radius=1.0), centers=((0.0, 0.0),) * 8)
    sim = Simulation(speed=0.0, settings=WorldSettings(max_overlaps=60))
    for number in range(2):
        sim.perform(spawning(f'a/{number}', heap, (9.0 * number, 0.0, 0.0)))
    use(sim, Grab(hand='h', point=(9.0, 0.0)))
    sim.advance(0)
    before = sim.world.digest()

    use(sim, MoveHand(hand='h', point=(0.0, 0.0)))
    (frame,) = sim.advance(1)

    assert [answer.code for answer in frame.answers] == ['world_full']
    assert sim.world.digest() == before
