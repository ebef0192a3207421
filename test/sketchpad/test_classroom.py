# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A class in one world: its roles, what a teacher may do, and who did what."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import json
import math
from pathlib import Path
from threading import Event
import time
from types import ModuleType
from typing import Any
from urllib.parse import quote

from physsim_ros.files import DirectoryLock, finish_files, shipped_lessons
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import InUse
from physsim_ros.model.lesson import LONGEST_TITLE
from physsim_ros.ros import time_control, world_files
from physsim_ros.simulation.world import Beginning, beginning_of
from physsim_ros.sketchpad import file_work, results, Role
from physsim_ros.sketchpad.locks import MOST_PATTERNS
from physsim_ros.sketchpad.messages.classroom import LONGEST_ANSWER, LONGEST_MESSAGE
from physsim_ros.sketchpad.messages.fields import LONGEST_PERSON
from physsim_ros.sketchpad.results import MOST_RESULTS, Results, results_file
from physsim_ros.sketchpad.server.access import Access
import pytest
from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter

from .browser import Browser, Page


def teacher(browser: Browser) -> Page:
    """Open the page of a teacher."""
    return browser.open_page(cookie=browser.cookie_of(Role.TEACH))


def people(page: Page) -> list[tuple[str, str]]:
    """Return name and role of each person, as a page knows them."""
    last = page.of_type('class')[-1:]
    return [(each['name'], each['role']) for told in last for each in told['people']]


def test_a_teacher_freezes_the_pages_of_pupils_and_not_the_own(browser: Browser) -> None:
    pupil, boss = browser.open_page(), teacher(browser)
    for page, teaches in ((pupil, False), (boss, True)):
        page.until(lambda page=page: page.of_type('welcome'))
        assert page.last('welcome')['teacher'] is teaches
    assert boss.ask('freeze', frozen=True)['ok']
    pupil.until(lambda: any(each['frozen'] for each in pupil.of_type('class')))
    assert pupil.spawn('a/0')['code'] == 'frozen'
    for kind in ('drop', 'share'):
        assert pupil.ask(kind)['ok'], kind
    assert browser.open_world('format: 1')['code'] == 'frozen'
    assert browser.physsim.names == ()
    assert boss.spawn('a/0')['ok']
    assert boss.ask('freeze', frozen=False)['ok']
    assert pupil.spawn('b/0', 3.0)['ok']


def test_who_is_there_is_told_when_it_changes_and_not_with_each_frame(browser: Browser) -> None:
    page = browser.open_page()
    assert page.ask('person', name='Anna')['ok']
    page.until_last('class', lambda told: told['people'][0]['name'] == 'Anna')
    count = len(page.of_type('class'))
    browser.physsim.run(0.5)
    page.until_frame(lambda frame: frame.time >= 0.5)
    assert len(page.of_type('class')) == count


def test_freezing_and_locking_are_parameters_that_scripts_have_too(browser: Browser) -> None:
    pupil = browser.open_page()
    browser.physsim.node.set_parameters([Parameter('sketchpad_frozen', value=True)])
    assert pupil.spawn('a/0')['code'] == 'frozen'
    parameters = [
        Parameter('sketchpad_frozen', value=False),
        Parameter('sketchpad_locked', value='a/*, b/0'),
    ]
    browser.physsim.node.set_parameters(parameters)
    assert pupil.spawn('a/7')['code'] == 'frozen'
    assert pupil.spawn('b/1')['ok']
    # A script may forbid what a teacher asks for.
    refusal = SetParametersResult(successful=False, reason='not now')
    browser.physsim.node.add_on_set_parameters_callback(lambda _: refusal)
    boss = teacher(browser)
    for kind, fields in (('freeze', {'frozen': True}), ('lock', {'names': ['*']})):
        answer = boss.ask(kind, **fields)
        assert (answer['code'], answer['message']) == ('bad_property', 'not now')
    assert boss.ask('service', name='save_world', world='a')['code'] == 'bad_property'


