# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The page in a real browser: drawn on, thrown, rewound, by mouse, fingers and keys."""

from __future__ import annotations

import math
from pathlib import Path
import re

import pytest

from .chromium import circle, NOTE_TEXTS, OpenSheet, POINTER, Sheet, started_world
from ..outside import Outside

WITHOUT_GRAVITY = b"""
format: 1
gravity: [0, 0]
bodies:
  - {name: puck/0, circle: {radius: 0.5}, at: [0, 2]}
"""
# Returns the texts that canvases show in the next picture.
NEXT_TEXTS = """() => new Promise((resolve) => requestAnimationFrame(() => {
    texts.length = 0;
    document.dispatchEvent(new Event('pointermove'));
    requestAnimationFrame(() => requestAnimationFrame(() => resolve(texts)));
}))"""
# Enters two texts into fields, the second before the first is answered.
ENTER_BOTH = """([...given]) => {
    for (let i = 0; i < given.length; i += 2) {
        const field = document.querySelector(`[aria-label="${given[i]}"]`);
        field.value = given[i + 1];
        field.dispatchEvent(new Event('change'));
    }
}"""


@pytest.mark.everyday
def test_a_circle_is_drawn_falls_comes_back_and_is_dragged(sheet: Sheet) -> None:
    before = sheet.names()
    sheet.drag(*circle(1.0, 5.0, 0.8))
    name = sheet.wait_for_new(before)
    drawn = sheet.pose(name)
    assert math.dist(drawn[:2], (1.0, 5.0)) < 0.1
    assert re.search(r'\d+ %', sheet.page.evaluate('heard.notes')[0])

    fallen = sheet.play_until(0.5)
    assert sheet.pose(name)[1] == pytest.approx(drawn[1] - 9.81 / 2 * fallen**2, abs=1e-3)

    sheet.press('Rewind')
    # It ends at the beginning, and waits there.
    sheet.wait('heard.speeds.includes(-1) && physsim.speed === 0 && physsim.time < 0.05')
    assert sheet.pose(name) == pytest.approx(drawn, abs=0.05)

    sheet.press('Hand')
    with sheet.dragging((1.0, 5.0), (-2.0, 6.0)):
        sheet.wait('name => Math.abs(physsim.bodies[name][0] + 2) < 0.1', name)


def test_the_note_of_a_body_tells_what_the_line_before_it_is_now(sheet: Sheet) -> None:
    before = sheet.names()
    sheet.drag((1.0, 7.5), (1.0, 5.0))
    sheet.wait_for_new(before)
    sheet.drag(*circle(1.0, 5.0, 0.5))
    sheet.until(lambda: len(sheet.page.evaluate('heard.notes')) > 1, 'the second note')

    assert re.fullmatch(r'circle \d+ %; rod.*', sheet.page.evaluate('heard.notes')[1])


@pytest.mark.parametrize('way', ['earlier', 'undo'])
def test_the_note_of_a_stroke_goes_with_what_it_built(sheet: Sheet, way: str) -> None:
    sheet.play_until(0.3)
    # A rope from the ball to the box.
    sheet.drag((0.0, 0.5), (0.8, 2.0), (2.0, 2.8), (3.2, 2.0), (4.0, 0.5))
    choice = sheet.page.get_by_role('button', name='or chain')
    # Who is at its button keeps it.
    choice.hover()
    if way == 'undo':
        sheet.page.keyboard.press('Control+z')
    else:
        sheet.seek(0.1)
    choice.wait_for(state='detached')


def test_a_stroke_ends_where_the_pen_is_lifted(sheet: Sheet) -> None:
    # The browser of a busy machine has no move to the last place.
    places = [sheet.place(*point) for point in ((-2.0, 5.0), (-1.0, 5.0), (2.0, 5.0))]
    path = [[kind, *place] for kind, place in zip(('down', 'move', 'up'), places, strict=True)]
    sheet.page.evaluate(POINTER, ['mouse', 1, 1, path])
    sheet.wait('Object.keys(physsim.bodies).length === 4')
    grey, wall = sheet.color_at(1.5, 5.5), sheet.color_at(1.5, 5.0)
    assert grey != wall


