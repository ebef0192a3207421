# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law: no message of a pupil's page changes a locked body; each kind and request is tried."""

from __future__ import annotations

from collections.abc import Callable, Collection
from concurrent.futures import Future
from functools import partial
from pathlib import Path
from typing import Any

from physsim_ros.drawing import SceneQuery, Tool
from physsim_ros.model import names, requests
from physsim_ros.model.answer import Answer
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import Frozen
from physsim_ros.model.joints import JointKind
from physsim_ros.model.motor_command import CommandPoint, MotorCommand
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Disc
from physsim_ros.model.transform import Point
from physsim_ros.runtime.slices import wrap_future
from physsim_ros.simulation.entries import Origin, Wait
from physsim_ros.simulation.world.world import HANDLERS
from physsim_ros.sketchpad import page_session, Role
from physsim_ros.sketchpad.locks import check_locked, check_moment, check_unchanged, Locks
from physsim_ros.sketchpad.message import KINDS
from physsim_ros.sketchpad.messages.worlds import ACTIONS
from physsim_ros.sketchpad.rights import Right
from physsim_ros.testing import PhysSim
import pytest

from .browser import Browser, Page

# Bodies `a/...` are locked. Free ones are joined to them, and have a rope over one of them.
WORLD = """
format: 1
gravity: [0, 0]
bodies:
- {name: a/0, circle: {radius: 0.5}, at: [0, 5]}
- {name: a/1, robot: arm, at: [0, 0]}
- {name: a/2, circle: {radius: 0.5}, at: [6, 4], anchored: true}
- {name: a/3, circle: {radius: 0.5}, at: [10, 0]}
- {name: a/4, robot: turtlebot3_burger, at: [20, 0]}
- {name: b/0, box: {width: 1, height: 1}, at: [4, 5]}
- {name: b/1, box: {width: 1, height: 1}, at: [8, 0]}
- {name: b/2, circle: {radius: 0.5}, at: [14, 0]}
- {name: b/3, robot: arm, at: [30, 0]}
- {name: carrier/0, circle: {radius: 0.5}, at: [11, 20]}
joints:
- {name: rod/0, kind: rod, a: a/0, b: b/0, points: [[0, 5], [4, 5]]}
- {name: rope/0, kind: rope, a: b/0, b: b/1, points: [[4, 5], [6, 4], [8, 0]], over: [a/2]}
- {name: axle/0, kind: axle, a: a/3, b: b/1, points: [[9, 0]]}
- {name: rod/1, kind: rod, a: b/3/upper/0, b: a/2, points: [[30.2, 0], [6, 4]]}
- {name: gear/0, kind: gear, a: b/1, b: b/2, points: [[11, 0]], ratio: -1, carrier: carrier/0}
"""
ON, FREE, ASIDE = [0.0, 5.0], [4.0, 5.0], [2.0, 8.0]
JOINTS = ('rod/0', 'rope/0', 'axle/0', 'a/1/shoulder/0')
ZIGZAG = [[-0.6 + 0.1 * n, 5.5 if n % 2 else 4.5, 0.05 * n] for n in range(13)]
LINE = [[0.2 * n, 5.0, 0.03 * n] for n in range(21)]
SMALL = [[0.05, 5.0, 0.0], [0.0, 5.05, 0.1], [-0.05, 5.0, 0.2], [0.0, 4.95, 0.3], [0.05, 5.0, 0.4]]
# The messages that a pupil tries, by their kind.
ATTEMPTS: dict[str, list[dict[str, Any]]] = {
    'change': [
        {'name': 'a/0', 'properties': each}
        for each in ({'mass': 2}, {'at': [1, 5, 0]}, {'color': 'red'}, {'circle': {'radius': 1}})
    ],
    'spawn': [
        {'body': {'name': 'a/0', 'circle': {'radius': 1}, 'at': [1, 5]}},
        {'body': {'name': 'a/0', 'robot': 'turtlebot3_burger', 'at': [1, 5]}},
    ],
    'move_bodies': [{'names': ['b/0', name], 'by': [1, 0]} for name in ('a/0', 'a/1/upper/0')],
    'place': [{'names': ['b/0', 'a/0'], 'poses': [[0, 0, 0], [1, 0, 0]]}],
    'copy_machine': [
        {'names': names, 'by': [0, 40]} for names in (['a/0', 'b/0'], ['a/0'], ['a/1'])
    ],
    # The rod of `b/0` is that of `a/0`, too.
    'delete': [{'names': [name]} for name in ('a/0', 'a/1', 'a/1/upper/0', 'b/0')],
    'drive': [{'name': name, 'velocity': [1, 0, 1]} for name in ('a/0', 'a/4')],
    'change_joint': [
        {'name': name, 'properties': properties}
        for name in JOINTS
        for properties in ({'effort': 1}, {'collide': True}, {'length': 1}, {'max_force': 1})
    ],
    'motor': [{'name': name, 'position': 0.5} for name in JOINTS],
    'unjoin': [{'name': name} for name in JOINTS],
    'stroke': [{'points': points} for points in (ZIGZAG, LINE, LINE[::-1], SMALL)],
    'instead': [{}, {'meaning': 'delete'}],
    'click': [
        {'tool': tool, 'point': point}
        for tool in Tool
        for points in ((ON, FREE, ON), (FREE, ON, FREE), ([-1.0, 5.2], [1.0, 5.2], ASIDE))
        for point in points
    ],
    'drop': [{}],
    'draw_with': [{'density': 3.0}],
    'grab': [{'point': ON}, {'point': [0, 0]}],
    'move': [{'point': ASIDE}, {'point': ASIDE, 'yaw': 1.0}],
    'let_go': [{}],
    'take_back': [{}],
    'service': [
        *({'name': name} for name in ACTIONS),
        {'name': 'load_world', 'world': 'demo'},
        {'name': 'save_world', 'world': 'demo'},
    ],
    'speed': [{'speed': 2.0}, {'speed': -1.0}, {'speed': 0.0}],
    'course': [{'course': 0}, {'course': 1}],
    'open': [{'name': 'demo'}],
    'save': [{'name': 'mine'}, {'name': 'mine', 'replace': True}],
    'rename': [{'name': 'mine', 'to': 'yours'}],
    'remove': [{'name': 'yours'}],
    'put_back': [{'name': 'yours'}],
    'forget': [{}],
    'share': [{}, {'run': True}],
    'person': [{'name': 'Teacher'}, {'name': 'Anna'}],
    'answered': [{'lesson': 'x', 'answer': '1', 'right': True}],
    'raise_hand': [{'raised': True}],
}
# The kinds that change those bodies where they are not locked.
CHANGING = (
    *('change', 'spawn', 'move_bodies', 'place', 'delete', 'drive', 'change_joint', 'motor'),
    *('unjoin', 'stroke', 'click', 'grab', 'take_back', 'service', 'open'),
)
# About the world, the moment that is shown, or what the pages of others show.
ELSEWHERE = {'gravity', 'air', 'seek', 'here'}