def test_thousands_of_names_may_be_locked_and_some_patterns(browser: Browser) -> None:
    pupil, boss = browser.open_page(), teacher(browser)
    names = [f'a/{number}' for number in range(5000)]
    patterns = [f'b{number}/*' for number in range(MOST_PATTERNS)]
    assert boss.ask('lock', names=[*names, *patterns])['ok']
    for name in ('a/4999', 'b49/3'):
        assert pupil.spawn(name)['code'] == 'frozen'
    refused = boss.ask('lock', names=[*patterns, 'c/?'])
    assert (refused['code'], 'wildcards' in refused['message']) == ('bad_property', True)
    assert pupil.spawn('c/1')['ok']
    assert pupil.spawn('a/1')['code'] == 'frozen'


def test_time_brings_no_locked_body_back_or_away_but_for_a_teacher(browser: Browser) -> None:
    pupil, boss = browser.open_page(), teacher(browser)
    assert pupil.spawn('b/0', 4.0)['ok']
    browser.physsim.run(0.5)
    assert boss.spawn('a/0')['ok']
    assert pupil.spawn('b/1', 8.0)['ok']
    browser.physsim.run(0.5)
    assert boss.ask('lock', names=['a/*'])['ok']
    moments = [('service', {'name': name}) for name in ('undo', 'redo', 'reset', 'clear')]
    moments += [('course', {'course': 1}), ('open', {'name': 'demo'})]
    for kind, fields in moments:
        assert pupil.ask(kind, **fields)['code'] == 'frozen', (kind, fields)
    before = browser.physsim.node.simulation.world.digest()
    # Before the body was there, a stroke, a click and a hand would begin a course without it.
    assert pupil.ask('seek', time=0.25)['ok']
    assert 'a/0' not in browser.physsim.names
    for kind, fields in (
        *moments,
        ('delete', {'names': ['b/0']}),
        ('grab', {'point': [4, 5]}),
        ('stroke', {'points': [[0, 0, 0], [2, 0, 0.3], [2, 1, 0.6]]}),
        ('click', {'tool': 'delete', 'point': [4, 5]}),
        ('take_back', {}),
    ):
        assert pupil.ask(kind, **fields)['code'] == 'frozen', (kind, fields)
    assert browser.open_world('format: 1')['code'] == 'frozen'
    assert pupil.ask('let_go')['ok']
    assert pupil.ask('seek', time=1.0)['ok']
    assert browser.physsim.node.simulation.world.digest() == before
    assert boss.ask('service', name='reset')['ok']
    assert browser.physsim.names == ()


@pytest.mark.parametrize(
    ('kind', 'fields', 'module'),
    [
        ('open', {'name': 'demo'}, world_files),
        ('service', {'name': 'load_world', 'world': 'demo'}, world_files),
        ('service', {'name': 'reset'}, time_control),
    ],
)
def test_a_lock_holds_though_a_thread_builds_the_world_that_a_pupil_wants(
    browser: Browser,
    monkeypatch: pytest.MonkeyPatch,
    kind: str,
    fields: dict[str, str],
    module: ModuleType,
) -> None:
    pupil = browser.open_page()
    assert pupil.spawn('a/0')['ok']

    def build(state: WorldState, physics_rate: float) -> Beginning:
        # The world's thread of a test waits for this one.
        browser.physsim.node.control.set_parameter('sketchpad_locked', 'a/*')
        return beginning_of(state, physics_rate)

    monkeypatch.setattr(module, 'beginning_of', build)
    assert pupil.ask(kind, **fields)['code'] == 'frozen'
    assert browser.physsim.names == ('a/0',)
    assert not browser.physsim.node.control.values['world_file']


def test_what_is_locked_is_not_taken_back_by_who_made_it(browser: Browser) -> None:
    pupil, boss = browser.open_page(), teacher(browser)
    circle = [[x, y, t] for x, y, t in ring()]
    for ask, lock in (
        (lambda: pupil.spawn('a/0'), 'a/0'),
        (lambda: pupil.ask('change', name='a/0', properties={'friction': 0.1}), 'a/0'),
        (lambda: pupil.ask('move_bodies', names=['a/0'], by=[1, 0]), 'a/*'),
        (lambda: pupil.ask('click', tool='pin', point=[1, 5]), 'a/0'),
        (lambda: pupil.ask('click', tool='anchor', point=[1, 5]), 'a/0'),
        (lambda: pupil.ask('stroke', points=circle), 'drawn/*'),
    ):
        assert ask()['ok']
        assert boss.ask('lock', names=[lock])['ok']
        before = browser.physsim.node.simulation.world.digest()
        assert pupil.ask('take_back')['code'] == 'frozen'
        assert pupil.ask('instead')['ok'] is False
        assert browser.physsim.node.simulation.world.digest() == before
        assert boss.ask('lock', names=[])['ok']
    assert boss.ask('lock', names=['c/0'])['ok']
    assert pupil.ask('take_back')['ok']