def test_a_rectangle_is_a_dragged_side_and_a_click_across(sheet: Sheet) -> None:
    before = sheet.names()
    sheet.press('Rectangle')
    sheet.drag((1.0, 4.0), (3.0, 4.0))
    sheet.tap(2.5, 5.0)
    x, y, _ = sheet.pose(sheet.wait_for_new(before))
    assert math.dist((x, y), (2.0, 4.5)) < 0.03
    # By one drag it stands upright, from corner to corner; with Alt a copy of it is dragged.
    before = sheet.names()
    sheet.drag((-3.0, 6.0), (-1.0, 7.0))
    name = sheet.wait_for_new(before)
    x, y, yaw = sheet.pose(name)
    assert math.dist((x, y), (-2.0, 6.5)) < 0.03
    assert yaw == 0.0
    before = sheet.names()
    sheet.press('Hand')
    sheet.page.keyboard.down('Alt')
    sheet.drag((-2.0, 6.5), (4.0, 6.5))
    sheet.page.keyboard.up('Alt')
    x, y, _ = sheet.pose(sheet.wait_for_new(before))
    assert math.dist((x, y), (4.0, 6.5)) < 0.03


def test_a_drag_from_beside_a_body_leaves_no_click_behind(sheet: Sheet) -> None:
    sheet.press('Velocity')
    # Faster than the world answers: refused where it begins, and lifted over a body.
    path = [['down', *sheet.place(1.0, 4.0)], ['up', *sheet.place(0.0, 0.5)]]
    sheet.page.evaluate(POINTER, ['mouse', 1, 1, path])
    sheet.page.locator('.note.refusal').wait_for()
    sheet.drag((4.0, 0.5), (4.0, 2.5))
    sheet.told('new velocity')
    sheet.play_until(0.1)
    assert sheet.pose('box/0')[1] > 0.6


def test_a_polygon_is_closed_at_its_first_corner_though_the_view_was_moved(sheet: Sheet) -> None:
    before = sheet.names()
    sheet.press('Polygon')
    corners = (-2.0, 4.0), (-1.0, 4.0), (-1.5, 5.0)
    for corner in corners:
        sheet.tap(*corner)
    for _ in range(3):
        sheet.page.keyboard.press('-')
    x, y = sheet.place(*corners[0])
    sheet.page.mouse.click(x - 9, y)
    sheet.wait_for_new(before)
    sheet.press('Frame the world')


def test_a_body_is_where_its_colour_says(sheet: Sheet) -> None:
    def colors() -> list[list[int]]:
        return [sheet.color_at(*at) for at in ((0.0, 0.5), (4.0, 0.5), (-4.0, 3.0))]

    wanted = [[0xD0, 0x20, 0x20], [0x20, 0xA0, 0x40], [0x20, 0x40, 0xD0]]
    sheet.until(lambda: colors() == wanted, 'the picture of three bodies')
    assert sheet.color_at(0.0, 1.2) not in ([0xD0, 0x20, 0x20], sheet.color_at(0.0, 0.5))


def test_a_hand_drags_a_body_and_throws_it(sheet: Sheet) -> None:
    # Ten times slower: a busy machine lets it go while it moves, too.
    sheet.press('Play')
    sheet.wait('physsim.speed === 1')
    # Faster than the world answers.
    sheet.page.locator('#speed').evaluate('each => [1, 2, 3].forEach(() => each.click())')
    sheet.wait('physsim.speed === 0.1')
    sheet.press('Hand')
    with sheet.dragging((0.0, 0.5), (0.0, 3.0)):
        sheet.wait('Math.abs(physsim.bodies["ball/0"][1] - 3) < 0.4')
        sheet.page.mouse.move(*sheet.place(3.0, 5.0), steps=6)
        sheet.wait('physsim.bodies["ball/0"][0] > 1')
    # It flies on beyond the place where the hand let it go.
    sheet.wait('physsim.bodies["ball/0"][0] > 3.3')


def test_a_hand_lets_go_where_keys_begin_a_gesture_in_its_midst(sheet: Sheet) -> None:
    sheet.press('Play')
    sheet.press('Hand')
    with sheet.dragging((0.0, 0.5), (0.0, 3.0)):
        sheet.wait('physsim.bodies["ball/0"][1] > 2')
        # The cursor of the keyboard is there, then it presses.
        for _ in range(2):
            sheet.page.keyboard.press('Enter')
        sheet.wait('physsim.bodies["ball/0"][1] < 1')


def test_in_a_paused_world_the_hand_places_a_body_and_the_wheel_turns_it(sheet: Sheet) -> None:
    sheet.press('Hand')
    with sheet.dragging((4.0, 0.5), (2.0, 4.0)):
        sheet.wait(
            'Math.hypot(physsim.bodies["box/0"][0] - 2, physsim.bodies["box/0"][1] - 4) < 0.1'
        )
        sheet.page.mouse.wheel(0, -200)
        sheet.wait('Math.abs(physsim.bodies["box/0"][2]) > 0.2')
    sheet.press('Undo')
    sheet.wait(
        'Math.hypot(physsim.bodies["box/0"][0] - 4, physsim.bodies["box/0"][1] - 0.5) < 0.1'
    )


