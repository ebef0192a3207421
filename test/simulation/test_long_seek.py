# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A long way through the past is made bit by bit, and leads to the same bits."""

from physsim_ros.engine import checkpoint
from physsim_ros.model.answer import Answer
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.requests import DeleteAll, DeleteBodies, MoveBodies
from physsim_ros.model.snapshot import Frame
from physsim_ros.simulation.entries import Amend, Origin, TakeBack, Unread, Wait
from physsim_ros.simulation.simulation import Simulation
import pytest

from .driven import FLOOR, OVERDUE, SECOND, take_back, world_after
from ..building import DISC, spawning

NAMES = ('Anna', 'Ben')


@pytest.fixture
def digests() -> dict[int, str]:
    """Return the digests by step that `simulation` has made."""
    return {}


@pytest.fixture
def simulation(digests: dict[int, str]) -> Simulation:
    """Return a paused simulation of two seconds and a half without a checkpoint in them."""
    simulation = Simulation(settings=FLOOR)
    for number in range(4):
        disc = spawning(f'disc/{number}', DISC, (0.3 * number, 3.0 * number + 1.0, 0.0))
        simulation.requests.submit(disc, topic='')
    for _ in range(150):
        simulation.advance_frame()
        digests[simulation.step] = simulation.world.digest()
    simulation.speed = 0.0
    return simulation