def ring() -> Iterator[tuple[float, float, float]]:
    """Yield x, y [m] and time [s] of a circle that is drawn."""
    for number in range(41):
        turn = math.tau * number / 40
        yield 20 + math.cos(turn), 20 + math.sin(turn), 0.03 * number


def test_a_pupil_by_the_name_of_a_teacher_is_not_the_teacher(browser: Browser) -> None:
    pupil, boss = browser.open_page(), teacher(browser)
    assert boss.ask('person', name='Ms Smith')['ok']
    assert boss.spawn('a/0')['ok']
    assert pupil.ask('person', name='Ms Smith')['ok']
    assert pupil.ask('take_back')['code'] == 'out_of_history'
    assert pupil.spawn('b/0', 4.0)['ok']
    assert boss.ask('take_back')['ok']
    assert browser.physsim.names == ('b/0',)


def test_a_lock_belongs_to_its_world(browser: Browser) -> None:
    pupil, boss = browser.open_page(), teacher(browser)

    def locked() -> list[str]:
        told: list[str] = boss.last('class')['locked']
        return told

    assert pupil.spawn('drawn/0')['ok']
    assert boss.ask('lock', names=['drawn/*'])['ok']
    boss.until(lambda: locked() == ['drawn/*'])
    assert boss.ask('open', name='demo')['ok']
    boss.until(lambda: locked() == [])
    assert pupil.spawn('drawn/0', 40.0)['ok']
    assert pupil.ask('service', name='reset')['ok']
    # Back in the world of the lock.
    for _ in range(3):
        assert boss.ask('service', name='undo')['ok']
    boss.until(lambda: locked() == ['drawn/*'])
    assert pupil.ask('delete', names=['drawn/0'])['code'] == 'frozen'
    # The world is the same, with other noise.
    browser.physsim.node.simulation.reset(seed=3)
    browser.physsim.step()
    assert browser.physsim.node.control.locked_bodies == ('drawn/*',)


def test_people_have_names_and_answers_say_who_did_it(browser: Browser) -> None:
    anna, ben, viewer = browser.open_page(), teacher(browser), browser.open_page('/ws?view')
    assert anna.ask('person', name=' Anna ')['ok']
    ben.until(lambda: people(ben) == [('Anna', 'draw'), ('Teacher', 'teach')])
    viewer.until(lambda: ('Anna', 'draw') in people(viewer))
    anna.spawn('a/0')
    ben.until(lambda: any(each.get('subject') == 'a/0' for each in ben.of_type('answer')))
    (told,) = (each for each in ben.of_type('answer') if each['subject'] == 'a/0')
    assert told['page'] == int(anna.last('welcome')['client'])
    for name in ('', '  ', 'x' * 25, 'a\nb', 7, 'Ann\u200ba', 'Ann\u200da', '\u3164'):
        assert anna.ask('person', name=name)['code'] == 'bad_property'
    # Keyboards write one name in several ways.
    assert anna.ask('person', name='Zoe\u0308 \u2764\ufe0f')['ok']
    ben.until(lambda: ('Zo\u00eb \u2764\ufe0f', 'draw') in people(ben))
    anna.close()
    ben.until(lambda: people(ben) == [('Teacher', 'teach')])