def test_the_past_is_gone_to_by_the_slider_and_acting_there_starts_another_course(
    sheet: Sheet,
) -> None:
    sheet.press('Circle')
    before = sheet.names()
    sheet.drag((0.0, 7.0), (0.4, 7.0))
    name = sheet.wait_for_new(before)
    height = sheet.pose(name)[1]
    end = sheet.play_until(0.8)
    fallen = sheet.pose(name)
    sheet.seek(0.25)
    # Free fall: what the page shows of the past is the past.
    assert abs(sheet.pose(name)[1] - (height - 9.81 / 2 * 0.25**2)) < 0.05

    before = sheet.names()
    sheet.drag((0.0, 4.0), (0.4, 4.0))
    sheet.wait_for_new(before)
    ring = sheet.page.get_by_role('button', name='Go back to how it went').first.element_handle()
    # It stays the same at other times: while time runs, it can be pressed.
    for time in (0.2, 0.25):
        sheet.seek(time)
    assert ring.evaluate('each => each.isConnected')
    ring.click()
    sheet.wait('count => Object.keys(physsim.bodies).length === count', len(before))
    sheet.seek(end)
    assert sheet.pose(name) == pytest.approx(fallen, abs=1e-6)


def test_a_slider_that_was_pressed_and_not_moved_follows_time(sheet: Sheet) -> None:
    slider = sheet.page.get_by_role('slider', name='Time', exact=True)
    box = slider.bounding_box()
    # At the beginning of a time line its button is at the left.
    sheet.page.mouse.click(box['x'] + 8, box['y'] + box['height'] / 2)
    sheet.play_until(0.3)
    sheet.wait("document.querySelector('#slider').value > 0.25")


def test_the_slider_has_the_last_word_over_buttons_pressed_before(sheet: Sheet) -> None:
    sheet.press('Play')
    sheet.wait('physsim.time > 0.5')
    for name in ('Rewind', 'Fast forward', 'Step', 'Play'):
        sheet.press(name)
    sheet.page.get_by_role('slider', name='Time').fill('0.25')
    sheet.wait('physsim.speed === 0 && Math.abs(physsim.time - 0.25) < 0.02')
    sheet.press('Step')
    sheet.wait('physsim.speed === 0 && physsim.time > 0.255')


def test_drawing_in_a_world_that_runs_back_stops_it_there(sheet: Sheet) -> None:
    # Ten seconds, for which it runs back.
    sheet.press('Fast forward')
    sheet.wait('physsim.time > 10')
    sheet.press('Rewind')
    sheet.wait('physsim.speed === -1')
    before = sheet.names()
    sheet.drag(*circle(0.0, 5.0, 0.8))
    sheet.wait_for_new(before)
    assert sheet.page.evaluate('physsim.speed === 0 && physsim.time > 0')


def test_a_polygon_is_closed_by_the_enter_key(sheet: Sheet) -> None:
    before = sheet.names()
    sheet.press('Polygon')
    for point in ((1.0, 5.0), (2.0, 5.0), (2.0, 6.0)):
        sheet.tap(*point)
    sheet.page.keyboard.press('Enter')
    x, y, _ = sheet.pose(sheet.wait_for_new(before))
    assert math.dist((x, y), (5 / 3, 16 / 3)) < 0.1


def test_undo_takes_back_what_was_drawn_and_redo_draws_it_again(sheet: Sheet) -> None:
    sheet.press('Circle')
    names = []
    for x in (0.0, 2.0):
        before = sheet.names()
        sheet.drag((x, 6.0), (x + 0.4, 6.0))
        names.append(sheet.wait_for_new(before))
    for name in reversed(names):
        sheet.press('Undo')
        sheet.wait('name => !(name in physsim.bodies)', name)
    for name in names:
        sheet.press('Redo')
        sheet.wait('name => name in physsim.bodies', name)
        assert sheet.page.get_by_role('status').inner_text() == 'Redone: add the circle'