def states_of(physsim: PhysSim, patterns: Collection[str]) -> dict[str, str]:
    """Return all that there is of each body whose name is one of those: state, joints, hands."""
    world, locks = physsim.node.simulation.world, Locks(patterns)
    state, states = world.save(), {}
    for held in state.bodies:
        name = held.body.name
        if locks.has(name):
            joints = {each.name: each for each in state.joints if name in each.bodies}
            commands = [each for each, _ in state.commands if each.joint in joints]
            hands = [each for each in world.grips if each.body == name]
            own = (held.body, held.pose, held.twist, held.wrench, held.driven, held.coming)
            states[name] = repr((own, joints, commands, hands))
    return states


def load_world(browser: Browser, tmp_path: Path) -> None:
    """Load the world of the locked bodies."""
    path = tmp_path / 'locked.yaml'
    path.write_text(WORLD)
    browser.physsim.load(path)
    browser.physsim.step()


def opened(browser: Browser, tmp_path: Path) -> tuple[Page, Page]:
    """Return the pages of a pupil and of a teacher, in the world of the locked bodies."""
    load_world(browser, tmp_path)
    pupil, boss = browser.open_page(), browser.open_page(cookie=browser.cookie_of(Role.TEACH))
    # A gesture that is undone, taken back or read anew is about a body that is locked then.
    assert pupil.ask('change', name='a/0', properties={'friction': 0.3})['ok']
    assert boss.ask('lock', names=['a/*'])['ok']
    return pupil, boss


