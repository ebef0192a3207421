# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The world on the page: in the room that panels leave, on pages of all sizes."""

from __future__ import annotations

from typing import Any

from physsim_ros.files import shipped_lessons
import pytest

from .chromium import circle, NOTE_TEXTS, OpenSheet, Sheet, started_world
from ..outside import Outside

# A desk, a telephone both ways, a tablet, the desk at 200 % zoom, and a school laptop [px].
SIZES = [(1280, 800), (390, 844), (844, 390), (768, 1024), (640, 400), (1366, 650)]
# View of the lesson [m].
BOUNDS = -4.1, 0.0, 4.3, 5.2
FOLD = "document.querySelector('#lesson .fold').click()"
UNFOLD = "document.querySelector('#lesson.folded .fold')?.click()"
# Boxes of what is shown beside the world [px].
PANELS = """() => [...document.querySelectorAll(
    '#tools, #top > .bar, #bar, #lesson, #panel, #plot')]
    .filter((each) => each.checkVisibility())
    .map((each) => [each.id, each.getBoundingClientRect()])
    .map(([id, {left, top, right, bottom}]) => [id, left, top, right, bottom])"""

# Boxes of the numbers of the rulers [px].
NUMBERS = r'boxes.filter(([text]) => /^[−\d.]+ m$/.test(text))'


@pytest.fixture(scope='module')
def program(outside: Outside) -> Any:
    """Give the module a world with a lesson."""
    text = (shipped_lessons() / 'slope.yaml').read_text()
    return started_world(outside, world=text)


@pytest.fixture(params=SIZES, ids=lambda size: f'{size[0]}x{size[1]}')
def sheet(open_sheet: OpenSheet, program: Any, request: pytest.FixtureRequest) -> Sheet:
    """Give a test a page of a size, and the lesson from its beginning, paused."""
    sheet = open_sheet(program[1], unfolded=False, size=request.param).begin(2)
    sheet.page.locator('#lesson').wait_for()
    return sheet


def covered(sheet: Sheet) -> list[str]:
    """Return the ids of panels that lie on the world, or beyond the page."""
    left, bottom = sheet.place(*BOUNDS[:2])
    right, top = sheet.place(*BOUNDS[2:])
    size = sheet.page.viewport_size
    found = [
        str(name)
        for name, x, y, end_x, end_y in sheet.page.evaluate(PANELS)
        if x < right and left < end_x and y < bottom and top < end_y
    ]
    if left < 0 or top < 0 or right > size['width'] or bottom > size['height']:
        found.append('the edge of the page')
    return found


def check(sheet: Sheet) -> None:
    """Wait until nothing covers the world."""
    sheet.until(lambda: not covered(sheet), 'a world that nothing covers')
    # It has not become too small to be seen.
    assert sheet.place(BOUNDS[2], 0.0)[0] - sheet.place(BOUNDS[0], 0.0)[0] > 120


def select(sheet: Sheet) -> None:
    """Select the block of ice."""
    sheet.press('Hand')
    sheet.tap(*sheet.pose('ice/0')[:2])
    sheet.page.get_by_role('heading', name='Ice').wait_for()


def test_no_panel_lies_on_the_world(sheet: Sheet) -> None:
    check(sheet)
    select(sheet)
    check(sheet)
    sheet.press('Show forces')
    sheet.press('Show velocities')
    check(sheet)
    sheet.press('More')
    check(sheet)
    sheet.press('Play')
    sheet.wait('physsim.time > 0.2')
    sheet.press('Pause')
    check(sheet)
    sheet.press('Close')
    check(sheet)


def test_the_numbers_of_the_rulers_lie_beside_the_bars(sheet: Sheet) -> None:
    sheet.page.evaluate(NOTE_TEXTS)
    sheet.page.keyboard.press('f')
    sheet.wait(f'{NUMBERS}.length > 4')
    room = sheet.page.locator('#room').bounding_box()
    for _, left, top, right, bottom in sheet.page.evaluate(NUMBERS):
        assert room['x'] <= left < right <= room['x'] + room['width']
        assert room['y'] <= top < bottom <= room['y'] + room['height']