def test_two_pages_see_one_world_and_each_has_its_own_tool(
    sheet: Sheet, open_sheet: OpenSheet
) -> None:
    other = open_sheet()
    other.wait('Object.keys(physsim.bodies).length === 3')
    before = sheet.names()
    sheet.press('Circle')
    sheet.drag((1.0, 6.0), (1.5, 6.0))
    name = sheet.wait_for_new(before)
    other.wait('name => name in physsim.bodies', name)
    pen = other.page.get_by_role('button', name='Pen', exact=True)
    assert pen.get_attribute('aria-pressed') == 'true'


def test_a_body_is_tapped_and_changed_in_its_panel(sheet: Sheet) -> None:
    sheet.press('Hand')
    sheet.tap(0.0, 0.5)
    panel = sheet.page.get_by_role('complementary', name='Body')
    panel.get_by_label('Bounciness', exact=True).fill('0.9')
    panel.get_by_label('Anchored').check()
    sheet.page.get_by_text('changed').first.wait_for(state='attached')
    sheet.press('Copy beside')
    sheet.wait('Object.keys(physsim.bodies).length === 4')
    sheet.press('Delete body')
    sheet.wait('!("ball/0" in physsim.bodies)')


def test_a_body_that_is_tapped_has_its_numbers_of_now(sheet: Sheet) -> None:
    sheet.press('Hand')
    # Slowly: the hand has caught it meanwhile.
    sheet.page.mouse.click(*sheet.place(0.0, 0.5), delay=300)
    numbers = sheet.page.get_by_role('region', name='Numbers')
    numbers.get_by_text('0.785 kg · at 0, 0.50 m · 0° · 0 m/s · 0 rad/s').wait_for()
    # A line does not break before a unit.
    assert '0\u00a0rad/s' in numbers.text_content()
    # m g h of pi / 4 kg in half a metre.
    numbers.get_by_text('3.85 J').wait_for()
    with sheet.dragging((0.0, 0.5), (-2.0, 4.5)):
        numbers.get_by_text('at \N{MINUS SIGN}2.00, 4.50 m').wait_for()


def test_what_is_drawn_next_gets_the_chosen_colour_until_any_will_do(sheet: Sheet) -> None:
    def draw_disc(x: float) -> None:
        before = sheet.names()
        sheet.press('Circle')
        sheet.drag((x, 5.0), (x + 0.5, 5.0))
        sheet.wait_for_new(before)

    paper = sheet.color_at(1.9, 5.0)
    sheet.press('Material')
    sheet.page.get_by_label('Colour', exact=True).fill('#123456')
    draw_disc(-2.0)
    chosen = [0x12, 0x34, 0x56]
    sheet.until(lambda: sheet.color_at(-2.1, 5.0) == chosen, 'a disc of that colour')
    # The panel knows the choice when it is opened again.
    sheet.press('Material')
    assert sheet.page.get_by_label('Colour', exact=True).input_value() == '#123456'
    assert not sheet.page.get_by_label('Each body another colour').is_checked()
    sheet.page.get_by_label('Each body another colour').check()
    draw_disc(2.0)
    sheet.until(lambda: sheet.color_at(1.9, 5.0) not in (paper, chosen), 'another colour')


def test_a_lasso_moves_several_bodies_and_deletes_them(sheet: Sheet) -> None:
    sheet.press('Lasso')
    sheet.drag((-1.0, 0.1), (5.5, 0.1), (5.5, 2.0), (-1.0, 2.0), (-1.0, 0.1))
    sheet.page.get_by_text('2 bodies').wait_for()
    sheet.drag((0.0, 0.5), (-1.0, 3.5))
    sheet.wait(
        'Math.hypot(physsim.bodies["box/0"][0] - 3, physsim.bodies["box/0"][1] - 3.5) < 0.05'
    )
    sheet.page.keyboard.press('Delete')
    sheet.wait('Object.keys(physsim.bodies).join() === "shelf/0"')
    sheet.press('Undo')
    sheet.wait('Object.keys(physsim.bodies).length === 3')


def test_the_panel_of_several_bodies_is_of_those_that_are_there(sheet: Sheet) -> None:
    sheet.press('Circle')
    for x in (-2.0, 0.0, 2.0):
        before = sheet.names()
        sheet.drag((x, 5.0), (x + 0.5, 5.0))
        sheet.wait_for_new(before)
    sheet.press('Lasso')
    sheet.drag((-3.0, 4.0), (3.0, 4.0), (3.0, 6.0), (-3.0, 6.0), (-3.0, 4.0))
    panel = sheet.page.get_by_role('complementary', name='Body')
    for title in ('3 bodies', '2 bodies', 'Circle drawn/0'):
        panel.get_by_role('heading', name=title).wait_for()
        sheet.press('Undo')
    panel.wait_for(state='hidden')
    # Pages of this world have nothing to redo then.
    before = sheet.names()
    sheet.press('Circle')
    sheet.drag((0.0, 5.0), (0.5, 5.0))
    sheet.wait_for_new(before)