def test_each_undoes_what_is_its_own_and_a_teacher_clears_what_one_drew(browser: Browser) -> None:
    anna, ben, boss = browser.open_page(), browser.open_page(), teacher(browser)
    anna.ask('person', name='Anna')
    ben.ask('person', name='Ben')
    for page, name, x in ((anna, 'a/0', -6), (ben, 'b/0', 0), (anna, 'a/1', 6), (ben, 'b/1', 3)):
        assert page.spawn(name, x)['ok']
        browser.physsim.run(0.1)
    assert anna.ask('take_back')['ok']
    assert browser.physsim.names == ('a/0', 'b/0', 'b/1')
    assert boss.ask('clear_of', person='Ben')['ok']
    assert browser.physsim.names == ('a/0',)
    assert boss.ask('clear_of', person='Ben')['code'] == 'nothing_there'
    assert boss.ask('service', name='undo')['ok']
    assert browser.physsim.names == ('a/0', 'b/0', 'b/1')
    assert ben.ask('drop')['ok']
    assert boss.ask('take_back')['code'] == 'out_of_history'


def test_a_page_that_comes_again_with_its_key_is_the_same_person(browser: Browser) -> None:
    anna, ben = browser.open_page(), browser.open_page()
    assert anna.spawn('a/0')['ok']
    assert anna.ask('grab', point=[0, 5])['ok']
    assert anna.spawn('a/1', 3.0)['ok']
    key = quote(anna.last('welcome')['person'])
    # Anna's connection is lost, which the server does not know yet.
    again = browser.open_page(f'/ws?person={key}')
    ben.until(lambda: sorted(people(ben)) == [('Page 1', 'draw'), ('Page 2', 'draw')])
    anna.until(lambda: anna.closed)
    assert anna.socket.close_code == 4000
    # The hand lets go at the next tick.
    ben.until(lambda: not browser.physsim.node.simulation.world.snapshot().grips)
    assert again.ask('take_back')['ok']
    assert browser.physsim.names == ('a/0',)
    again.close()
    # Keys of another run, or of nobody.
    for other in (Access('127.0.0.1', 1).person_key(1), '', '1', '%ff', 'x' * 9000, '2|1:0|'):
        page = browser.open_page(f'/ws?person={quote(other)}')
        page.until(lambda page=page: page.of_type('class'))
        assert ('Page 1', 'draw') not in people(page)
        assert page.ask('person', name='Page 1')['code'] == 'bad_property'
        assert page.ask('person', name='Page Smith')['ok']
        page.close()
    last = browser.open_page(f'/ws?view&person={key}')
    ben.until(lambda: people(ben) == [('Page 2', 'draw')])
    assert last.ask('take_back')['code'] == 'view_only'


def test_a_pupil_who_sleeps_while_the_seat_is_freed_does_not_come_back_into_the_world(
    browser: Browser,
) -> None:
    boss, anna, ben = teacher(browser), browser.open_page(), browser.open_page()
    keys = {page: quote(page.last('welcome')['person']) for page in (boss, anna, ben)}
    anna.close()
    assert boss.ask('leave')['ok']
    boss.close()
    ben.last('leave')
    # Anna's page and the one of Ben, who does not obey, connect again.
    for page in (anna, ben):
        again = browser.open_page(f'/ws?person={keys[page]}')
        again.until(lambda again=again: again.closed)
        assert again.order == ['leave']
    # Who comes anew, who watches, and who teaches is not meant.
    for path, cookie in (
        ('/ws', None),
        (f'/ws?view&person={keys[anna]}', None),
        (f'/ws?person={keys[boss]}', browser.cookie_of(Role.TEACH)),
    ):
        page = browser.open_page(path, cookie=cookie)
        page.last('class')
        assert not page.of_type('leave')
    assert page.ask('leave')['ok']


def test_an_undo_of_what_another_person_has_used_since_is_refused(browser: Browser) -> None:
    anna, ben = browser.open_page(), browser.open_page()
    assert anna.spawn('a/0')['ok']
    assert ben.ask('change', name='a/0', properties={'friction': 0.1})['ok']
    assert anna.ask('take_back')['code'] == 'not_alone'
    assert browser.physsim.names == ('a/0',)


def test_cursors_go_to_all_pages_without_the_world(browser: Browser) -> None:
    anna, ben = browser.open_page(), browser.open_page()
    for x in range(5):
        anna.send('here', point=[x, 2.5])
    anna.until(lambda: anna.of_type('welcome'))
    last = [[int(anna.last('welcome')['client']), 4.0, 2.5]]
    ben.until(lambda: any(each['cursors'] == last for each in ben.of_type('cursors')))
    assert anna.ask('here', point=[1])['code'] == 'malformed'