def tell(page: Page, kind: str, fields: dict[str, Any]) -> None:
    """Send a message, and wait until it is carried out."""
    if kind not in ('move', 'drive'):
        page.ask(kind, **fields)
        return
    # They are answered only if they are refused.
    page.send(kind, **fields)
    page.ask('raise_hand', raised=False)


def test_every_kind_of_message_that_a_pupil_may_send_is_tried() -> None:
    sent = {name for name, kind in KINDS.items() if kind.right in (Right.CHANGE, Right.DRAW)}
    assert sent == ATTEMPTS.keys() | ELSEWHERE


@pytest.mark.parametrize('kind', CHANGING)
def test_what_changes_bodies_changes_no_locked_one(
    browser: Browser, tmp_path: Path, kind: str
) -> None:
    pupil, boss = opened(browser, tmp_path)
    before = states_of(browser.physsim, ['a/*'])

    def changes(fields: dict[str, Any]) -> bool:
        tell(pupil, kind, fields)
        return states_of(browser.physsim, ['a/*']) != before

    assert [fields for fields in ATTEMPTS[kind] if changes(fields)] == []
    # A kind of which no attempt would do anything would not be tried.
    assert boss.ask('lock', names=[])['ok']
    assert any(map(changes, ATTEMPTS[kind]))


def test_what_is_about_other_things_changes_no_locked_body(
    browser: Browser, tmp_path: Path
) -> None:
    pupil, _ = opened(browser, tmp_path)
    before = states_of(browser.physsim, ['a/*'])
    for kind in [each for each in ATTEMPTS if each not in CHANGING]:
        for fields in ATTEMPTS[kind]:
            tell(pupil, kind, fields)
            assert states_of(browser.physsim, ['a/*']) == before, (kind, fields)


# Roles that may send a message of each right.
ALLOWED = {
    Right.LOOK: {*Role},
    Right.DRAW: {Role.DRAW, Role.TEACH},
    Right.CHANGE: {Role.DRAW, Role.TEACH},
    Right.TEACH: {Role.TEACH},
}
# Fields of the messages that only a teacher sends, or that change no body.
OTHER_FIELDS: dict[str, dict[str, Any]] = {
    'gravity': {'gravity': [0, 0]},
    'air': {'damping': 0.0},
    'seek': {'time': 0.0},
    'watch': {'name': ''},
    'follow': {'names': []},
    'forget_results': {},
    'lower_hand': {'page': 1},
    'leave': {},
    'say': {'text': 'x'},
    'freeze': {'frozen': False},
    'lock': {'names': ['a/*']},
    'clear_of': {'person': 'Nobody'},
    'open_text': {'world': WORLD},
}


