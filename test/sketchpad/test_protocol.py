# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Frames of a page are those of the world, and its messages become the world's own requests."""

import asyncio
import inspect
import itertools
import json
import math
from pathlib import Path
import re
import threading
import time
from typing import Any
from urllib.parse import quote

import numpy as np
from physsim_ros.files import load_world, text_of
from physsim_ros.model.answer import Answer
from physsim_ros.model.snapshot import Grip
from physsim_ros.simulation import hands
from physsim_ros.simulation.entries import Wait
from physsim_ros.simulation.past.line import CachedFrame
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.sketchpad import body_pasts, page_session, past_contacts, Role
from physsim_ros.sketchpad.inbox import Inbox
from physsim_ros.sketchpad.message import KINDS, Message
from physsim_ros.sketchpad.messages import worlds
from physsim_ros.sketchpad.page_session import PageSession
from physsim_ros.sketchpad.person import author_of
from physsim_ros.sketchpad.server import open_pages
from physsim_ros.sketchpad.server.frame_codec import Show
from physsim_ros.sketchpad.server.page_handlers import PAGE
from physsim_ros.testing import PhysSim
from physsim_ros.view import Viewer
import pytest
from rclpy.parameter import Parameter

from .browser import Browser, Page
from ..outside import PATIENCE

BOX, GATE = {'width': 1, 'height': 1}, {'width': 0.2, 'height': 2}


def circle(x: float, y: float, radius: float) -> list[list[float]]:
    turns = [math.tau * each / 60 for each in range(61)]
    return [[x + radius * math.cos(a), y + radius * math.sin(a), a / 6] for a in turns]


def grips(physsim: PhysSim) -> tuple[Grip, ...]:
    return physsim.node.simulation.world.snapshot().grips


def test_a_kind_of_message_has_the_fields_of_its_function() -> None:
    for name, kind in KINDS.items():
        signature = inspect.signature(kind.handle).parameters
        # The session, by another name where a field is the number of a page.
        session = 'session' if 'session' in signature else 'page'
        parameters = signature.keys() - {'origin', 'socket', session}
        others = {
            each for each in parameters if signature[each].kind is inspect.Parameter.VAR_KEYWORD
        }
        named = parameters - others
        assert kind.fields.keys() >= named if others else kind.fields.keys() == named, name


def test_a_page_gets_the_poses_of_the_world(browser: Browser) -> None:
    physsim, page = browser.physsim, browser.open_page()
    page.send('stroke', points=circle(0.0, 5.0, 0.5))
    page.until(lambda: physsim.names)
    physsim.run(0.5)
    page.until_frame(lambda frame: frame.time == pytest.approx(0.5))
    picture, scene = page.frames[-1], page.last('scene')
    assert [body['name'] for body in scene['bodies']] == list(physsim.names)
    assert picture.epoch == scene['epoch']
    assert picture.poses == pytest.approx(np.array([physsim.pose(physsim.names[0])]), abs=1e-6)
    assert picture.poses[0, 1] < 5.0


def test_a_page_that_only_shows_gets_the_contacts_of_a_paused_world(browser: Browser) -> None:
    physsim, drawing = browser.physsim, browser.open_page()
    physsim.node.outputs.records_contacts = False
    for name, y, anchored in (('a/0', 0.0, True), ('b/0', 0.9, False)):
        assert drawing.spawn(name, y=y, box=BOX, anchored=anchored)['ok']
    physsim.run(0.1)
    physsim.node.simulation.speed = 0.0
    page = browser.open_page(cookie=browser.cookie_of(Role.VIEW))
    page.until(lambda: page.frames)
    page.send('show', contacts=True)
    page.until(lambda: physsim.node.outputs.wants_contacts)
    physsim.node.loop.apply_requests()
    page.until_frame(lambda frame: frame.flags & Show.CONTACTS)
    contacts, steps = page.frames[-1].columns[6:8].view('<u4')
    assert (contacts, steps) == (1, 4)


def test_each_answer_goes_to_the_page_that_asked_and_is_told_to_the_others(
    browser: Browser,
) -> None:
    one, other = browser.open_page(), browser.open_page()
    id_ = one.send('click', tool='anchor', point=[0.0, 0.0])
    one.until(lambda: one.answers(id_))
    assert one.answers(id_)[0]['code'] == 'nothing_there'
    other.until(lambda: other.of_type('answer'))
    assert other.answers('')[0]['code'] == 'nothing_there'
    assert not other.answers(id_)


