# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Lessons on the page: the list, the card, the check of a figure, links, all pages of a world."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from .chromium import NOTE_TEXTS, OpenSheet, Sheet, started_world
from ..outside import Outside

OWN = """
format: 1
lesson: {number: 99, title: Mine, question: How much?, hint: Look., measure: It, unit: '1',
  figure: 3, within: 0.5, answer: Three.}
bounds: []
bodies:
  - {name: mine/0, circle: {radius: 0.5}, at: [0, 0.5]}
"""


@pytest.fixture
def sheet(open_sheet: OpenSheet, outside: Outside, tmp_path: Path) -> Iterator[Sheet]:
    """Give a test a page of a world with a lesson of the user, and one that is none."""
    lessons = tmp_path / 'lessons'
    lessons.mkdir()
    (lessons / 'mine.yaml').write_text(OWN)
    (lessons / 'bad.yaml').write_text(OWN.replace('figure: 3', 'figure: three'))
    program, address = started_world(outside, world_dir=tmp_path)
    sheet = open_sheet(address).begin()
    yield sheet
    sheet.close()
    program.interrupt()


def open_lesson(sheet: Sheet, name: str) -> None:
    """Open a lesson from the list."""
    sheet.press('Worlds')
    sheet.page.locator('.lessons').get_by_role('button', name=name).click()


def test_a_lesson_has_its_own_hints_alone(sheet: Sheet) -> None:
    hint = sheet.page.locator('#hint:not(.faded)')
    hint.get_by_text('Draw a circle').wait_for()
    open_lesson(sheet, '1. Free fall')
    sheet.until(lambda: hint.count() == 0, 'no hint')


def check(sheet: Sheet, figure: str, says: str) -> None:
    """Check a figure, and wait for what is said."""
    sheet.page.get_by_role('textbox', name='Your answer').fill(figure)
    sheet.press('Check')
    sheet.page.locator('#lesson p[aria-live]').get_by_text(says).wait_for()


def test_an_answer_that_could_not_be_kept_is_told_beside_it(sheet: Sheet, tmp_path: Path) -> None:
    open_lesson(sheet, '1. Free fall')
    (tmp_path / '.results.json').mkdir()
    check(sheet, '1.02', 'Right! Your answer was not saved')


def test_a_pupil_opens_a_lesson_measures_and_is_told_the_law(sheet: Sheet) -> None:
    sheet.press('Play')
    sheet.wait('physsim.time > 0.7')
    open_lesson(sheet, '1. Free fall')
    card = sheet.page.locator('#lesson')
    card.get_by_text('Which one lands first').wait_for()
    sheet.told('Opened Free fall')
    # It waits for its pupil.
    sheet.wait('"heavy/0" in physsim.bodies && physsim.speed === 0 && physsim.time === 0')
    answer = card.get_by_text('whatever the mass')
    assert not answer.is_visible()
    check(sheet, 'soon', 'not a number')
    check(sheet, '1.4', 'Not yet')
    assert not answer.is_visible()
    check(sheet, '1,02', 'Right!')
    answer.wait_for()
    sheet.press('Worlds')
    solved = sheet.page.locator('.lessons').get_by_role('button', name='1. Free fall')
    solved.get_by_role('img', name='solved').wait_for()
    sheet.press('Close')
    # The plots of a body have its fall, though the world was older when the lesson was opened.
    sheet.press('Play')
    sheet.wait('physsim.time > 0.6')
    sheet.press('Pause')
    sheet.wait('physsim.speed === 0')
    sheet.press('Hand')
    sheet.tap(*sheet.pose('heavy/0')[:2])
    sheet.wait('physsim.records["heavy/0"] && physsim.records["heavy/0"][0] > 20')


def test_the_next_lesson_comes_after_it_and_another_world_has_none(sheet: Sheet) -> None:
    open_lesson(sheet, '1. Free fall')
    sheet.press('Next lesson')
    sheet.page.locator('#lesson').get_by_text('2. Horizontal throw').wait_for()
    sheet.press('Worlds')
    sheet.press('Empty room')
    sheet.until(lambda: not sheet.page.locator('#lesson').is_visible(), 'no lesson')