def test_each_kind_of_message_is_for_the_roles_of_its_right(
    browser: Browser, tmp_path: Path
) -> None:
    pupil, boss = opened(browser, tmp_path)
    viewer = browser.open_page('/ws?view')
    pages = {Role.VIEW: viewer, Role.DRAW: pupil, Role.TEACH: boss}
    # A new kind is in the table of this test or of the other one.
    kinds = {name: kind.right for name, kind in KINDS.items() if kind.for_world}
    assert kinds.keys() == (ATTEMPTS.keys() | OTHER_FIELDS.keys())
    assert boss.ask('freeze', frozen=True)['ok']
    for name, right in kinds.items():
        fields = OTHER_FIELDS.get(name) or next(iter(ATTEMPTS.get(name, [{}])))
        for role in {*Role} - ALLOWED[right]:
            refused = 'view_only' if role is Role.VIEW else 'teacher_only'
            assert pages[role].ask(name, **fields)['code'] == refused, (name, role)
        if right is Right.CHANGE:
            assert pupil.ask(name, **fields)['code'] == 'frozen', name


def test_a_pattern_is_one_of_bodies_and_not_of_the_background(
    browser: Browser, tmp_path: Path
) -> None:
    pupil, boss = opened(browser, tmp_path)
    assert boss.ask('lock', names=['w*', 'world'])['ok']
    for number, b in enumerate(('', names.WORLD)):
        joint = requests.Join(name=f'pin/{number}', kind='pin', a='b/0', b=b, points=((4.0, 5.0),))
        check_locked(Role.DRAW, [joint], browser.physsim.node.control)
    assert pupil.ask('click', tool='anchor', point=[4.0, 5.0])['ok']
    assert pupil.spawn('w/0', 8.0)['code'] == 'frozen'


# A request of each type that the world carries out, about body `b/0` or what is joined to it.
REQUESTS = (
    requests.Spawn(name='b/0', shape=Disc(radius=1.0)),
    requests.ChangeBody(name='b/0'),
    requests.Cut(pieces=(requests.ChangeBody(name='b/0'),)),
    requests.MoveBodies(names=('b/0',), by=(1.0, 0.0)),
    requests.Command(names=('b/0',)),
    requests.Anchor(point=(4.0, 5.0)),
    requests.Release(point=(4.0, 5.0)),
    requests.Delete(name='b/0'),
    requests.DeleteBodies(names=('b/0',)),
    requests.DeleteAll(),
    requests.Join(name='j/0', kind='pin', a='b/0', points=((4.0, 5.0),)),
    requests.Rejoin(name='rod/0', a='a/0', b='b/0'),
    requests.Pin(point=(4.0, 5.0)),
    requests.Axle(point=(4.0, 5.0)),
    requests.Unjoin(name='rod/0'),
    requests.UnjoinAll(),
    requests.Grab(hand='x', point=(4.0, 5.0)),
    requests.MoveHand(hand='held', point=(0.0, 0.0)),
    requests.KeepHand(hand='held'),
    requests.CommandMotors(
        commands=(MotorCommand(joint='rod/0', mode='effort', points=(CommandPoint(0.0, 1.0),)),)
    ),
    requests.DriveRobot(name='b/0', velocity=(1.0, 0.0, 0.0)),
    requests.Restore(state=WorldState(settings=WorldSettings())),
)
# Those that are carried out for pupils, whatever is locked.
HARMLESS = (requests.Configure(changes={'friction': 1.0}), requests.LetGo(hand='held'))


class Unheard(requests.Request):
    """A request that the rights do not know."""


def test_each_request_of_the_world_is_tried() -> None:
    assert {type(each) for each in (*REQUESTS, *HARMLESS)} == HANDLERS.keys()


def test_a_pupil_has_no_request_for_a_locked_body_carried_out(
    browser: Browser, tmp_path: Path
) -> None:
    _, boss = opened(browser, tmp_path)
    simulation, control = browser.physsim.node.simulation, browser.physsim.node.control
    simulation.perform(requests.Grab(hand='held', point=(4.0, 5.0)))
    # A request that names a body that is not locked.
    check_locked(Role.DRAW, [requests.Spawn(name='b/1', shape=Disc(radius=1.0))], control)
    assert boss.ask('lock', names=['b/0'])['ok']
    for request in (*REQUESTS, Unheard()):
        with pytest.raises(Frozen):
            check_locked(Role.DRAW, [request], control)
        check_locked(Role.TEACH, [request], control)
    check_locked(Role.DRAW, HARMLESS, control)