def test_the_answer_to_a_lesson_is_in_sight(sheet: Sheet) -> None:
    field = sheet.page.get_by_role('textbox', name='Your answer')
    field.fill('1')
    sheet.press('Check')
    verdict = sheet.page.get_by_text('Not yet.')
    verdict.wait_for()
    # As before it was scrolled to be pressed.
    card = sheet.page.locator('#lesson')
    card.evaluate('(element) => element.scrollTo(0, 0)')
    y, height = (card.bounding_box()[key] for key in ('y', 'height'))
    for box in (field.bounding_box(), verdict.bounding_box()):
        assert y < box['y']
        assert box['y'] + box['height'] < y + height


def test_the_title_of_a_lesson_that_is_solved_is_in_sight(sheet: Sheet) -> None:
    sheet.page.get_by_role('textbox', name='Your answer').fill('4.9')
    sheet.press('Check')
    sheet.page.get_by_text('Right!').wait_for()
    card, title = (sheet.page.locator(each).bounding_box() for each in ('#lesson', '#lesson h2'))
    assert card['y'] <= title['y']
    assert title['y'] + title['height'] <= card['y'] + card['height']


def test_the_plot_stands_beside_the_world(sheet: Sheet) -> None:
    select(sheet)
    if sheet.page.locator('#panel.folded').count():
        sheet.press('More')
    sheet.press('Large plot')
    canvas = sheet.page.get_by_role('img', name='Large plot')
    box = canvas.bounding_box()
    assert box['width'] > 150
    assert box['height'] > 80
    check(sheet)
    sheet.press('Close the plot')
    check(sheet)


def test_a_moved_view_stays_where_a_panel_opens_and_closes(sheet: Sheet) -> None:
    sheet.page.keyboard.press('-')
    before = sheet.place(0.0, 0.0)
    sheet.press('Show forces')
    sheet.press('Show forces')
    select(sheet)
    assert sheet.place(0.0, 0.0) == before
    sheet.press('Close')
    assert sheet.place(0.0, 0.0) == before
    # F frames the world again.
    sheet.page.keyboard.press('f')
    check(sheet)


def test_nothing_lies_on_a_world_that_is_only_watched(sheet: Sheet) -> None:
    sheet.page.goto(sheet.page.url + '?view')
    sheet.wait('Object.keys(physsim.bodies).length === 2')
    sheet.page.locator('#lesson').wait_for()
    check(sheet)


def test_a_panel_opens_on_numbers_alone_until_somebody_unfolds_it(
    open_sheet: OpenSheet, program: Any
) -> None:
    sheet = open_sheet(program[1], unfolded=False, size=(1280, 800)).begin(2)
    select(sheet)
    friction = sheet.page.get_by_role('slider', name='Friction', exact=True)
    numbers = sheet.page.get_by_text('2 kg · ')
    numbers.wait_for()
    assert friction.is_hidden()
    before = sheet.place(0.0, 0.0)
    sheet.press('Play')
    sheet.wait('physsim.time > 0.1')
    sheet.press('Pause')
    # The view stays.
    assert sheet.place(0.0, 0.0) == before
    sheet.press('More')
    friction.wait_for()
    # It is remembered, for other bodies and in this browser.
    sheet.press('Close')
    select(sheet)
    friction.wait_for()
    sheet.page.reload()
    sheet.wait('heard.people && "ice/0" in physsim.bodies')
    select(sheet)
    friction.wait_for()