def test_the_address_of_pupils_is_a_qr_code_for_teachers(browser: Browser) -> None:
    segno = pytest.importorskip('segno', reason='segno is not installed')
    image = browser.fetch('/qr.svg', cookie=browser.cookie_of(Role.TEACH))
    assert image.headers['Content-Type'] == 'image/svg+xml'
    size = segno.make(browser.url(Role.DRAW), micro=False).symbol_size(scale=8, border=4)[0]
    assert f'width="{size}"'.encode() in image.body
    for role in (Role.DRAW, Role.VIEW):
        assert browser.fetch('/qr.svg', cookie=browser.cookie_of(role)).code == 403


def test_driving_is_one_gesture_though_others_draw_meanwhile(browser: Browser) -> None:
    anna, ben = browser.open_page(), browser.open_page()
    anna.ask('gravity', gravity=[0, 0])
    ben.ask('person', name='Ben')
    anna.ask('person', name='Anna')
    anna.spawn('r/0', y=0.0, robot='turtlebot4')
    anna.send('drive', name='r/0', velocity=[0.2, 0, 0])
    # Messages are handled in their order.
    anna.ask('drop')
    browser.physsim.run(0.1)
    ben.spawn('b/0', 5.0)
    anna.send('drive', name='r/0', velocity=[0.1, 0, 0])
    anna.ask('drop')
    browser.physsim.run(0.1)
    # The moments of her drive are not in his gesture.
    assert ben.ask('take_back')['ok']
    assert browser.physsim.names == ('r/0',)
    moved = browser.physsim.node.frame.snapshot.poses[0, 0]
    assert moved > 0.01


def test_a_teacher_sees_answers_to_lessons_and_hands_and_says_something_to_all(
    browser: Browser,
) -> None:
    pupil, boss = browser.open_page(), teacher(browser)
    # The rest of what is too long is left out.
    long_answer, long_message = '1.02' * LONGEST_ANSWER, 'Five ' * LONGEST_MESSAGE
    assert pupil.ask('answered', lesson='Free fall', answer=long_answer, right=True)['ok']
    assert pupil.ask('raise_hand', raised=True)['ok']

    def seen() -> list[tuple[object, bool]]:
        last = boss.of_type('class')[-1:]
        people = [each for told in last for each in told['people'] if each['answered']]
        return [(each['answered']['answer'], each['raised']) for each in people]

    answered = long_answer[:LONGEST_ANSWER]
    boss.until(lambda: (answered, True) in seen())
    number = int(pupil.last('welcome')['client'])
    assert boss.ask('lower_hand', page=number)['ok']
    pupil.last('lower_hand')
    assert not boss.of_type('lower_hand')
    assert pupil.ask('raise_hand', raised=False)['ok']
    boss.until(lambda: (answered, False) in seen())
    assert boss.ask('say', text=long_message)['ok']
    pupil.until(lambda: pupil.of_type('said'))
    assert pupil.of_type('said')[0] == {
        'type': 'said',
        'name': 'Teacher',
        'text': long_message[:LONGEST_MESSAGE],
    }
    assert pupil.ask('say', text='no')['code'] == 'teacher_only'
    # A pupil is nobody's teacher by name.
    assert pupil.ask('person', name='Teacher')['code'] == 'bad_property'