SHOULDER = MotorCommand(joint='a/1/shoulder/0', mode='effort', points=(CommandPoint(0.0, 1.0),))
# A body, and requests for other bodies of its machine, or for its joints.
OF_MACHINES = {
    'a/1': (
        requests.MoveBodies(names=('a/1/upper/0',), by=(1.0, 0.0)),
        requests.Command(names=('a/1/upper/0',), poses=[[1.0, 0.0, 0.0]]),
        requests.Delete(name='a/1/upper/0'),
    ),
    'a/1/upper/0': (
        requests.ChangeBody(name='a/1'),
        requests.Delete(name='a/1'),
        requests.CommandMotors(commands=(SHOULDER,)),
    ),
    # A rope passes over it, and the part of a robot has a rod to it.
    'a/2': (
        requests.Unjoin(name='rope/0'),
        requests.Rejoin(name='rope/0', a='b/0', b='b/1'),
        requests.Delete(name='b/3'),
    ),
    'carrier/0': (
        requests.Command(names=('carrier/0',), poses=[[11.0, 21.0, 0.0]]),
        requests.Unjoin(name='gear/0'),
        requests.Rejoin(name='gear/0', a='b/0', b='b/1'),
    ),
}


@pytest.mark.parametrize('locked', OF_MACHINES)
def test_a_machine_is_locked_with_any_of_its_bodies(
    browser: Browser, tmp_path: Path, locked: str
) -> None:
    load_world(browser, tmp_path)
    control = browser.physsim.node.control
    check_locked(Role.DRAW, OF_MACHINES[locked], control)
    control.set_parameter('sketchpad_locked', locked)
    for request in OF_MACHINES[locked]:
        with pytest.raises(Frozen):
            check_locked(Role.DRAW, [request], control)


def test_a_pupil_loosens_no_joint_of_a_locked_body(browser: Browser, tmp_path: Path) -> None:
    load_world(browser, tmp_path)
    pupil, boss = browser.open_page(), browser.open_page(cookie=browser.cookie_of(Role.TEACH))
    simulation = browser.physsim.node.simulation
    for name in ('below/0', 'top/0'):
        at = (40.0, 0.0, 0.0)
        simulation.perform(requests.Spawn(name=name, shape=Disc(radius=0.5), pose=at))
    simulation.perform(requests.Pin(point=(39.6, 0.0)))
    release = {'tool': 'release', 'point': [39.6, 0.0]}
    assert pupil.ask('click', **release)['ok']
    assert boss.ask('lock', names=['below/0'])['ok']
    assert pupil.ask('take_back')['code'] == 'frozen'
    assert boss.ask('lock', names=[])['ok']
    assert pupil.ask('take_back')['ok']
    assert boss.ask('lock', names=['below/0'])['ok']
    assert pupil.ask('click', **release)['code'] == 'frozen'
    # Away from the pin, it concerns the topmost body alone.
    check_locked(Role.DRAW, [requests.Release(point=(40.0, 0.45))], browser.physsim.node.control)