def test_trails_and_plots_end_with_their_world(sheet: Sheet) -> None:
    open_lesson(sheet, '1. Free fall')
    sheet.wait('"heavy/0" in physsim.bodies && physsim.time === 0')
    sheet.press('Hand')
    sheet.tap(*sheet.pose('heavy/0')[:2])
    sheet.page.get_by_label('Trail').check()
    sheet.press('Large plot')
    sheet.wait('"heavy/0" in physsim.records')
    open_lesson(sheet, '4. Down a slope')
    sheet.wait('"ice/0" in physsim.bodies && Object.keys(physsim.records).length === 0')
    assert not sheet.page.locator('#plot').is_visible()


def test_all_pages_of_a_world_have_its_lesson(sheet: Sheet, chromium: Any) -> None:
    open_lesson(sheet, '4. Down a slope')
    other = sheet.context.new_page()
    other.goto(sheet.page.url)
    other.locator('#lesson').get_by_text('4. Down a slope').wait_for()


def test_a_link_opens_a_lesson(sheet: Sheet) -> None:
    origin = sheet.page.evaluate('location.origin')
    for link in ('/#lesson=pendulum', '/?lesson=friction'):
        page = sheet.context.new_page()
        page.goto(origin + link)
        page.get_by_role('button', name='Open the lesson').click()
        title = '9. Pendulum' if 'pendulum' in link else '5. Friction'
        page.locator('#lesson').get_by_text(title).wait_for()
    page = sheet.context.new_page()
    page.goto(f'{origin}/#lesson=alchemy')
    page.get_by_role('status').get_by_text('no lesson alchemy').wait_for()


@pytest.mark.parametrize('link', ['#name=%', '#class=%E4', '#lesson=%E4', '?t=%'])
def test_a_link_that_is_broken_leaves_the_page_as_it_is(sheet: Sheet, link: str) -> None:
    page = sheet.context.new_page()
    page.on('pageerror', lambda error: sheet.errors.append(str(error)))
    page.goto(sheet.page.evaluate('location.origin') + f'/{link}')
    page.get_by_role('button', name='Worlds').click()
    page.locator('.lessons').get_by_role('button', name='9. Pendulum').click()
    page.locator('#lesson').get_by_text('9. Pendulum').wait_for()


def test_a_link_leads_to_a_moment_of_a_lesson(sheet: Sheet) -> None:
    moment = sheet.play_until(0.7)
    sheet.page.evaluate("location.hash = '#t=0.5'")
    sheet.press('Go there')
    sheet.wait('Math.abs(physsim.time - 0.5) < 0.01 && physsim.speed === 0')
    # Time has not been there in the world of the lesson.
    sheet.page.evaluate("location.hash = '#lesson=free_fall&t=0.25'")
    sheet.press('Open the lesson')
    sheet.wait('"heavy/0" in physsim.bodies && physsim.time === 0.25 && physsim.speed === 0')
    there = sheet.pose('heavy/0')
    assert there[1] < 5.3
    sheet.press('Save')
    sheet.press('Link to this moment')
    link = sheet.page.get_by_role('textbox', name='Link').input_value()
    assert link.endswith('/#lesson=free_fall&t=0.25')
    sheet.page.keyboard.press('Escape')
    # The same to the bit.
    assert sheet.play_until(moment) > 0.25
    sheet.page.evaluate('link => { location.href = link; }', link)
    sheet.press('Go there')
    sheet.wait('physsim.time === 0.25 && physsim.speed === 0')
    assert sheet.pose('heavy/0') == there
    # Its plot begins with the lesson, though the world before was older.
    sheet.press('Hand')
    sheet.tap(*there[:2])
    sheet.wait('physsim.records["heavy/0"]?.[0] > 10')


# How much of the prediction the body has gone, in each comparison that was written [%].
SHARES = r"""[...new Set(texts)].map((text) => /for (\d+) % of the line/.exec(text)?.[1])
    .filter(Boolean).map(Number)"""