def test_a_frame_comes_after_its_answers_and_the_timeline_that_it_is_shown_with(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    original = asyncio.SelectorEventLoop.call_soon_threadsafe

    def call_at_once(loop: Any, call: Any, *words: Any, **options: Any) -> None:
        """Have the server's thread make a call before this one goes on."""
        called = threading.Event()
        original(loop, call, *words, **options)
        original(loop, called.set)
        called.wait(PATIENCE)

    physsim, page = browser.physsim, browser.open_page()
    page.until(lambda: page.of_type('class') and page.frames)
    begin = len(page.order)
    requests = physsim.node.simulation.requests
    requests.tell(Answer(topic='page', message='done', asker='1:a'))
    with monkeypatch.context() as patch:
        patch.setattr(asyncio.SelectorEventLoop, 'call_soon_threadsafe', call_at_once)
        physsim.step()
    page.until(lambda: 'frame' in page.order[begin:])
    assert page.order[begin:] == ['answer', 'timeline', 'frame']


def test_the_thread_of_the_server_sleeps_while_no_page_is_open(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    woken: list[object] = []
    page, sketchpad = browser.open_page(), browser.physsim.node.outputs.sketchpad
    assert page.ask('follow', names=['a/0'])['ok']
    page.close()
    browser.until(lambda: not sketchpad.wants_contacts)
    with monkeypatch.context() as patch:
        patch.setattr(
            asyncio.SelectorEventLoop, 'call_soon_threadsafe', lambda *call: woken.append(call)
        )
        browser.physsim.run(0.5)
    assert woken == []
    page = browser.open_page()
    page.until(lambda: page.frames)
    assert page.frames[0].time == pytest.approx(browser.physsim.time)


def test_of_many_answers_in_a_frame_others_get_the_first_and_the_count_of_the_rest(
    browser: Browser,
) -> None:
    one, other = browser.open_page(), browser.open_page()
    requests = browser.physsim.node.simulation.requests
    # As from two pages, and from nobody, in turn.
    for number in range(30):
        for asker in ('1:a', '2:b', ''):
            requests.tell(Answer(topic='page', message=f'{number}', asker=asker))
    browser.physsim.node.loop.apply_requests()
    numbers = [f'{number}' for number in range(30)]
    for page, id_ in ((one, 'a'), (other, 'b')):
        page.until(lambda page=page: any('more' in each['message'] for each in page.answers('')))
        assert [each['message'] for each in page.answers(id_)] == numbers
        # Of the first 20 answers the page has asked for 7; of the other 70, for 23.
        *others, more = page.answers('')
        assert more['message'] == 'and 47 more answers'
        assert len(others) == 13


def test_a_scene_above_the_limit_of_what_is_left_unread_is_shown(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(open_pages, 'MOST_UNREAD', 20_000)
    first = browser.open_page()
    corners = [[math.cos(each / 100), math.sin(each / 100)] for each in range(600)]
    assert first.spawn('big/0', polygon=corners)['ok']
    # Later with the first frame and the timeline behind it, and with a ghost.
    browser.physsim.run(0.5)
    assert first.ask('seek', time=0.2)['ok']
    assert first.ask('change', name='big/0', properties={'velocity': [1, 0]})['ok']
    browser.physsim.run(0.2)
    for page in (first, browser.open_page()):
        page.until(lambda page=page: page.frames and page.ghosts)
        assert [each['name'] for each in page.last('scene')['bodies']] == ['big/0']
        assert len(json.dumps(page.last('scene'))) > open_pages.MOST_UNREAD
        assert not page.closed
        assert page.ask('drop')['ok']


def test_the_hand_of_a_page_throws_a_body(browser: Browser) -> None:
    physsim, page = browser.physsim, browser.open_page()
    assert page.spawn('a/0')['ok']
    physsim.step()
    assert page.ask('grab', point=[0.0, 5.0])['ok']
    for number in range(1, 11):
        page.send('move', point=[0.2 * number, 5.0])
        page.until(lambda x=0.2 * number: grips(physsim)[0].target[0] == x)
        physsim.step()
    page.until_frame(lambda frame: frame.hands and frame.time == physsim.time)
    assert page.frames[-1].hand_lines[0, 2] == pytest.approx(2.0)
    assert page.ask('let_go')['ok']
    assert physsim.twist('a/0').vx > 1.0


def test_a_resting_hand_is_kept_twice_before_it_would_let_go() -> None:
    assert 2e9 * page_session.HAND_PERIOD < hands.LONGEST_SILENCE


def test_a_page_that_is_closed_lets_go(browser: Browser) -> None:
    physsim, page = browser.physsim, browser.open_page()
    assert page.spawn('a/0')['ok']
    assert page.ask('grab', point=[0.0, 5.0])['ok']
    assert grips(physsim)
    page.close()
    browser.until(lambda: not grips(physsim))


def test_a_page_takes_the_runner_up_of_a_stroke_instead(browser: Browser) -> None:
    physsim, page = browser.physsim, browser.open_page()
    for name, x in (('a/0', 0.0), ('b/0', 3.0)):
        assert page.spawn(name, x)['ok']
    line = [[0.03 * number, 5.0, 0.005 * number] for number in range(101)]
    page.ask('stroke', points=line)
    page.until_last('reading', lambda reading: reading['meaning'] == 'rod')
    runner_up = page.last('reading')['runner_up']
    assert page.ask('instead', meaning=runner_up)['ok']
    assert page.last('reading')['meaning'] == runner_up == 'wall'
    page.until(lambda: len(physsim.names) == 3)
    assert page.ask('instead', meaning='nothing of the kind')['code'] == 'not_recognised'


@pytest.mark.parametrize('pause', [0.3, 20.0])
@pytest.mark.parametrize('begins', [100.0, 2e9])
def test_strokes_read_the_same_sent_one_by_one_at_once_or_after_a_lost_connection(
    browser: Browser, pause: float, begins: float
) -> None:
    corners = np.array([[0.0, 4.0], [2.0, 4.0], [2.0, 6.0], [0.0, 6.0], [0.0, 4.0]])
    share = np.linspace(0.0, 1.0, 21)[:, None]
    strokes = [
        np.column_stack((a + share * (b - a), begins + number * (0.5 + pause) + share / 2))
        for number, (a, b) in enumerate(itertools.pairwise(corners))
    ]

    def drawn(page: Page, delivery: str) -> list[str]:
        """Draw a square of four lines; return the author and the colour of what comes of it."""
        assert page.ask('person', name='Anna')['ok']
        assert page.ask('draw_with', color='#ff0000')['ok']
        for number, stroke in enumerate(strokes):
            if number == 2 and delivery == 'connected again':
                key = quote(page.last('welcome')['person'])
                page.close()
                page = browser.open_page(f'/ws?person={key}&again')
            send = page.send if delivery == 'at once' else page.ask
            send('stroke', points=stroke.tolist())
        page.ask('drop')
        browser.physsim.settle()
        past = browser.physsim.node.simulation.past
        bodies, _ = past.added_by(author_of('Anna', Role.DRAW))
        scene = browser.physsim.node.simulation.world.scene
        looks = [f'{each.shape} {each.color}' for each in scene.bodies if each.name in bodies]
        assert len(looks) == len(scene.bodies)
        assert page.ask('service', name='clear')['ok']
        return looks

    ways = [
        drawn(browser.open_page(), delivery)
        for delivery in ('one by one', 'at once', 'connected again')
    ]
    assert ways[0] == ways[1] == ways[2]
    assert len(ways[0]) == (1 if pause < 1.0 else 4)


def test_a_page_draws_with_its_own_material(browser: Browser) -> None:
    physsim, page, other = browser.physsim, browser.open_page(), browser.open_page()
    assert page.ask('draw_with', density=7.0, velocity=[2.0, 0.0], color='#ff0000')['ok']
    for each, x in ((page, 0.0), (other, 3.0)):
        each.send('click', tool='circle', point=[x, 5.0])
        each.ask('click', tool='circle', point=[x + 0.5, 5.0])
    page.ask('copy_machine', names=physsim.names[:1], by=[6.0, 0.0])
    page.until_last('scene', lambda scene: len(scene['bodies']) == 3)
    scene = page.last('scene')
    assert [body['density'] for body in scene['bodies']] == [7.0, 1.0, 7.0]
    assert scene['bodies'][0]['color'] == [1.0, 0.0, 0.0, 1.0] == scene['bodies'][2]['color']
    assert [physsim.twist(name).vx for name in physsim.names] == [2.0, 0.0, 0.0]
    # The pieces of a cut are of the material of their body.
    page.send('click', tool='knife', point=[3.0, 9.0])
    assert page.ask('click', tool='knife', point=[3.0, 1.0])['ok']
    page.until_last('scene', lambda scene: len(scene['bodies']) == 4)
    densities = [body['density'] for body in page.last('scene')['bodies']]
    assert sorted(densities) == [1.0, 1.0, 7.0, 7.0]


def test_worlds_are_listed_saved_opened_shared_and_uploaded(browser: Browser) -> None:
    physsim, page = browser.physsim, browser.open_page()
    shipped = {each['name']: each for each in page.last('worlds')['worlds']}
    assert shipped['newtons_cradle']['shipped']
    picture = browser.fetch(shipped['newtons_cradle']['picture'])
    assert picture.code == 200
    assert picture.headers['Content-Type'] == 'image/svg+xml'
    assert page.spawn('a/0')['ok']
    before = physsim.names, physsim.pose('a/0')
    assert page.ask('save', name='mine')['ok']
    page.until_last('worlds', lambda told: 'mine' in [each['name'] for each in told['worlds']])
    text = page.ask('share')['values']['yaml']
    assert browser.fetch('/world/mine.yaml').body.decode() == text
    assert page.ask('open', name='newtons_cradle')['ok']
    assert len(physsim.names) > 5
    assert browser.open_world(text)['ok']
    assert (physsim.names, physsim.pose('a/0')) == before
    assert page.ask('open', name='../../etc/passwd')['code'] == 'bad_world_file'
    page.close()
    assert browser.open_world('[')['code'] == 'malformed'
    assert browser.open_world('format: 1\n')['ok']
    assert physsim.names == ()


def test_a_run_that_is_sent_is_replayed_to_the_bit(browser: Browser) -> None:
    physsim, page = browser.physsim, browser.open_page()
    teacher = browser.open_page(cookie=browser.cookie_of(Role.TEACH))
    assert page.spawn('floor/0', 0, -1, box={'width': 20, 'height': 1}, anchored=True)['ok']
    for number in range(3):
        assert page.spawn(f'a/{number}', 0.1 * number, 1.5 * number)['ok']
    page.ask('service', name='pause')
    assert page.spawn('b/0', 1.0, 1.0)['ok']
    assert page.ask('delete', names=['b/0'])['ok']
    assert page.ask('change', name='a/2', properties={'velocity': [3.0, 1.0]})['ok']
    page.ask('service', name='play')
    physsim.run(2.0)
    poses = physsim.node.simulation.world.snapshot().poses
    physsim.run(0.5)
    page.ask('seek', time=1.0)
    text = page.ask('share', run=True)['values']['yaml']
    assert page.ask('open_text', world=text)['code'] == 'teacher_only'
    assert teacher.ask('open_text', world=text)['ok']
    physsim.run(2.0)
    assert np.array_equal(physsim.node.simulation.world.snapshot().poses, poses)
    # One undo takes it back.
    assert teacher.ask('service', name='undo')['ok']
    assert physsim.time == pytest.approx(1.0)
    assert teacher.ask('open_text', world='[')['code'] == 'malformed'
    long = 'x' * (worlds.MOST_SENT + 1)
    assert teacher.ask('open_text', world=long)['code'] == 'bad_property'


def test_pages_go_on_while_the_text_of_a_world_is_read(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    page, teacher = browser.open_page(), browser.open_page(cookie=browser.cookie_of(Role.TEACH))
    load_mapping, goes_on = worlds.load_mapping, threading.Event()

    def load_slowly(text: str, *, field: str) -> Any:
        assert goes_on.wait(20.0), 'the pages wait'
        return load_mapping(text, field=field)

    monkeypatch.setattr(worlds, 'load_mapping', load_slowly)
    node = browser.physsim.node
    node.start()
    opening = teacher.send('open_text', world='format: 1')
    page.send('ping')
    page.last('pong')
    for _ in range(20):
        node.tick(time.monotonic_ns())
    assert not teacher.answers(opening)
    goes_on.set()
    teacher.until(lambda: node.tick(time.monotonic_ns()) or teacher.answers(opening))
    assert teacher.answers(opening)[0]['ok']


def test_a_world_is_shared_when_a_seek_under_way_has_ended(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    physsim, page = browser.physsim, browser.open_page()
    assert page.spawn('a/0')['ok']
    physsim.run(1.0)
    simulation = physsim.node.simulation
    # As with ticks, which bring the world to the cached frame that is shown.
    monkeypatch.setattr(physsim.node.loop, 'started', True)
    simulation.seek(500_000_000)
    shared, chosen = page.send('share'), page.send('draw_with', density=7.0)
    sketchpad = physsim.node.outputs.sketchpad
    page.until(lambda: sketchpad.handle_messages() or page.answers(chosen))
    assert not simulation.applier.apply_ready()
    assert not page.answers(shared)
    physsim.node.loop.apply_requests()
    page.until(lambda: sketchpad.handle_messages() or page.answers(shared))
    assert simulation.world.stamp == 500_000_000
    text = text_of(simulation.save(), simulation.physics_rate)
    assert page.answers(shared)[0]['values']['yaml'] == text


def test_the_past_of_a_body_is_told(browser: Browser) -> None:
    physsim, page = browser.physsim, browser.open_page()
    assert page.spawn('a/0')['ok']
    physsim.run(0.5)
    page.send('watch', name='a/0')
    body = page.last('body')
    times = np.array(body['time'])
    assert len(times) == 31
    assert np.array(body['y']) == pytest.approx(5.0 - 9.81 / 2 * times**2, abs=1e-6)
    assert np.array(body['vy']) == pytest.approx(-9.81 * times, abs=1e-6)


def past_forces(page: Page, count: int) -> dict[str, Any]:
    """Pause the world; return the columns of the forces of a past with so many frames."""
    page.ask('service', name='pause')
    told: list[Any] = []

    def received() -> int:
        page.ask('drop')
        told[:] = page.of_type('past_forces')
        return sum(len(each['time']) for each in told)

    page.until(lambda: received() == count)
    columns = told[0].keys() - {'type', 'name'}
    return {name: np.concatenate([each[name] for each in told]) for name in columns}


def test_forces_of_a_past_are_told_of_a_body_that_is_watched_after_it(browser: Browser) -> None:
    physsim, page = browser.physsim, browser.open_page()
    floor = {'box': {'width': 20.0, 'height': 1.0}, 'anchored': True, 'elasticity': 0.0}
    assert page.spawn('floor/0', 0.0, -0.5, **floor)['ok']
    assert page.spawn('a/0', 0.0, 0.6, velocity=[2.0, 0.0], elasticity=0.0)['ok']
    physsim.run(1.0)
    page.send('watch', name='a/0', forces=True)
    page.send('show', contacts=True)
    # Answered when those have been handled.
    page.ask('drop')
    physsim.run(0.1)
    assert not page.of_type('past_forces')
    told = past_forces(page, 60)
    assert (np.diff(told['time']) > 0.0).all()
    assert told['time'][-1] == pytest.approx(1.0, abs=1e-6)
    normal, friction, joint = told['normal'], told['friction'], told['joint']
    mass = page.last('scene')['bodies'][-1]['mass']
    # In the air nothing touches it; then the floor bears it, and turns it.
    assert not normal[0].any()
    assert np.median(normal[20:, 1]) == pytest.approx(9.81 * mass, rel=1e-3)
    assert friction[:, 0].min() < -0.1 * mass
    assert not joint.any()


def test_the_forces_of_a_past_in_water_give_the_acceleration(browser: Browser) -> None:
    physsim, page = browser.physsim, browser.open_page()
    pool = {'box': {'width': 20.0, 'height': 6.0}, 'anchored': True, 'sensor': True}
    water = {'density': 2.0, 'flow': [1.0, 0.0]}
    assert page.spawn('pool/0', 0.0, 0.0, medium=water, **pool)['ok']
    assert page.ask('air', coulomb=5.0)['ok']
    for name, x, charge in (('ion/0', 2.0, 3.0), ('ion/1', 4.0, 2.0)):
        assert page.spawn(name, x, 3.5, charge=charge)['ok']
    physsim.run(1.0)
    page.send('watch', name='ion/0', forces=True)
    page.send('show', contacts=True)
    told, motion = past_forces(page, 60), page.last('body')
    ion = page.last('scene')['bodies'][1]
    forces = sum(told[kind] for kind in ('normal', 'friction', 'joint', 'air'))
    changes = np.diff(np.column_stack((motion['vx'], motion['vy'])), axis=0) * 60.0
    expected = ion['mass'] * (changes - (0.0, -9.81))
    # A frame has the force of its last sub-step, and the change of velocity of all of them.
    middle = (forces[1:] + forces[:-1]) / 2
    assert np.abs(expected).max() > 10.0
    assert middle == pytest.approx(expected[1:], abs=0.1)


def test_the_charge_of_the_robot_that_a_page_shows_is_told_when_it_changes(
    browser: Browser,
) -> None:
    physsim, page = browser.physsim, browser.open_page()
    # 18 C, of which 3.6 C a second are drawn.
    battery = {'capacity': 0.005, 'idle': 3.6, 'level': 0.5}
    robot = {'from': 'turtlebot3_burger', 'battery': battery}
    assert page.ask('spawn', body={'name': 'tb3/0', 'robot': robot, 'at': [0, 0]})['ok']
    physsim.run(0.5)
    assert not page.of_type('battery')
    page.send('show', laser='tb3/0')
    page.until(lambda: page.of_type('battery'))
    assert page.last('battery') == {
        'type': 'battery',
        'name': 'tb3/0',
        'level': pytest.approx(0.4, abs=0.01),
        'current': -3.6,
    }
    physsim.run(3.0)
    page.until(lambda: page.last('battery')['level'] == 0.0)
    count = len(page.of_type('battery'))
    physsim.run(0.5)
    page.ask('drop')
    assert len(page.of_type('battery')) <= count + 1


@pytest.mark.parametrize('over', ['ring/0', 'wheel/0'])
def test_the_force_of_a_rope_in_a_past_is_its_tension_along_each_strand(
    tmp_path: Path, over: str
) -> None:
    path = tmp_path / 'ropes.yaml'
    path.write_text("""
    format: 1
    gravity: [0, -9.81]
    bodies:
      - {name: beam/0, box: {width: 8, height: 1}, at: [2, 5.5], anchored: true}
      - {name: ring/0, box: {width: 1, height: 1}, at: [0, 2], mass: 3}
      - {name: wheel/0, circle: {radius: 0.5}, at: [4, 2], mass: 3}
    joints:
      - {name: r/0, kind: rope, a: beam/0, points: [[-0.5, 5], [0, 2], [0.5, 5]], over: [ring/0]}
      - {name: r/1, kind: rope, a: beam/0, points: [[3.5, 5], [4, 2], [4.5, 5]], over: [wheel/0]}
    """)
    simulation = Simulation()
    simulation.begin(load_world(path))
    simulation.reports_contacts = True
    frames = [simulation.advance_frame() for _ in range(60)]
    cached = [CachedFrame(frame.snapshot, frame.contacts) for frame in frames]
    told = past_contacts.past_forces(cached, over, 240.0)
    assert told['joint'][-1] == pytest.approx((0.0, 3.0 * 9.81), abs=0.05)


def test_pasts_are_told_one_after_the_other_of_each_page_the_last_that_it_asked_for(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(body_pasts, 'PAST_PERIOD', 2.0 * PATIENCE)
    page, other = browser.open_page(), browser.open_page('/ws?view')
    sketchpad = browser.physsim.node.outputs.sketchpad

    def names(page: Page) -> list[str]:
        return [each['name'] for each in page.of_type('body')]

    for name in ('a/0', 'b/0', '', 'c/0', 'd/0'):
        page.send('watch', name=name)
    page.until(lambda: names(page) == ['a/0', ''])
    other.send('watch', name='a/0')
    other.send('watch', name='e/0')
    assert other.ask('seek', time=0.0)['code'] == 'view_only'
    page.ask('drop')
    assert (names(page), names(other)) == (['a/0', ''], [])
    for turn in range(3):
        now = time.monotonic() + 3.0 * PATIENCE * (turn + 1)
        sketchpad._shared.pasts.send_due(now)  # noqa: SLF001
    page.until(lambda: len(names(page)) == 3 and names(other))
    assert (names(page), names(other)) == (['a/0', '', 'd/0'], ['e/0'])


def test_a_world_that_is_too_long_to_share_is_refused(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    page = browser.open_page()
    for number in range(3):
        page.spawn(f'a/{number}', number)
    text = page.ask('share')['values']['yaml']
    monkeypatch.setattr(worlds, 'MOST_SHARED', len(text))
    assert page.ask('share')['ok']
    monkeypatch.setattr(worlds, 'MOST_SHARED', len(text) - 1)
    refused = page.ask('share')
    assert (refused['code'], refused['values']) == ('world_full', {})


def test_a_body_is_spawned_changed_moved_and_deleted_by_name(browser: Browser) -> None:
    physsim, page = browser.physsim, browser.open_page()
    for number in range(3):
        assert page.spawn(f'box/{number}', 2 * number, box=BOX)['ok']
    actor = {'kind': 'path', 'points': [[0, 7]], 'times': [0]}
    assert page.ask('change', name='box/0', properties={'actor': actor})['ok']
    changed = {'friction': 0.9, 'color': '#00ff00', 'velocity': [1, 0], 'at': [0, 7, 0.5]}
    changed['actor'] = None
    assert page.ask('change', name='box/0', properties=changed)['ok']
    assert page.ask('move_bodies', names=['box/1', 'box/2'], by=[0, 3])['ok']
    assert physsim.pose('box/0') == pytest.approx((0, 7, 0.5))
    assert page.ask('change', name='box/0', properties={'anchored': True})['ok']
    assert [physsim.pose(name).y for name in ('box/1', 'box/2')] == [8, 8]
    assert page.ask('place', names=['box/1', 'box/2'], poses=[[1, 2, 0.5], [3, 4, 0]])['ok']
    assert [physsim.pose(name) for name in ('box/1', 'box/2')] == [(1, 2, 0.5), (3, 4, 0)]
    for wrong in ([[1, 2, 0]], [[1, 2, 0], [3, 4]], [[1, 2, 0], [3, 4, None]], 7, [7, 8]):
        refused = page.ask('place', names=['box/1', 'box/2'], poses=wrong)
        assert refused['code'] in ('malformed', 'bad_property')
    assert page.ask('delete', names=['box/1', 'box/2'])['ok']
    assert physsim.names == ('box/0',)
    assert page.ask('service', name='undo')['ok']
    assert len(physsim.names) == 3
    page.until_last('scene', lambda scene: len(scene['bodies']) == 3)
    (box, *_) = page.last('scene')['bodies']
    assert (box['friction'], box['color']) == (0.9, [0.0, 1.0, 0.0, 1.0])
    before = physsim.digest()
    for wrong in (
        {'name': 'box/0', 'properties': {'mood': 1}},
        {'name': 'no/1', 'properties': {}},
    ):
        assert page.ask('change', **wrong)['code'] in ('unknown_property', 'unknown_body')
    assert physsim.digest() == before


def test_more_than_a_thousand_bodies_are_moved_and_deleted_at_once(browser: Browser) -> None:
    physsim, page = browser.physsim, browser.open_page()
    names = [f'disc/{each}' for each in range(1200)]
    lines = [
        f'  - {{name: {name}, circle: {{radius: 0.1}}, at: [{row % 40}, {row // 40}]}}'
        for row, name in enumerate(names)
    ]
    assert browser.open_world('\n'.join(['format: 1', 'bodies:', *lines]))['ok']
    assert page.ask('move_bodies', names=names, by=[0, 50])['ok']
    assert physsim.pose('disc/1199').y == 79
    assert page.ask('delete', names=names)['ok']
    assert physsim.names == ()
    assert page.ask('service', name='undo')['ok']
    assert len(physsim.names) == 1200


def test_a_change_of_the_past_branches_and_the_old_course_stays_as_a_ghost(
    browser: Browser,
) -> None:
    physsim, page = browser.physsim, browser.open_page()
    physsim.node.set_parameters([Parameter('speed', value=0.0)])
    assert page.spawn('a/0')['ok']
    physsim.run(1.0)
    fallen, digest = physsim.pose('a/0'), physsim.digest()
    assert page.ask('seek', time=0.5)['ok']
    page.until_last('timeline', lambda timeline: timeline['state'] == 'in the past')
    assert page.last('timeline')['newest'] == pytest.approx(1.0)
    assert page.ask('change', name='a/0', properties={'velocity': [3, 0]})['ok']
    page.until_last('timeline', lambda timeline: timeline['courses'])
    (left,) = page.last('timeline')['courses']
    assert page.last('timeline')['parts'] == pytest.approx(0.5)
    assert (left['from'], left['to']) == pytest.approx((0.5, 1.0))
    physsim.run(0.5)
    page.until(lambda: any(each.time == pytest.approx(1.0) for each in page.ghosts))
    (ghost,) = [each for each in page.ghosts if each.time == pytest.approx(1.0)][-1:]
    assert ghost.epoch == page.last('ghost')['epoch']
    assert ghost.poses[0] == pytest.approx(np.array(fallen), abs=1e-6)
    assert physsim.pose('a/0').x == pytest.approx(1.5, abs=1e-6)
    assert page.ask('course', course=left['id'])['ok']
    assert physsim.digest() == digest
    undone = page.ask('service', name='undo')
    assert undone['message'].startswith('undid')
    told = [each for each in page.of_type('answer') if each['message'] == undone['message']]
    assert len(told) == 1


def test_touches_of_a_gate_are_told_once_it_is_followed_those_of_the_past_too(
    browser: Browser,
) -> None:
    physsim, page, late = browser.physsim, browser.open_page(), browser.open_page()
    assert page.ask('gravity', gravity=[0, 0])['ok']
    for name, x in (('gate/0', 1.2), ('gate/1', 6.2)):
        assert page.spawn(name, x, 0, box=GATE, anchored=True, sensor=True)['ok']
    assert page.spawn('ball/0', 0, 0, velocity=[1, 0])['ok']
    assert page.ask('follow', names=['gate/0'])['ok']
    physsim.run(7.0)
    assert not late.of_type('touches')
    assert late.ask('follow', names=['gate/0', 'gate/1'])['ok']

    late.until(lambda: physsim.step() or len(late.of_type('touches')) == 2)

    (live,) = page.of_type('touches')
    first, second = (each['touches'][0] for each in late.of_type('touches'))
    assert [live['touches'][0][:2], first[:2], second[:2]] == [
        ['gate/0', 'ball/0'],
        ['gate/0', 'ball/0'],
        ['gate/1', 'ball/0'],
    ]
    # 0.6 m and 5.6 m at 1 m/s.
    assert (live['touches'][0][2], first[2], second[2]) == pytest.approx((0.6, 0.6, 5.6), abs=1e-4)
    assert len(live['touches']) == 1
    assert page.ask('follow', names=[])['ok']
    assert page.ask('follow', names='gate/0')['code'] == 'bad_property'


def spawned_robot(page: Page) -> None:
    assert page.ask('gravity', gravity=[0, 0])['ok']
    assert page.spawn('tb3/0', 0, 0, robot='turtlebot3_burger')['ok']


def test_a_page_drives_a_robot_and_undoes_it_as_one(browser: Browser) -> None:
    physsim, page = browser.physsim, browser.open_page()
    spawned_robot(page)
    page.until_last('scene', lambda scene: scene['bodies'])
    robot = page.last('scene')['bodies'][0]['robot']
    assert (robot['kind'], robot['namespace']) == ('differential', 'tb3_0')
    for velocity in ([0.2, 0, 0], [0.1, 0, 0], [0, 0, 0]):
        page.send('drive', name='tb3/0', velocity=velocity)
        page.ask('drop')
        physsim.run(0.4)
    driven = physsim.pose('tb3/0').x
    assert 0.1 < driven < 0.13
    physsim.run(1.0)
    # It has stopped, and stays.
    assert physsim.pose('tb3/0').x == pytest.approx(driven, abs=0.01)
    # Another robot that the page drives is undone by itself.
    assert page.spawn('tb3/1', 0, 1, robot='turtlebot3_burger')['ok']
    for name in ('tb3/0', 'tb3/1'):
        page.send('drive', name=name, velocity=[0.2, 0, 0])
        page.ask('drop')
        physsim.run(0.4)
    assert page.ask('service', name='undo')['ok']
    assert physsim.pose('tb3/1').x == pytest.approx(0.0, abs=1e-9)
    assert physsim.pose('tb3/0').x > driven + 0.03
    for _ in range(3):
        assert page.ask('service', name='undo')['ok']
    assert physsim.pose('tb3/0').x == pytest.approx(0.0, abs=1e-9)
    assert 'tb3/0' in physsim.names


def test_a_page_moves_a_motor_of_a_robot(browser: Browser) -> None:
    page = browser.open_page()
    assert page.spawn('arm/0', 0, 0, robot='arm')['ok']
    page.until_last('scene', lambda scene: scene['joints'])
    joint = next(each for each in page.last('scene')['joints'] if 'effort' in each)
    rows = joint['b'], joint['a']
    page.until_frame(lambda frame: len(frame.poses) > max(rows))
    before = np.diff([page.frames[-1].poses[row, 2] for row in rows if row >= 0] or [0.0])
    assert page.ask('motor', name=joint['name'], position=0.3)['ok']
    browser.physsim.run(3.0)
    page.until_frame(lambda frame: frame.time > 2.9)
    after = np.diff([page.frames[-1].poses[row, 2] for row in rows if row >= 0] or [0.0])
    assert abs(after - before) == pytest.approx(0.3, abs=0.01)
    assert page.ask('motor', name=joint['name'], position=1e9)['code'] == 'bad_property'
    assert page.ask('motor', name='nobody', position=0.3)['code'] == 'unknown_joint'


def test_a_drive_that_is_no_drive_is_refused(browser: Browser) -> None:
    page = browser.open_page()
    spawned_robot(page)
    assert page.spawn('ball/0', 5, 0)['ok']
    digest = browser.physsim.digest()
    for fields, field, code in (
        ({'name': 'tb3/0', 'velocity': [1, 0]}, 'velocity', 'malformed'),
        ({'name': 'tb3/0', 'velocity': [1, 0, 'a']}, 'velocity', 'bad_property'),
        ({'name': 'tb3/0', 'velocity': [1e9, 0, 0]}, 'velocity', 'bad_property'),
        ({'name': 'ball/0', 'velocity': [1, 0, 0]}, 'name', 'bad_property'),
        ({'name': 'nobody', 'velocity': [1, 0, 0]}, '', 'unknown_body'),
        ({'name': 7, 'velocity': [1, 0, 0]}, 'name', 'bad_property'),
    ):
        answer = page.ask('drive', **fields)
        assert answer['code'] == code, fields
        assert not field or answer['field'] == field
    assert browser.physsim.digest() == digest


def test_no_message_is_carried_out_within_another(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    control, take, handle = browser.physsim.node.control, Inbox.take, PageSession.handle
    control.time.set_speed(0.0)
    taken, within = [], []

    async def step() -> tuple[Answer, ...]:
        control.time.step_now()
        return ()

    def take_noted(inbox: Inbox) -> Any:
        taken.append(inbox)
        return take(inbox)

    def handle_noted(session: PageSession, message: Message) -> None:
        # A message that reads a snapshot has this call begin.
        control.simulation.applier.make_call(step, Wait.FOR_SEEK)
        before = len(taken)
        handle(session, message)
        within.append(len(taken) - before)

    page = browser.open_page()
    monkeypatch.setattr(Inbox, 'take', take_noted)
    monkeypatch.setattr(PageSession, 'handle', handle_noted)
    time = control.simulation.stamp
    assert page.ask('click', tool='circle', point=[0.0, 5.0])['ok']
    assert page.ask('service', name='step')['ok']
    assert control.simulation.stamp > time
    assert {*within} == {0}


def test_driving_in_the_past_begins_another_course(browser: Browser) -> None:
    physsim, page = browser.physsim, browser.open_page()
    spawned_robot(page)
    page.send('drive', name='tb3/0', velocity=[0.2, 0, 0])
    page.ask('drop')
    physsim.run(0.5)
    assert page.ask('seek', time=0.1)['ok']
    page.send('drive', name='tb3/0', velocity=[-0.2, 0, 0])
    page.ask('drop')
    physsim.run(0.4)
    assert physsim.pose('tb3/0').x < 0.0
    page.until_last('timeline', lambda timeline: timeline['courses'])


def test_a_page_gets_the_scans_of_the_robot_that_it_shows(browser: Browser) -> None:
    physsim, page = browser.physsim, browser.open_page()
    spawned_robot(page)
    wall = {'width': 0.2, 'height': 9}
    assert page.spawn('wall/0', 2.1, 0, box=wall, anchored=True)['ok']
    page.send('show', laser='tb3/0')
    page.until_frame(lambda frame: frame.flags & Show.SCAN)
    # All round: the laser, 360 beams, and the first one again.
    x, y, hit = page.frames[-1].scan
    assert len(x) == 362
    assert (x[0], y[0], hit[0]) == pytest.approx((-0.032, 0.0, 0.0), abs=1e-6)
    assert (x[1], y[1], hit[1]) == pytest.approx((2.0, 0.0, 1.0), abs=0.06)
    assert x[181] == pytest.approx(-0.032 - 3.5, abs=1e-5)
    assert not hit[181]
    # At 5 Hz: of the frames of a second, five have another one.
    page.frames.clear()
    for _ in range(60):
        physsim.run(1 / 60)
        seen = len(page.frames)
        page.until(lambda seen=seen: len(page.frames) > seen)
    scans = {frame.scan.tobytes() for frame in page.frames}
    assert 4 <= len(scans) <= 6
    page.send('show', laser='')
    page.until_frame(lambda frame: not frame.flags & Show.SCAN)
    page.send('show', laser='wall/0')
    page.ask('drop')
    assert not page.frames[-1].flags & Show.SCAN


def loaded_files() -> set[Path]:
    """Return the files that a first visit of the page loads, without pictures of worlds."""
    others = {'index.html', 'icons.svg', 'languages/en.json'}
    found, ahead = {PAGE / each for each in others}, [PAGE / 'index.html']
    while ahead:
        path = ahead.pop()
        text = path.read_text(encoding='utf-8')
        # Scripts that a call imports are loaded when somebody asks for them.
        names = re.findall(r"^import .* from '(.*)'", text, re.MULTILINE)
        names += [f'./{name}' for name in re.findall(r'"/page/(\S+)"', text)]
        new = {(path.parent / name).resolve() for name in names} - found
        found |= new
        ahead += [each for each in new if each.suffix == '.js']
    return found


def test_the_page_is_small_on_its_way_and_sent_once(browser: Browser) -> None:
    files = loaded_files()
    size = 0
    for path in files:
        address = f'/page/{path.relative_to(PAGE)}'
        headers = {'Accept-Encoding': 'gzip'}
        response = browser.fetch(address, headers=headers, decompress_response=False)
        assert response.headers['Content-Encoding'] == 'gzip' or len(response.body) < 1024
        size += len(response.body)
        known = headers | {'If-None-Match': response.headers['Etag']}
        assert browser.fetch(address, headers=known).code == 304
    assert len(files) > 30
    # Of the first visit in English [bytes].
    assert size < 120e3


def test_pages_are_told_the_address_of_reruns_page_and_when_it_changes(
    browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    page = browser.open_page()
    assert page.last('welcome')['rerun'] == ''

    monkeypatch.setattr(Viewer, 'page_address', 'http://127.0.0.1:9090/')
    browser.physsim.run(0.1)

    assert page.last('recording')['rerun'] == 'http://127.0.0.1:9090/'