def test_a_hand_lets_go_of_what_is_locked_meanwhile(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    load_world(browser, tmp_path)
    pupil, boss = browser.open_page(), browser.open_page(cookie=browser.cookie_of(Role.TEACH))
    assert pupil.ask('grab', point=ON)['ok']
    assert boss.ask('lock', names=['a/*'])['ok']
    pupil.send('move', point=ASIDE)
    pupil.until(lambda: any(each['code'] == 'frozen' for each in pupil.of_type('answer')))
    monkeypatch.setattr(page_session, 'HAND_PERIOD', 0.0)
    browser.until(
        lambda: browser.physsim.step() or not browser.physsim.node.simulation.world.grips
    )


def test_what_waits_while_a_body_is_locked_is_refused_in_its_turn(
    browser: Browser, tmp_path: Path
) -> None:
    """A long seek is under way: the right is there when the message comes, and not later."""
    load_world(browser, tmp_path)
    node = browser.physsim.node
    before = node.control.locked_bodies
    origin = Origin('x', check=lambda: check_unchanged(Role.DRAW, before, node.control))
    node.simulation.requests.submit(requests.Delete(name='a/0'), origin)
    node.control.set_parameter('sketchpad_locked', 'a/*')
    (answer,) = (each for each in node.loop.apply_requests() if each.topic == 'x')
    assert answer.code == 'frozen'
    assert 'a/0' in browser.physsim.names


# Kinds that a pupil sends while nothing is frozen, before any of `ATTEMPTS`.
BEFORE = {'move': ('grab', {'point': FREE}), 'instead': ('stroke', {'points': LINE})}
# Kinds and services that do not wait: they are about the speed, or about files of worlds.
AT_ONCE = {'speed', 'rename', 'remove', 'put_back', 'forget'}
ACTIONS_AT_ONCE = {'play', 'pause', 'rewind', 'fast_forward', 'fast_rewind', 'step'}


def held(physsim: PhysSim) -> Future[None]:
    """Have a call under way for which all entries wait, and return what it waits for."""
    awaited: Future[None] = Future()

    async def call() -> list[Answer]:
        await wrap_future(awaited)
        return []

    physsim.node.loop.make_call(call, Wait.BEHIND_REQUESTS)
    return awaited


def state_of(physsim: PhysSim) -> tuple[object, ...]:
    """Return the moment that is shown, what leads to it, and all that there is of each body."""
    simulation = physsim.node.simulation
    past = simulation.past
    moments = (simulation.step, simulation.speed, past.line.end, past.tree.course)
    return (*moments, simulation.world.digest(), states_of(physsim, ['*']))


@pytest.mark.parametrize(
    'kind', sorted(name for name, kind in KINDS.items() if kind.right is Right.CHANGE)
)
def test_what_waits_while_pupils_are_frozen_is_refused_in_its_turn(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    load_world(browser, tmp_path)
    physsim, waited = browser.physsim, 0
    pupil, boss = browser.open_page(), browser.open_page(cookie=browser.cookie_of(Role.TEACH))
    assert pupil.ask('change', name='a/0', properties={'friction': 0.3})['ok']
    physsim.run(0.5)
    physsim.node.simulation.speed = 0.0
    if kind in BEFORE:
        assert pupil.ask(BEFORE[kind][0], **BEFORE[kind][1])['ok']
    physsim.node.loop.apply_requests()
    # As between two ticks.
    monkeypatch.setattr(physsim.node.loop, 'started', True)
    handle = physsim.node.outputs.sketchpad.handle_messages

    def ask(page: Page, kind: str, **fields: Any) -> dict[str, Any]:
        sent = page.send(kind, **fields)
        page.until(lambda: handle() or page.answers(sent))
        return page.answers(sent)[-1]

    for fields in ATTEMPTS.get(kind) or [OTHER_FIELDS[kind]]:
        before, awaited = state_of(physsim), held(physsim)
        sent = pupil.send(kind, **fields)
        ask(pupil, 'raise_hand', raised=False)
        waits = any(not each.is_answer for each in physsim.node.simulation.requests)
        waited += waits
        assert ask(boss, 'freeze', frozen=True)['ok']
        awaited.set_result(None)
        physsim.node.loop.apply_requests()
        if kind not in AT_ONCE and fields.get('name') not in ACTIONS_AT_ONCE:
            assert state_of(physsim) == before, fields
        if waits:
            # The answer to a click, and that to all requests of a message, may come before.
            codes = partial(lambda sent: {each['code'] for each in pupil.answers(sent)}, sent)
            pupil.until(lambda codes=codes: 'frozen' in codes())
        physsim.node.simulation.speed = 0.0
        assert ask(boss, 'freeze', frozen=False)['ok']
    assert (waited > 0) is (kind not in AT_ONCE)


def test_a_world_whose_file_is_read_while_pupils_are_frozen_is_refused(browser: Browser) -> None:
    control = browser.physsim.node.control
    check_moment(Role.DRAW, control)
    control.set_parameter('sketchpad_frozen', value=True)
    check_moment(Role.TEACH, control)
    with pytest.raises(Frozen):
        check_moment(Role.DRAW, control)


def test_a_gesture_that_is_taken_back_is_looked_up_in_its_turn(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first of two is under way when the second comes: the last gesture is another then."""
    pupil, _ = opened(browser, tmp_path)
    assert pupil.spawn('b/9', 40.0)['ok']
    before, node = states_of(browser.physsim, ['a/*']), browser.physsim.node
    # As between two ticks.
    monkeypatch.setattr(node.loop, 'started', True)
    first, second, heard = *(pupil.send('take_back') for _ in '12'), pupil.send('drop')
    handle = node.outputs.sketchpad.handle_messages
    pupil.until(lambda: handle() or pupil.answers(heard))
    assert not pupil.answers(first)
    node.loop.apply_requests()
    pupil.until(lambda: pupil.answers(second))
    assert pupil.answers(first)[0]['ok']
    assert pupil.answers(second)[0]['code'] == 'frozen'
    assert states_of(browser.physsim, ['a/*']) == before


def test_a_body_is_locked_where_it_is_when_the_turn_of_a_request_comes(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A seek is under way when the message comes, and the page shows the moment before it."""
    pupil, boss = opened(browser, tmp_path)
    node = browser.physsim.node
    spawn = requests.Spawn(name='a/9', shape=Disc(radius=0.5), pose=(0.0, 30.0, 0.0))
    node.simulation.perform(spawn)
    node.simulation.perform(requests.Command(names=('a/9',), twists=[[10.0, 0.0, 0.0]]))
    browser.physsim.run(1.0)
    newest = node.simulation.status.newest
    assert boss.ask('seek', time=newest - 1.0)['ok']
    # As between two ticks.
    monkeypatch.setattr(node.loop, 'started', True)
    node.control.time.submit_seek(round(newest * 1e9), Origin('~/seek'))
    assert not node.simulation.playback.is_there
    sent = pupil.send('grab', point=[10.0, 30.0])
    heard = pupil.send('drop')
    handle = node.outputs.sketchpad.handle_messages
    pupil.until(lambda: handle() or pupil.answers(heard))
    assert not pupil.answers(sent)
    node.loop.apply_requests()
    assert not node.simulation.world.grips
    pupil.until(lambda: pupil.answers(sent))
    assert pupil.answers(sent)[0]['code'] == 'frozen'


AT_POINT: tuple[Callable[[Point, str], requests.Request], ...] = (
    *(
        partial(lambda kind, point, frame: kind(point=point, frame=frame), kind)
        for kind in (requests.Anchor, requests.Release, requests.Pin, requests.Axle)
    ),
    lambda point, frame: requests.Grab(hand='h', point=point, frame=frame),
    lambda point, frame: requests.Join(
        name='j/0', kind=JointKind.PIN, points=(point,), frame=frame
    ),
)


@pytest.mark.parametrize('make', AT_POINT)
def test_a_request_concerns_the_bodies_at_its_points_in_the_world(
    physsim: PhysSim, make: Callable[[Point, str], requests.Request]
) -> None:
    for number, x in enumerate((0.0, 10.0)):
        spawn = requests.Spawn(name=f'a/{number}', shape=Disc(radius=0.5), pose=(x, 0.0, 0.0))
        physsim.node.simulation.perform(spawn)
    query = SceneQuery(physsim.node.simulation.world.snapshot())
    assert [*make((0.0, 0.0), 'a/1').concerned(query)] == [*make((10.0, 0.0), '').concerned(query)]
    assert 'a/1' in make((0.0, 0.0), 'a/1').concerned(query)