def test_a_prediction_is_compared_with_the_way_that_the_body_goes(sheet: Sheet) -> None:
    open_lesson(sheet, '2. Horizontal throw')
    sheet.wait('"thrown/0" in physsim.bodies && physsim.time === 0')
    sheet.page.evaluate(NOTE_TEXTS)
    sheet.press('Predict')
    (x, y, _), floor = sheet.pose('thrown/0'), 0.2
    fall = [(x + 4.0 * share, y + (floor - y) * share**2) for share in np.linspace(0.0, 1.0, 12)]
    sheet.drag(*fall)
    sheet.wait('texts.includes("predicted")')
    sheet.play_until(0.9)
    sheet.wait('texts.some((text) => /^off by 0\\.0/.test(text))')
    assert max(sheet.page.evaluate(SHARES)) < 100
    # A way as long as the prediction is compared, however fast the body is, and no longer one.
    end = sheet.play_until(1.9)
    assert sheet.pose('thrown/0')[0] > x + 5.5
    sheet.page.evaluate('window.texts = []')
    sheet.seek(end - 0.1)
    sheet.wait('texts.some((text) => /^off by 0\\.0/.test(text))')
    assert sheet.page.evaluate(SHARES) == [100]
    # A way that it does not go, in the same world again.
    sheet.press('Reset')
    sheet.wait('physsim.time === 0')
    sheet.drag((x, y), (x + 4.0, y))
    sheet.play_until(0.9)
    sheet.wait('texts.some((text) => /^off by [1-9]/.test(text))')
    sheet.press('Reset')
    sheet.wait('physsim.time === 0')
    sheet.tap(x, y)
    sheet.page.evaluate('window.texts = []')
    sheet.wait('!texts.some((text) => /off by|predicted/.test(text))')


def test_the_prediction_of_a_body_goes_with_it_and_comes_back(sheet: Sheet) -> None:
    sheet.page.evaluate(NOTE_TEXTS)
    sheet.press('Predict')
    sheet.drag((0.0, 0.5), (2.0, 3.0))
    sheet.wait('texts.includes("predicted")')
    sheet.press('Delete')
    sheet.tap(0.0, 0.5)
    sheet.wait('!("ball/0" in physsim.bodies)')
    sheet.page.evaluate('window.texts = []')
    sheet.page.mouse.move(*sheet.place(1.0, 5.0))
    sheet.wait('texts.length && !texts.includes("predicted")')
    sheet.press('Undo')
    sheet.wait('texts.includes("predicted")')


# Rows of the histogram and cells of the table of some answers, as a page shows them.
RESULTS = """async (answers) => {
    const {showResults} = await import('/page/ui/results.js'), {fetch} = window;
    const results = answers.map((answer, i) => (
        {person: `P${i}`, lesson: 'Fall', answer, right: false, tries: 1, at: 0}));
    window.fetch = async () => ({json: async () => ({results})});
    const shown = document.createElement('div');
    await showResults({show: (title, ...nodes) => shown.append(...nodes)}, [], () => {});
    window.fetch = fetch;
    return ['.histogram li', 'tbody td'].map((selector) =>
        [...shown.querySelectorAll(selector)].map((each) => each.textContent));
}"""


def test_an_answer_counts_from_the_round_number_on_and_is_told_as_the_reader_writes(
    sheet: Sheet,
) -> None:
    bars, cells = sheet.page.evaluate(RESULTS, ['9,7', '9.81', '9,81', '10', '98', '1'])
    assert bars == ['< 9.61', '9.6 … 9.7', '9.7 … 9.81', '9.8 … 9.92', '≥ 9.92']
    assert cells == [f'{each} ✗' for each in ('9.7', '9.81', '9.81', '10', '98', '1')]


def test_a_teacher_s_lesson_is_listed_and_a_bad_one_says_where_it_is_wrong(sheet: Sheet) -> None:
    open_lesson(sheet, '99. Mine')
    sheet.wait('"mine/0" in physsim.bodies')
    check(sheet, '3.4', 'Right!')
    # The view stays, however far what has no floor falls.
    before = sheet.place(0.0, 0.0)
    sheet.press('Play')
    sheet.wait('physsim.bodies["mine/0"][1] < -20')
    sheet.press('Material')
    sheet.press('Close')
    assert sheet.place(0.0, 0.0) == before
    open_lesson(sheet, 'bad')
    status = sheet.page.get_by_role('status')
    status.get_by_text('bad.yaml, line 4, figure: bad_property').wait_for()
    # Nothing is lost.
    assert sheet.names() == {'mine/0'}


@pytest.mark.parametrize('size', [(1200, 800), (390, 844)])
def test_the_world_of_a_lesson_is_beside_its_card(
    sheet: Sheet, chromium: Any, size: tuple[int, int]
) -> None:
    sheet.page.set_viewport_size({'width': size[0], 'height': size[1]})
    open_lesson(sheet, '1. Free fall')
    sheet.wait('"heavy/0" in physsim.bodies')
    box = sheet.page.locator('#lesson').bounding_box()

    def is_beside() -> bool:
        x, y = sheet.place(-2.65, 6.0)
        return bool(x > box['x'] + box['width'] if size[0] > 700 else y > box['y'] + box['height'])

    sheet.until(is_beside, 'a world beside the card')