def test_results_stay_and_an_answer_that_was_right_is_not_lost(
    browser: Browser, tmp_path: Path
) -> None:
    anna, boss = browser.open_page(), browser.cookie_of(Role.TEACH)
    assert anna.ask('person', name='Anna')['ok']
    before = time.time() - 1.0
    tried = (('Free fall', '9', False), ('Free fall', '1.01', True), ('Free fall', '3', False))
    for lesson, answer, right in (*tried, ('Lever', '2', False)):
        assert anna.ask('answered', lesson=lesson, answer=answer, right=right)['ok']

    def results() -> list[dict[str, Any]]:
        return json.loads(browser.fetch('/results', cookie=boss).body)['results']

    first, second = results()
    assert before < first.pop('at') < time.time() + 1.0
    assert first == {
        'world': 1,
        'person': 'Anna',
        'lesson': 'Free fall',
        'answer': '1.01',
        'right': True,
        'tries': 2,
    }
    assert (second['lesson'], second['right'], second['tries']) == ('Lever', False, 1)
    assert browser.fetch('/results').code == 403
    # Another page of the same person; another start of the world.
    anna.close()
    again = browser.open_page()
    assert again.ask('person', name='Anna')['ok']

    def last_lessons() -> list[str]:
        told = [person for each in again.of_type('class')[-1:] for person in each['people']]
        return [person['answered']['lesson'] for person in told if person['answered']]

    again.until(lambda: last_lessons() == ['Lever'])
    kept = Results(results_file(tmp_path), DirectoryLock(tmp_path))
    assert kept.last_of('Anna')['lesson'] == 'Lever'
    with pytest.raises(InUse):
        kept.note('Anna', 'Lever', '1', right=True, visitor='Page 1')
    assert teacher(browser).ask('forget_results')['ok']
    assert results() == []
    browser.physsim.node.destroy_node()
    finish_files()
    # The file is read again once the lock is held.
    assert kept.note('Anna', 'Lever', '1', right=True, visitor='Page 1')['tries'] == 1