def test_a_refusal_stands_at_its_place(sheet: Sheet) -> None:
    sheet.press('Anchor')
    x, y = sheet.place(-2.0, 6.0)
    sheet.page.mouse.click(x, y)
    note = sheet.page.locator('.note.refusal')
    box = note.bounding_box()
    assert abs(box['x'] + box['width'] / 2 - x) < 5
    assert 0 < y - box['y'] - box['height'] < 40
    assert sheet.page.get_by_role('status').inner_text() == note.inner_text()
    # A rod from the shelf to the background begins at the shelf, whose fault it is.
    sheet.press('Rod')
    sheet.drag((-4.0, 3.0), (4.0, 7.0))
    note.get_by_text('shelf/0 cannot move').wait_for()
    box = note.bounding_box()
    x, y = sheet.place(-4.0, 3.2)
    assert abs(box['x'] + box['width'] / 2 - x) < 5
    assert 0 < y - box['y'] - box['height'] < 40
    # A refusal without a place is shown in the status line alone.
    sheet.press('Redo')
    sheet.told('nothing to redo')
    assert note.count() == 0


def test_a_stroke_that_is_read_and_then_refused_shows_that_at_its_place(
    open_sheet: OpenSheet, outside: Outside
) -> None:
    _, address = started_world(outside, max_bodies=3)
    sheet = open_sheet(address).begin()
    sheet.drag(*circle(-2.0, 6.0, 0.8))
    note = sheet.page.locator('.note.refusal')
    note.wait_for()
    box, (x, y) = note.bounding_box(), sheet.place(-2.0, 6.8)
    assert abs(box['x'] + box['width'] / 2 - x) < 5
    assert 0 < y - box['y'] - box['height'] < 40
    # What was not built has no reading.
    assert sheet.page.locator('.note').count() == 1
    assert len(sheet.names()) == 3


def test_keys_work_after_anything_was_clicked(sheet: Sheet) -> None:
    keyboard = sheet.page.keyboard

    def check_space() -> None:
        sheet.tap_space()
        sheet.wait('physsim.speed === 1')
        sheet.tap_space()
        sheet.wait('physsim.speed === 0')

    for name in ('Pen', 'Hand', 'Frame the world', 'Material', 'Close', 'Show forces'):
        sheet.press(name)
        check_space()
    # The same by the panel of a body, and by the slider of time.
    sheet.press('Hand')
    sheet.tap(0.0, 0.5)
    sheet.page.get_by_label('Anchored').check()
    check_space()
    sheet.page.get_by_role('slider', name='Time').click()
    keyboard.press('p')
    pen = sheet.page.get_by_role('button', name='Pen', exact=True)
    assert pen.get_attribute('aria-pressed') == 'true'
    # A text has all keys, until Esc.
    before = sheet.page.evaluate('physsim.speed')
    typed = sheet.page.get_by_label('Friction, typed')
    typed.click()
    keyboard.press(' ')
    keyboard.press('h')
    assert pen.get_attribute('aria-pressed') == 'true'
    assert sheet.page.evaluate('physsim.speed') == before
    keyboard.press('Escape')
    keyboard.press('h')
    assert pen.get_attribute('aria-pressed') == 'false'


def test_only_tab_shows_that_the_canvas_has_the_keyboard(sheet: Sheet) -> None:
    outline = """getComputedStyle(document.querySelector('canvas')).outlineStyle"""
    sheet.press('Pen')
    sheet.page.keyboard.press('f')
    assert sheet.page.evaluate(outline) == 'none'
    sheet.page.evaluate('document.activeElement.blur()')
    for _ in range(60):
        sheet.page.keyboard.press('Tab')
        if sheet.page.evaluate('document.activeElement.id') == 'world':
            break
    assert sheet.page.evaluate(outline) != 'none'