@pytest.mark.parametrize('size', [(1280, 800), (1280, 720), (1366, 768), (1366, 650)])
def test_all_tools_are_in_sight(
    open_sheet: OpenSheet, program: Any, size: tuple[int, int]
) -> None:
    sheet = open_sheet(program[1], size=size).begin(2)
    tools = sheet.page.locator('#tools')
    # A lesson has a few, in one column.
    boxes = [each.bounding_box() for each in tools.get_by_role('button').all()]
    assert len({box['x'] for box in boxes}) == 1
    sheet.press('All tools')
    sheet.page.get_by_role('button', name='Spring', exact=True).wait_for()
    # With words, as in every lesson, and without.
    for words in (True, False):
        sheet.press('Help')
        sheet.page.get_by_label('Words at icons').set_checked(words)
        sheet.page.keyboard.press('Escape')
        assert tools.evaluate('(each) => each.scrollHeight === each.clientHeight')
        check(sheet)


def add_note(sheet: Sheet) -> None:
    """Show a note that has no place in the world."""
    sheet.page.evaluate("""() => {
        const note = document.createElement('div');
        note.className = 'note';
        note.textContent = 'The world of yesterday, of half past three, was not saved.';
        document.getElementById('dock').append(note);
    }""")


def test_a_note_without_a_place_leaves_the_floor_in_sight(sheet: Sheet) -> None:
    add_note(sheet)
    box = sheet.page.locator('#dock .note').bounding_box()
    assert box['y'] + box['height'] < sheet.place(0.0, 0.5)[1]
    assert sheet.page.locator('#files').bounding_box()['y'] < box['y']


@pytest.mark.parametrize('size', SIZES[:1])
def test_the_view_does_not_move_in_the_midst_of_a_gesture(
    open_sheet: OpenSheet, program: Any, size: tuple[int, int]
) -> None:
    sheet = open_sheet(program[1], size=size).begin(2)
    check(sheet)
    sheet.press('All tools')
    sheet.press('Pen')
    before = sheet.place(0.0, 0.0)
    with sheet.dragging((0.0, 3.0), (1.0, 4.0), (2.0, 5.0)):
        sheet.page.evaluate(FOLD)
        sheet.page.evaluate('new Promise(requestAnimationFrame)')
        assert sheet.place(0.0, 0.0) == before
    sheet.until(lambda: sheet.place(0.0, 0.0) != before, 'a world in the other room')
    check(sheet)
    # A polygon is clicked corner by corner.
    sheet.press('Polygon')
    between = sheet.place(0.0, 0.0)
    sheet.tap(3.0, 5.0)
    sheet.page.evaluate(FOLD)
    sheet.page.evaluate('new Promise(requestAnimationFrame)')
    assert sheet.place(0.0, 0.0) == between
    for corner in ((4.0, 5.0), (4.0, 6.0)):
        sheet.tap(*corner)
    assert sheet.place(0.0, 0.0) == between
    sheet.page.keyboard.press('Enter')
    sheet.until(lambda: sheet.place(0.0, 0.0) != between, 'a world in the room')
    check(sheet)


@pytest.mark.parametrize('size', SIZES[:1])
def test_what_is_drawn_beyond_the_first_view_stays_in_sight(
    open_sheet: OpenSheet, outside: Outside, size: tuple[int, int]
) -> None:
    _, address = started_world(outside, world='format: 1')
    sheet = open_sheet(address, size=size)
    sheet.wait('heard.people && physsim.time >= 0')
    sheet.press('Pause')
    bar = sheet.page.locator('#bar')
    # An anchored plane near the time bar; its panel opens, and makes the room narrower.
    top = bar.bounding_box()['y']
    foot = sheet.page.evaluate('at => physsim.toWorld(...at)', [300, top - 20])
    sheet.press('Inclined plane')
    sheet.page.mouse.click(300, top - 20)
    sheet.page.get_by_role('heading', name='Inclined plane').wait_for()
    before = sheet.place(*foot)
    for panel in ('#panel', '#card'):
        sheet.page.locator(panel).get_by_role('button', name='Close').click()
    sheet.until(lambda: sheet.place(*foot) != before, 'a world in the larger room')
    assert sheet.place(*foot)[1] < bar.bounding_box()['y']