def test_neither_world_nor_pages_wait_for_a_slow_disk_and_no_answer_is_lost(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pages = [browser.open_page() for _ in range(3)]
    for number, page in enumerate(pages):
        assert page.ask('person', name=f'Pupil {number}')['ok']
    write_file, goes_on = results.write_file, Event()

    def write_slowly(path: Path, data: bytes, *, mode: int) -> None:
        assert goes_on.wait(20.0), 'the world waits'
        write_file(path, data, mode=mode)

    monkeypatch.setattr(results, 'write_file', write_slowly)
    monkeypatch.setattr(file_work, 'MOST_WORK', 6)
    answer = {'lesson': 'Lever', 'right': True}
    sent = [(page, page.send('answered', answer='2', **answer)) for page in 2 * pages]
    for page in pages:
        # Those before have come.
        assert page.ask('drop')['ok']
    assert pages[0].ask('answered', answer='3', **answer)['code'] == 'busy'
    assert pages[0].spawn('a/0')['ok']
    before = browser.physsim.time
    browser.physsim.run(0.1)
    assert browser.physsim.time > before
    assert not any(page.answers(id_) for page, id_ in sent)
    goes_on.set()
    for page, id_ in sent:
        page.until(lambda page=page, id_=id_: page.answers(id_))
        assert page.answers(id_)[0]['ok']
    kept = [
        (each['person'], each['answer']) for each in results.read_results(results_file(tmp_path))
    ]
    assert kept == [(f'Pupil {number}', '2') for number in range(3)]


def test_the_greatest_results_fit_into_their_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lock, sign = DirectoryLock(tmp_path), '\N{GRINNING FACE}'
    kept = Results(results_file(tmp_path), lock)

    def note(number: int) -> None:
        person = f'{number}{sign * LONGEST_PERSON}'[:LONGEST_PERSON]
        kept.note(person, sign * LONGEST_TITLE, sign * LONGEST_ANSWER, right=True, visitor=person)

    with monkeypatch.context() as patch:
        patch.setattr(results, 'write_file', lambda *_, **__: None)
        for number in range(MOST_RESULTS):
            note(number)
    note(MOST_RESULTS)
    assert list(Results(results_file(tmp_path), lock)) == list(kept)
    assert len(list(kept)) == MOST_RESULTS


def test_one_visitor_of_many_names_and_lessons_drives_out_no_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lock = DirectoryLock(tmp_path)
    Results(results_file(tmp_path), lock).note('Zoe', 'L', '1', right=True, visitor='Page 1')
    kept = Results(results_file(tmp_path), lock)
    for name in ('Anna', 'Ben'):
        kept.note(name, 'Lever', '1', right=True, visitor=name)
    monkeypatch.setattr(results, 'write_file', lambda *_, **__: None)
    for number in range(MOST_RESULTS + 1):
        kept.note(f'n{number % 9}', f'{number}', '1', right=True, visitor='Page 1')
    people = [each['person'] for each in kept]
    assert len(people) == MOST_RESULTS
    assert people[:3] == ['Zoe', 'Anna', 'Ben']
    assert kept.last_of(f'n{MOST_RESULTS % 9}')['lesson'] == str(MOST_RESULTS)


def test_an_answer_that_cannot_be_written_is_refused_and_not_counted(tmp_path: Path) -> None:
    results = Results(results_file(tmp_path), DirectoryLock(tmp_path))
    results.note('Anna', 'Lever', '1', right=False, visitor='Page 1')
    results_file(tmp_path).unlink()
    results_file(tmp_path).mkdir()
    with pytest.raises(OSError, match='directory'):
        results.note('Anna', 'Lever', '2', right=True, visitor='Page 1')
    with pytest.raises(OSError, match='directory'):
        results.forget()
    assert [(each['answer'], each['tries']) for each in results] == [('1', 1)]
    results_file(tmp_path).rmdir()
    assert results.note('Anna', 'Lever', '2', right=True, visitor='Page 1')['tries'] == 2


def test_a_file_of_results_that_somebody_has_spoilt_is_no_result(tmp_path: Path) -> None:
    one = (
        '{"person": "Anna", "lesson": "Lever", "answer": "", "right": false, "at": 1, "tries": %s}'
    )
    spoilt = (f'[{one % tries}]' for tries in ('"x"', 'Infinity', '[]', 'true', '1, "x": NaN'))
    half = '[{"person": "\\ud800"}]'
    lock = DirectoryLock(tmp_path)
    for text in ('', '{', '[1]', '{}', '[{}]', '\udcff', '[' * 100_000, half, *spoilt):
        results_file(tmp_path).write_text(text, errors='surrogateescape')
        kept = Results(results_file(tmp_path), lock)
        assert kept.note('Anna', 'Lever', '1', right=False, visitor='Page 1')['tries'] == 1


def test_lessons_of_another_directory_reach_the_world(
    browse: Callable[..., Browser], tmp_path: Path
) -> None:
    lesson = (shipped_lessons() / 'slope.yaml').read_text()
    (tmp_path / 'teacher').mkdir()
    (tmp_path / 'teacher' / 'mine.yaml').write_text(lesson.replace('Down a slope', 'Mine'))
    browser = browse(lesson_dir=str(tmp_path / 'teacher'))
    pupil = browser.open_page()

    def title() -> str:
        scene = pupil.last('scene')
        return scene['lesson']['title'] if scene['lesson'] else ''

    assert 'Mine' in [each['title'] for each in pupil.last('worlds')['lessons']]
    assert pupil.ask('open', name='mine')['ok']
    browser.physsim.run(0.1)
    pupil.until(lambda: title() == 'Mine')
    assert browser.fetch('/world/mine.yaml').code == 200
    # One gesture, at time 0.
    assert pupil.ask('service', name='undo')['ok']
    browser.physsim.run(0.1)
    pupil.until(lambda: not title())


def test_a_page_that_watches_a_class_is_nobody_in_its_world(browser: Browser) -> None:
    pupil = browser.open_page()
    watching = browser.open_page('/ws?watch', cookie=browser.cookie_of(Role.TEACH))
    pupil.until(lambda: any(each['watched'] for each in pupil.of_type('class')))
    assert [role for _, role in people(pupil)] == ['draw']
    # It teaches, and gets the last frame of a world in which nothing moves.
    assert watching.ask('freeze', frozen=True)['ok']
    assert watching.ask('service', name='pause')['ok']
    assert watching.spawn('a/0')['ok']
    watching.until_frame(lambda frame: frame.count == 1)
    watching.close()
    pupil.until_last('class', lambda told: not told['watched'])
    # A pupil who asks for it is somebody all the same.
    browser.open_page('/ws?watch')
    pupil.until(lambda: len(people(pupil)) == 2)


def test_lessons_are_listed_as_their_files_are_when_a_page_asks(
    browser: Browser, tmp_path: Path
) -> None:
    pupil = browser.open_page()
    pupil.until(lambda: pupil.of_type('worlds'))
    lesson = (shipped_lessons() / 'slope.yaml').read_text()
    (tmp_path / 'lessons').mkdir()
    (tmp_path / 'lessons' / 'mine.yaml').write_text(lesson.replace('Down a slope', 'Mine'))
    pupil.send('list')
    pupil.until_last('worlds', lambda told: 'Mine' in [each['title'] for each in told['lessons']])