def test_no_hint_says_that_a_world_stands_still_which_plays(open_sheet: OpenSheet) -> None:
    sheet = open_sheet().begin()
    hint = sheet.page.locator('#hint')
    hint.get_by_text('it comes to life').wait_for()
    sheet.press('Play')
    sheet.wait('physsim.speed === 1')
    before = sheet.names()
    sheet.drag(*circle(1.0, 5.0, 0.8))
    sheet.wait_for_new(before)
    hint.get_by_text('take the hand').wait_for()
    sheet.close()
    # Somebody else new, whose world stands still, is told how to play.
    sheet = open_sheet().begin()
    before = sheet.names()
    sheet.drag(*circle(1.0, 5.0, 0.8))
    sheet.wait_for_new(before)
    hint = sheet.page.locator('#hint')
    hint.get_by_text('Time is paused').wait_for()
    # By whomever it is played.
    other = open_sheet()
    other.press('Play')
    hint.get_by_text('take the hand').wait_for()
    # At the beginning there is nothing to rewind.
    sheet.begin()
    sheet.press('Hand')
    sheet.drag((0.0, 0.5), (0.0, 3.0))
    sheet.wait('document.querySelector("#hint").className === "faded"')
    sheet.press('Play')
    hint.get_by_text('rewind').wait_for()


@pytest.mark.parametrize('ends', [((5.0, 6.0), (1.0, 6.3)), ((1.0, 6.3), (5.0, 6.0))])
def test_a_wall_is_hatched_on_its_lower_side(
    sheet: Sheet, ends: tuple[tuple[float, float], tuple[float, float]]
) -> None:
    def colors(above: float) -> list[list[int]]:
        return [sheet.color_at(x, 6.375 - 0.075 * x + above) for x in places]

    places = [1.5 + 0.23 * each for each in range(13)]
    sides = (0.12, -0.12)
    before = [colors(side) for side in sides]
    bodies = sheet.names()
    sheet.press('Wall')
    sheet.drag(*ends)
    sheet.wait_for_new(bodies)

    sheet.until(lambda: colors(sides[1]) != before[1], 'hatches below')
    assert colors(sides[0]) == before[0]


def test_gravity_has_a_direction_and_a_number(sheet: Sheet) -> None:
    sheet.press('Material')
    gravity = sheet.page.get_by_label('Gravity [m/s²], typed')
    gravity.fill('5')
    gravity.press('Enter')
    direction = sheet.page.get_by_role('slider', name='Direction of gravity [° from down]')
    for _ in range(6):
        direction.press('ArrowRight')
    sheet.page.keyboard.press('Escape')
    sheet.press('Material')
    sheet.until(lambda: gravity.input_value() == '5', 'the strength that was typed')
    sheet.until(lambda: direction.input_value() == '90', 'the direction that was set')
    # Right is down now: the ball falls there.
    sheet.press('Play')
    sheet.wait('physsim.bodies["ball/0"][0] > 1')
    # A world without gravity has no direction, also after this one.
    sheet.press('Worlds')
    world = {'name': 'x.yaml', 'mimeType': 'text/yaml', 'buffer': WITHOUT_GRAVITY}
    sheet.page.get_by_label('Open a file').set_input_files(world)
    sheet.wait('"puck/0" in physsim.bodies')
    sheet.press('Material')
    sheet.until(lambda: gravity.input_value() == '0', 'no gravity')
    assert direction.input_value() == '0'
    sheet.press('Undo')
    sheet.wait('"ball/0" in physsim.bodies')


def test_a_material_that_is_refused_takes_no_other_back(sheet: Sheet) -> None:
    sheet.press('Material')
    panel = sheet.page.get_by_role('complementary', name='Body')
    labels = ('Density [kg/m²], typed', 'Friction, typed')
    density, friction = (panel.get_by_label(label) for label in labels)
    friction.wait_for()
    sheet.page.evaluate(ENTER_BOTH, [labels[0], '-1', labels[1], '0.9'])
    # The status has the last of what is told: it may be of the field after it already.
    sheet.wait("heard.refusals.some((told) => told.includes('must lie between'))")
    sheet.until(lambda: density.input_value() == '1', 'the density before')
    assert friction.input_value() == '0.9'


def test_a_body_that_leaves_a_resting_pointer_is_not_named_there(sheet: Sheet) -> None:
    sheet.page.evaluate(NOTE_TEXTS)
    before = sheet.names()
    sheet.press('Circle')
    sheet.drag((2.0, 6.0), (2.5, 6.0))
    sheet.wait_for_new(before)
    sheet.page.mouse.move(*sheet.place(2.0, 6.0))
    sheet.until(lambda: named(sheet), 'a name at the pointer')
    sheet.press('Play')
    sheet.page.mouse.move(*sheet.place(2.0, 6.0))
    sheet.until(lambda: not named(sheet), 'no name at the pointer')


def named(sheet: Sheet) -> bool:
    """Return whether the next picture of the world has the name of a circle."""
    texts = sheet.page.evaluate(NEXT_TEXTS)
    return any(text.startswith('Circle ') for text in texts)