@pytest.mark.parametrize('size', SIZES[1:3])
def test_a_telephone_shows_the_lesson_or_the_panel(
    open_sheet: OpenSheet, program: Any, size: tuple[int, int]
) -> None:
    sheet = open_sheet(program[1], size=size).begin(2)
    measure = sheet.page.get_by_text('To measure:')
    sheet.page.evaluate(UNFOLD)
    measure.wait_for()
    select(sheet)
    measure.wait_for(state='hidden')
    sheet.page.evaluate(UNFOLD)
    measure.wait_for()
    sheet.page.get_by_role('heading', name='Ice').wait_for(state='hidden')
    check(sheet)


def test_the_view_stays_where_something_closes_by_itself(
    open_sheet: OpenSheet, outside: Outside
) -> None:
    _, address = started_world(outside, world='format: 1\nbounds: [-8, 0, 8, 5]\nbodies: []')
    sheet = open_sheet(address)
    card = sheet.page.locator('#card')
    card.wait_for()
    before = sheet.place(8.0, 0.0)
    sheet.press('Circle')
    sheet.drag((0.0, 2.0), (0.5, 2.0))
    sheet.wait('Object.keys(physsim.bodies).length === 1')
    card.wait_for(state='hidden')
    assert sheet.place(8.0, 0.0) == before
    # A panel that covers no body leaves the view as it is, too.
    sheet.page.keyboard.press('n')
    panel = sheet.page.get_by_role('complementary', name='Body')
    panel.wait_for()
    sheet.page.evaluate('new Promise((done) => setTimeout(done, 300))')
    assert sheet.place(8.0, 0.0) == before
    sheet.page.keyboard.press('Escape')
    # One that would makes the world smaller; where its body is deleted, the view stays.
    sheet.tap(6.5, 4.5)
    sheet.tap(6.8, 4.5)
    sheet.wait('Object.keys(physsim.bodies).length === 2')
    sheet.page.keyboard.press('N')
    panel.wait_for()
    sheet.wait('before => physsim.toPage(8, 0)[0] < before', before[0])
    assert panel.bounding_box()['x'] > sheet.place(6.8, 4.5)[0]
    smaller = sheet.place(8.0, 0.0)
    sheet.page.keyboard.press('Delete')
    panel.wait_for(state='hidden')
    assert sheet.place(8.0, 0.0) == smaller
    # What somebody closes makes room.
    sheet.press('Material')
    sheet.press('Close')
    sheet.wait('smaller => physsim.toPage(8, 0)[0] > smaller', smaller[0])


def test_a_note_is_beside_the_card_of_strokes(open_sheet: OpenSheet, outside: Outside) -> None:
    _, address = started_world(outside, world='format: 1\nbodies: []')
    sheet = open_sheet(address, size=SIZES[0])
    card = sheet.page.locator('#card')
    card.wait_for()
    add_note(sheet)
    note = sheet.page.locator('#dock .note').bounding_box()
    assert note['x'] + note['width'] <= card.bounding_box()['x']


def test_a_stroke_may_begin_on_the_card_of_strokes(
    open_sheet: OpenSheet, outside: Outside
) -> None:
    _, address = started_world(outside, world='format: 1\nbodies: []')
    sheet = open_sheet(address, size=(800, 600))
    sheet.wait('heard.people && physsim.time >= 0')
    sheet.press('Pen')
    card = sheet.page.locator('#card')
    card.wait_for()
    assert card.evaluate('({scrollHeight, clientHeight}) => scrollHeight <= clientHeight')
    box = card.bounding_box()
    centre = [box['x'] + box['width'] / 2, box['y'] + box['height'] / 2]
    x, y = sheet.page.evaluate('at => physsim.toWorld(...at)', centre)
    sheet.drag(*circle(x, y, 1.0))
    sheet.wait('Object.keys(physsim.bodies).length === 1')
    card.wait_for(state='hidden')