def ticks_to_a_frame(simulation: Simulation, now: int) -> tuple[int, Frame]:
    """Tick until there is a frame, when each tick is overdue at once; return how many it took."""
    for tick in range(1, 2000):
        frames = simulation.advance(now + tick * SECOND // 60, OVERDUE)
        if frames:
            return tick, frames[0]
    pytest.fail('no frame')


def test_a_seek_is_made_bit_by_bit_and_reaches_the_same_bits(simulation, digests):
    simulation.past.frames.drop_from(0)
    simulation.seek(2 * SECOND)
    ticks, frame = ticks_to_a_frame(simulation, 0)
    assert ticks > 100
    assert frame.snapshot.step == 480
    assert simulation.world.digest() == digests[480]


def test_requests_wait_for_the_end_of_a_seek_and_apply_there(simulation):
    simulation.seek(SECOND)
    simulation.requests.submit(spawning('late/0', DISC, (5.0, 1.0, 0.0)), topic='~/spawn')
    _, frame = ticks_to_a_frame(simulation, 0)
    assert [answer.subject for answer in frame.answers if answer.topic == '~/spawn'] == ['late/0']
    assert frame.snapshot.step == 240


@pytest.mark.parametrize('speed', [0.0, 1.0])
def test_a_seek_that_waited_is_made_bit_by_bit_and_others_wait_behind_it(simulation, speed):
    simulation.past.frames.drop_from(0)
    simulation.speed = speed
    simulation.requests.submit_seek(2 * SECOND, Origin('~/seek'))
    simulation.requests.submit(spawning('late/0', DISC, (5.0, 1.0, 0.0)), topic='~/spawn')
    simulation.requests.submit_seek(SECOND, Origin('~/seek'))
    simulation.requests.submit(spawning('early/0', DISC, (5.0, 1.0, 0.0)), topic='~/spawn')
    # Up to the first seek, and to the second, which begins when the first is done.
    ticks, frame = ticks_to_a_frame(simulation, 0)
    assert ticks > 150
    answers = list(simulation.applier.take_answers())
    while 'early/0' not in frame.snapshot.scene.names:
        _, frame = ticks_to_a_frame(simulation, ticks * SECOND)
    answers += frame.answers
    messages = [answer.message for answer in answers if answer.topic.startswith('~')]
    assert messages[-4:] == ['at 2.000 s', 'spawned late/0', 'at 1.000 s', 'spawned early/0']
    assert frame.snapshot.step in (240, 244)
    assert 'late/0' not in frame.snapshot.scene.names


def test_a_call_waits_for_the_end_of_a_seek_in_its_turn_among_requests(simulation):
    simulation.seek(SECOND)
    requests = simulation.requests
    saved: list[WorldState] = []

    def clear() -> list[Answer]:
        saved.append(simulation.save())
        return [Answer(topic='~/clear', message=simulation.perform(DeleteAll()))]

    requests.submit(spawning('early/0', DISC, (5.0, 1.0, 0.0)), topic='~/spawn')
    simulation.applier.make_call(clear, Wait.FOR_SEEK)
    requests.submit(spawning('late/0', DISC, (7.0, 1.0, 0.0)), topic='~/spawn')
    ticks, frame = ticks_to_a_frame(simulation, 0)
    assert ticks > 50
    assert len(saved[0].bodies) == 5
    messages = [answer.message for answer in frame.answers if answer.topic.startswith('~')]
    assert messages == ['spawned early/0', 'deleted 5 bodies', 'spawned late/0']
    assert frame.snapshot.scene.names == ('late/0',)
    assert frame.snapshot.step == 240
    simulation.undo()
    assert len(simulation.world) == 0
    simulation.undo()
    assert len(simulation.world) == 5


def test_what_a_person_has_added_is_looked_up_after_a_seek(simulation):
    simulation.seek(SECOND)
    queue = simulation.requests
    queue.submit(spawning('early/0', DISC, (5.0, 1.0, 0.0)), Origin('~/spawn', author='Anna'))

    def deletion() -> DeleteBodies:
        names, joints = simulation.past.added_by('Anna')
        return DeleteBodies(names=names, joints=joints)

    queue.submit(Unread('', deletion), topic='~/command')
    ticks, frame = ticks_to_a_frame(simulation, 0)
    assert ticks > 50
    assert [answer.message for answer in frame.answers if answer.topic == '~/command'] == [
        'deleted early/0'
    ]
    assert len(frame.snapshot.scene.names) == 4


def test_a_change_of_earlier_gestures_waits_for_the_end_of_a_seek(simulation):
    simulation.seek(2 * SECOND)
    amend = Amend((4,), (spawning('other/0', DISC, (5.0, 1.0, 0.0)),))
    simulation.requests.submit(amend, topic='~/stroke', joined=True)
    ticks, frame = ticks_to_a_frame(simulation, 0)
    assert ticks > 100
    assert [answer.subject for answer in frame.answers if answer.topic == '~/stroke'] == [
        'other/0'
    ]
    assert frame.snapshot.scene.names == ('disc/0', 'disc/1', 'disc/2', 'other/0')


def test_single_frames_are_made_one_by_one_after_the_end_of_a_seek(simulation, digests):
    simulation.seek(2 * SECOND)
    assert not simulation.applier.apply_ready()
    times = [simulation.playback.queue_frame(), simulation.playback.queue_frame()]
    assert times == [round(step * SECOND / 240) for step in (484, 488)]
    steps = []
    for tick in range(1, 1000):
        for frame in simulation.advance(tick * SECOND // 60, OVERDUE):
            assert frame.stepped
            steps.append(frame.snapshot.step)
            assert simulation.world.digest() == digests[frame.snapshot.step]
    assert steps == [484, 488]
    assert simulation.applier.apply_ready()


def test_another_seek_takes_the_place_of_one_and_of_its_frames(simulation):
    simulation.seek(2 * SECOND)
    simulation.playback.queue_frame()
    simulation.seek(SECOND)
    assert simulation.playback.queue_frame() == round(244 * SECOND / 240)


def test_another_seek_takes_the_place_of_one_under_way(simulation, digests):
    simulation.past.frames.drop_from(0)
    simulation.seek(2 * SECOND)
    for tick in range(50):
        assert not simulation.advance(tick * SECOND // 60, OVERDUE)
    simulation.seek(SECOND)
    simulation.seek(2 * SECOND)
    ticks, _ = ticks_to_a_frame(simulation, SECOND)
    # From where the first one had come.
    assert ticks < 80
    assert simulation.world.digest() == digests[480]


def told_of_seeks(simulation: Simulation) -> list[tuple[str, str]]:
    """Return who was answered what, as a node tells it between frames."""
    answers = simulation.applier.take_answers()
    return [(each.asker, each.message) for each in answers if each.topic == '~/seek']


@pytest.mark.parametrize('other', ['none', 'seek', 'undo', 'reset'])
def test_a_seek_is_told_done_when_it_is_and_not_where_another_one_takes_its_place(
    simulation, other
):
    simulation.past.frames.drop_from(0)
    simulation.requests.submit_seek(2 * SECOND, Origin('~/seek', asker='1'))
    for tick in range(50):
        assert not simulation.advance(tick * SECOND // 60, OVERDUE)
        assert not told_of_seeks(simulation)
    match other:
        case 'seek':
            simulation.requests.submit_seek(SECOND, Origin('~/seek', asker='2'))
            assert not simulation.applier.apply_ready()
            assert told_of_seeks(simulation) == [('1', 'superseded by a seek to 1.000 s')]
        case 'undo':
            simulation.undo()
            assert told_of_seeks(simulation) == [('1', 'superseded by a jump to 0.000 s')]
        case 'reset':
            simulation.reset()
            assert told_of_seeks(simulation) == [('1', 'superseded by a jump to 0.000 s')]
    _, frame = ticks_to_a_frame(simulation, 2 * SECOND)
    told = [(each.asker, each.message) for each in frame.answers if each.topic == '~/seek']
    done = {'none': [('1', 'at 2.000 s')], 'seek': [('2', 'at 1.000 s')]}
    assert told == done.get(other, [])
    assert not told_of_seeks(simulation)


@pytest.mark.parametrize('ends_by', ['replay', 'seek', 'another undo'])
def test_an_undo_is_told_done_when_its_replay_is_or_when_the_world_goes_elsewhere(
    simulation, ends_by
):
    for number in range(2):
        late = spawning(f'late/{number}', DISC, (5.0 + number, 1.0, 0.0))
        simulation.requests.submit(late, topic='~/spawn')
    simulation.apply_requests()
    told: list[str] = []

    def undo(name: str) -> None:
        def call() -> list[Answer]:
            return [Answer(topic='~/undo', message=simulation.undo())]

        simulation.applier.make_call(call, Wait.BEHIND_REQUESTS, lambda: told.append(name))

    undo('first')
    for tick in range(50):
        assert not simulation.advance(tick * SECOND // 60, OVERDUE)
        assert not told
        assert not simulation.applier.take_answers()
    match ends_by:
        case 'seek':
            simulation.requests.submit_seek(SECOND, Origin('~/seek'))
        case 'another undo':
            undo('second')
    simulation.applier.apply_ready()
    assert told == ([] if ends_by == 'replay' else ['first'])
    answers = simulation.applier.take_answers() + simulation.advance_frame().answers
    undone = [each.message for each in answers if each.topic == '~/undo']
    assert undone[0] == 'undid spawn late/1, back at 2.500 s'
    assert told == ['first', 'second'][: len(undone)]
    assert len(undone) == 1 + (ends_by == 'another undo')


def test_a_cached_frame_is_shown_at_once_and_the_world_follows_it(simulation, digests):
    cursor = simulation.past.cursor
    for number, step in enumerate((480, 240, 360)):
        simulation.seek(step * SECOND // 240)
        now = number * SECOND
        ticks, frame = ticks_to_a_frame(simulation, now)
        assert (ticks, frame.snapshot.step) == (1, step)
        # On the way to the moment before, another one is sought.
        assert not simulation.advance(now + SECOND // 2, OVERDUE)
        assert cursor.carry_out_slice()
    ticks = 0
    while cursor.carry_out_slice():
        assert not simulation.advance(4 * SECOND + ticks, OVERDUE)
        ticks += 1
    assert 10 < ticks < 200
    assert cursor.arrive().digest() == digests[360]
    simulation.advance_frame()
    assert simulation.world.digest() == digests[364]


def test_a_cached_frame_that_is_sought_has_its_contacts_and_all_requests_of_its_step():
    simulation = Simulation(settings=FLOOR, speed=0.0)
    simulation.reports_contacts = True
    simulation.requests.submit(spawning('disc/0', DISC, (0.0, DISC.radius, 0.0)), topic='')
    shown = [simulation.advance_frame() for _ in range(60)]
    # It belongs to the step at which it is applied, though no frame came before the next seek.
    simulation.requests.submit(spawning('disc/1', DISC, (3.0, 1.0, 0.0)), topic='')
    middle, end = shown[29], shown[-1]
    simulation.seek(middle.snapshot.stamp)
    again = simulation.apply_requests()
    assert again.snapshot.step == middle.snapshot.step
    assert again.contacts.impulses.tolist() == middle.contacts.impulses.tolist() != []
    simulation.seek(end.snapshot.stamp)
    again = simulation.apply_requests()
    assert again.snapshot.scene.names == ('disc/0', 'disc/1')


def test_a_space_that_is_given_up_while_it_is_built_changes_no_bits(monkeypatch):
    monkeypatch.setattr(checkpoint, '_SLICE', 20)
    many = Simulation(settings=FLOOR)
    for number in range(200):
        place = (0.9 * (number % 30), 1.0 + number // 30, 0.0)
        many.requests.submit(spawning(f'disc/{number}', DISC, place), topic='')
    many.apply_requests()
    state, digests = many.save(), set()
    for parts in (0, 1, 3, 7):
        simulation = Simulation(checkpoints=0.1)
        simulation.begin(state)
        simulation.run(0.1)
        cursor = simulation.past.cursor
        for goal in (0, 20):
            # A checkpoint is due, for which the world is built anew in more parts than these.
            cursor.begin_advance(4)
            assert all(cursor.carry_out_slice() for _ in range(parts))
            assert simulation.step == 24
            # The way back is given up, too, for another one.
            cursor.seek_step(goal)
            assert all(cursor.carry_out_slice() for _ in range(parts))
            cursor.seek_step(24)
            assert cursor.arrive().step_count == 24
        simulation.run(0.1)
        digests.add(simulation.world.digest())
        assert not simulation.past.reports
    assert len(digests) == 1


def test_requests_that_are_replayed_at_one_step_are_replayed_bit_by_bit():
    simulation = Simulation(settings=FLOOR, speed=0.0)
    for number in range(40):
        disc = spawning(f'disc/{number}', DISC, (0.0, number + 1.0, 0.0))
        simulation.requests.submit(disc, topic='')
        if number == 38:
            simulation.apply_requests()
            digest = simulation.world.digest()
    simulation.apply_requests()
    simulation.undo()
    ticks, _ = ticks_to_a_frame(simulation, 0)
    assert ticks > 30
    assert simulation.world.digest() == digest


def test_an_undo_among_requests_that_are_replayed_at_one_step_takes_the_last_one():
    # Found by seed 9100180: a replay that goes on by slices was left between two requests.
    simulation = Simulation(settings=FLOOR)
    simulation.advance_frame()
    for number in range(4):
        disc = spawning(f'disc/{number}', DISC, (0.0, number + 1.0, 0.0))
        simulation.requests.submit(disc, topic='')
    simulation.apply_requests()
    simulation.advance_frame()
    together, head = simulation.frame_steps, simulation.step
    simulation.past.frames.drop_from(0)
    simulation.seek(0)
    told = set()
    for tick in range(30):
        simulation.advance(tick * SECOND // 60, OVERDUE)
        told.add((simulation.step, simulation.past.cursor.is_working, simulation.status.undo))
        if simulation.step == together and simulation.past.cursor.is_working:
            break
    assert {words for step, _, words in told if step < together} == {''}
    assert (together, True, 'undo spawn disc/3') in told
    assert simulation.undo().startswith('undid spawn disc/3')
    assert simulation.apply_requests().snapshot.scene.names == ('disc/0', 'disc/1', 'disc/2')
    simulation.redo()
    assert len(simulation.apply_requests().snapshot.scene.names) == 4
    assert simulation.past.line.head == head


def of_anna_and_ben(seconds: int) -> Simulation:
    """Return a paused world in which Anna and Ben have added a disc each, some time ago."""
    spawns = [spawning(f'{name}/0', DISC, (x, 2.0 * x + 1.0, 0.0)) for x, name in enumerate(NAMES)]
    timed = [(frame, name, spawns[frame]) for frame, name in enumerate(NAMES)]
    simulation = world_after(*timed, frames=60 * seconds + 2)
    simulation.speed = 0.0
    return simulation


def test_a_gesture_is_taken_back_bit_by_bit_while_the_past_is_told_as_if_it_were_done(steps):
    simulation, other = of_anna_and_ben(seconds=8), of_anna_and_ben(seconds=8)
    take_back(other, 'Anna')
    step = simulation.step
    queue = simulation.requests
    queue.submit(TakeBack(), Origin('~/undo', author='Anna', asker='anna'))
    queue.submit(spawning('late/0', DISC, (5.0, 1.0, 0.0)), topic='~/spawn')
    for tick in range(400):
        steps.clear()
        assert not simulation.advance(tick * SECOND // 60, OVERDUE)
        assert sum(steps) <= simulation.frame_steps
        status = simulation.status
        assert (status.now, status.newest, status.state) == (step / 240, step / 240, 'paused')
        assert not simulation.applier.take_answers()
    _, frame = ticks_to_a_frame(simulation, 400 * SECOND)
    told = [(each.topic, each.message, each.asker) for each in frame.answers]
    assert told[0] == ('~/undo', 'undid spawn Anna/0', 'anna')
    while len(queue):
        simulation.apply_requests()
    assert simulation.step == step
    other.perform(spawning('late/0', DISC, (5.0, 1.0, 0.0)))
    assert simulation.world.digest() == other.world.digest()


def test_a_refused_amendment_goes_back_bit_by_bit(steps):
    simulation = of_anna_and_ben(seconds=2)
    simulation.perform(MoveBodies(names=('Anna/0',), by=(1.0, 0.0)))
    simulation.run(2.0)
    before = simulation.world.digest()
    simulation.requests.submit(TakeBack(), Origin('~/undo', author='Anna'))
    for tick in range(1000):
        steps.clear()
        frames = simulation.advance(tick * SECOND // 60, OVERDUE)
        assert sum(steps) <= simulation.frame_steps
        if frames:
            break
    assert [answer.code for answer in frames[0].answers] == ['not_alone']
    assert simulation.world.digest() == before


@pytest.mark.parametrize('way', ['seek', 'undo', 'queued', 'told', 'contacts', 'begin', 'reader'])
def test_an_amendment_under_way_is_finished_before_anything_else_moves(way):
    simulation = of_anna_and_ben(seconds=2)
    simulation.requests.submit(TakeBack(), Origin('~/undo', author='Anna'))
    for tick in range(20):
        assert not simulation.advance(tick * SECOND // 60, OVERDUE)
    assert simulation.past.cursor.is_amending
    match way:
        case 'seek':
            simulation.seek(SECOND)
        case 'undo':
            simulation.undo()
        case 'queued':
            simulation.requests.submit_seek(SECOND, Origin('~/seek'))
            assert not simulation.applier.apply_ready()
            assert simulation.past.cursor.is_amending
        case 'told':
            # An answer changes nothing, and does not wait.
            simulation.requests.tell(Answer(topic='~/speed', message='speed 1'))
            assert not simulation.applier.apply_ready()
            assert [each.message for each in simulation.applier.take_answers()] == ['speed 1']
            assert simulation.past.cursor.is_amending
        case 'contacts':
            # A paused world makes its last steps again.
            simulation.reports_contacts = True
        case 'begin':
            simulation.begin(WorldState(settings=FLOOR))
        case 'reader':
            assert simulation.world.scene.names == ('Ben/0',)
    while len(simulation.requests):
        simulation.apply_requests()
    told = simulation.applier.take_answers() or simulation.frame.answers
    assert 'undid spawn Anna/0' in [answer.message for answer in told]