@pytest.mark.parametrize('text', ['-1', 'abc', ''])
@pytest.mark.parametrize('of', ['a body', 'what is drawn next'])
def test_a_field_that_is_refused_shows_again_what_is(sheet: Sheet, text: str, of: str) -> None:
    if of == 'a body':
        sheet.press('Hand')
        sheet.tap(0.0, 0.5)
    else:
        sheet.press('Material')
    panel = sheet.page.get_by_role('complementary', name='Body')
    field, slider = (
        panel.get_by_label('Friction, typed'),
        panel.get_by_label('Friction', exact=True),
    )
    field.fill('0.3')
    field.press('Enter')
    field.fill(text)
    field.press('Enter')
    if text == '-1':
        sheet.told('-1 does not lie between 0 and')
        # It can be corrected until the field is left.
        assert field.input_value() == '-1'
    field.evaluate('element => element.blur()')
    shown = (field, slider)
    sheet.until(lambda: [each.input_value() for each in shown] == ['0.3', '0.3'], 'what is')


def test_numbers_are_read_as_they_are_written(sheet: Sheet) -> None:
    read = """async (texts) => {
        const {numberOf, digits, threeDigits} = await import('/page/rounding.js');
        const written = [digits(-1.5e-7, 5), threeDigits(123456), threeDigits(-123456)];
        return [written[2].slice(1) === written[1],
            ...[...written, ...texts].map((text) => String(numberOf(text)))];
    }"""
    told = sheet.page.evaluate(read, ['0,5', ' 2 ', '', 'soon', '1e999', 'Infinity'])
    assert told == [True, '-1.5e-7', '123000', '-123000', '0.5', '2', *4 * ['NaN']]


def test_a_body_is_made_of_a_material_by_one_button(sheet: Sheet) -> None:
    sheet.press('Hand')
    sheet.tap(0.0, 0.5)
    panel = sheet.page.get_by_role('complementary', name='Body')
    for name, mass, friction in (('Steel', '6.17 kg', '0.6'), ('Ice', '0.723 kg', '0.03')):
        sheet.press(name)
        # Of a disc with a radius of 0.5 m.
        panel.get_by_text(mass).wait_for()
        field = panel.get_by_label('Friction, typed')
        sheet.until(lambda field=field, friction=friction: field.input_value() == friction, name)
    sheet.press('Undo')
    panel.get_by_text('6.17 kg').wait_for()


def test_what_is_drawn_next_is_made_of_a_material_on_another_planet(sheet: Sheet) -> None:
    sheet.press('Material')
    panel = sheet.page.get_by_role('complementary', name='Body')
    sheet.press('Rubber')
    assert panel.get_by_label('Bounciness, typed').input_value() == '0.8'
    sheet.press('Mars')
    gravity = panel.get_by_label('Gravity [m/s²], typed')
    sheet.until(lambda: gravity.input_value() == '3.71', 'the gravity of Mars')
    before = sheet.names()
    sheet.press('Circle')
    sheet.drag((0.0, 5.0), (0.5, 5.0))
    name = sheet.wait_for_new(before)
    sheet.press('Hand')
    sheet.tap(0.0, 5.0)
    panel.get_by_role('heading', name='Circle').wait_for()
    assert panel.get_by_label('Density [kg/m²], typed').input_value() == '1.1'
    fallen = 3.71 * sheet.play_until(0.5) ** 2 / 2
    assert sheet.pose(name)[1] == pytest.approx(5.0 - fallen, abs=1e-3)


def test_air_takes_a_share_of_the_speed_each_second(sheet: Sheet) -> None:
    sheet.press('Material')
    sheet.press('None')
    sheet.enter('Air drag [of the speed, each second], typed', '0.5')
    sheet.told('Air drag set')
    sheet.page.keyboard.press('Escape')
    sheet.press('Velocity')
    sheet.drag((0.0, 0.5), (0.0, 2.5))
    # v falls by half each second: from 2 m/s it comes to rest 2 / ln 2 m on.
    left = 0.5 ** sheet.play_until(1.0)
    assert sheet.pose('ball/0')[1] == pytest.approx(0.5 + 2.0 * (1 - left) / math.log(2), abs=0.01)


def test_a_world_is_saved_and_opened_from_the_gallery(sheet: Sheet) -> None:
    sheet.press('Delete')
    sheet.tap(4.0, 0.5)
    sheet.wait('Object.keys(physsim.bodies).length === 2')
    sheet.press('Save')
    sheet.page.get_by_label('Name of the world').fill('two-bodies')
    sheet.press('Save world')
    sheet.wait('document.querySelector("[role=status]").textContent.includes("two-bodies")')
    sheet.press('Worlds')
    sheet.page.get_by_role('button', name='Pendulums').click()
    sheet.wait('!("ball/0" in physsim.bodies)')
    sheet.press('Worlds')
    sheet.page.get_by_role('button', name='two-bodies', exact=True).click()
    sheet.wait('"ball/0" in physsim.bodies && Object.keys(physsim.bodies).length === 2')
    sheet.press('Worlds')
    sheet.page.get_by_role('button', name='page', exact=True).click()
    sheet.wait('Object.keys(physsim.bodies).length === 3')


def test_a_link_holds_the_world_and_offers_it(sheet: Sheet, open_sheet: OpenSheet) -> None:
    sheet.press('Save')
    sheet.wait('document.activeElement.getAttribute("aria-label") === "Name of the world"')
    sheet.press('Copy link')
    link = sheet.page.get_by_role('textbox', name='Link').input_value()
    # Marked and under the keys, to be copied.
    sheet.wait('document.activeElement.getAttribute("aria-label") === "Link"')
    assert sheet.page.evaluate('String(getSelection())') == link
    sheet.page.keyboard.press('Escape')
    sheet.press('Delete')
    sheet.tap(4.0, 0.5)
    sheet.wait('!("box/0" in physsim.bodies)')
    other = open_sheet()
    other.page.goto('about:blank')
    other.page.goto(link)
    other.press('Open it')
    sheet.wait('"box/0" in physsim.bodies')


def test_a_picture_and_a_table_of_what_was_plotted_are_downloaded(sheet: Sheet) -> None:
    sheet.press('Save')
    with sheet.page.expect_download() as picture:
        sheet.press('Picture (PNG)')
    assert Path(picture.value.path()).read_bytes().startswith(b'\x89PNG')
    sheet.page.keyboard.press('Escape')
    sheet.press('Hand')
    sheet.tap(0.0, 0.5)
    sheet.press('Play')
    sheet.wait('physsim.time > 0.3')
    with sheet.page.expect_download() as table:
        sheet.press('Table (CSV)')
    head, *rows = Path(table.value.path()).read_text('utf-8-sig').splitlines()
    assert head.split(',')[:3] == ['Time [s]', 'x [m]', 'Height [m]']
    assert [float(each) for each in rows[-1].split(',')[1:3]] == pytest.approx([0, 0.5], abs=0.01)


def test_all_of_it_goes_by_keys_alone(sheet: Sheet) -> None:
    keyboard = sheet.page.keyboard
    before = sheet.names()
    keyboard.press('c')
    sheet.page.get_by_role('img', name='World').focus()
    for key in ('ArrowUp', 'ArrowUp', 'Enter', 'ArrowRight', 'ArrowRight', 'Enter'):
        keyboard.press(key)
    name = sheet.wait_for_new(before)
    # The space bar plays and pauses.
    sheet.tap_space()
    sheet.wait('physsim.speed === 1')
    keyboard.press('k')
    sheet.wait('physsim.speed === 0')
    keyboard.press('Control+z')
    sheet.wait('name => !(name in physsim.bodies)', name)
    keyboard.press('n')
    assert 'ball/0' in sheet.page.get_by_role('complementary', name='Body').inner_text()
    keyboard.press('?')
    sheet.page.get_by_role('dialog').wait_for()


def test_the_velocity_arrow_of_a_body_is_dragged_to_another_velocity(sheet: Sheet) -> None:
    sheet.press('Hand')
    sheet.tap(0.0, 0.5)
    sheet.page.get_by_role('complementary', name='Body').wait_for()
    sheet.wait('Number.isFinite(physsim.scales.speed)')
    scale = sheet.page.evaluate('physsim.scales.speed')
    x, y = sheet.place(0.0, 0.5)
    gap = 22  # px from the centre to the tail
    sheet.page.mouse.move(x + gap, y)
    sheet.page.mouse.down()
    sheet.page.mouse.move(x, y - gap - 4.0 * scale, steps=5)
    sheet.page.mouse.up()
    sheet.told('ball/0')
    # 4 m/s upwards rise by v^2 / 2 g in v / g.
    sheet.play_until(4.0 / 9.81)
    sheet.seek(4.0 / 9.81)
    assert sheet.pose('ball/0')[1] == pytest.approx(0.5 + 4.0**2 / (2 * 9.81), abs=0.03)
