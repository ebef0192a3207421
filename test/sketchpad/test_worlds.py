# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Worlds of one's own on the page: nothing is lost by a click, nor by a node that is killed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
import re
import signal
from typing import Any

import pytest

from .chromium import circle, OpenSheet, Sheet, started_world
from ..outside import Outside

PICTURE = """async () => {
    const [card] = document.querySelectorAll('.own img');
    await card.decode();
    return [card.naturalWidth, card.naturalHeight];
}"""


@pytest.fixture
def sheet(open_sheet: OpenSheet, outside: Outside) -> Iterator[Sheet]:
    """Give a test a page of a world without worlds of its own, from its beginning, paused."""
    program, address = started_world(outside)
    sheet = open_sheet(address).begin()
    yield sheet
    sheet.close()
    program.interrupt()


def save(sheet: Sheet, name: str) -> None:
    """Save under a name."""
    sheet.press('Save')
    sheet.page.get_by_role('textbox', name='Name of the world').fill(name)
    sheet.press('Save world')


def delete_box(sheet: Sheet) -> None:
    """Delete the box."""
    sheet.press('Delete')
    sheet.tap(4.0, 0.5)
    sheet.wait('!("box/0" in physsim.bodies)')


def undone(sheet: Sheet, text: str) -> None:
    """Undo what a note says; one before it may still be there."""
    note = sheet.page.locator('#dock .note', has_text=text)
    note.get_by_role('button', name='Undo').click()


def open_own(sheet: Sheet, name: str) -> None:
    """Open a world of one's own."""
    sheet.press('Worlds')
    sheet.page.get_by_role('button', name=name, exact=True).click()
    sheet.told(f'Opened {name}', exact=True)


def delete_own(sheet: Sheet, name: str) -> None:
    """Delete a world of one's own whose picture is shown: it could not be asked for any more."""
    sheet.press('Worlds')
    own = sheet.page.locator('.own', has_text=name)
    own.locator('img[src^="/picture/"]').evaluate('each => each.decode()')
    own.get_by_role('button', name='Delete').click()


def test_saving_asks_once_before_it_writes_over_a_world_and_can_be_undone(sheet: Sheet) -> None:
    save(sheet, 'mine')
    sheet.told('Saved as mine', exact=True)
    delete_box(sheet)
    save(sheet, 'mine')
    sheet.press('Save as mine 2')
    sheet.told('Saved as mine 2', exact=True)
    save(sheet, 'mine')
    sheet.press('Replace mine')
    sheet.told('Saved as mine', exact=True)
    undone(sheet, 'mine is replaced')
    sheet.told('World mine is back', exact=True)
    open_own(sheet, 'mine')
    sheet.wait('"box/0" in physsim.bodies')
    open_own(sheet, 'mine 2')
    sheet.wait('!("box/0" in physsim.bodies)')


def test_nobody_takes_the_name_of_a_shipped_world(sheet: Sheet) -> None:
    save(sheet, 'incline')
    assert sheet.page.get_by_role('button', name='Replace incline').count() == 0
    sheet.press('Save as incline 2')
    sheet.told('Saved as incline 2', exact=True)
    sheet.press('Worlds')
    sheet.page.get_by_role('button', name='Incline Friction').click()
    sheet.wait('"slope/0" in physsim.bodies')


def test_own_worlds_have_pictures_new_names_and_come_back_when_they_are_deleted(
    sheet: Sheet,
) -> None:
    save(sheet, 'mine')
    sheet.told('Saved as mine', exact=True)
    sheet.press('Worlds')
    sheet.page.locator('.own img[src^="/picture/mine"]').wait_for()
    assert sheet.page.evaluate(PICTURE) == [480, 200]
    own = sheet.page.locator('.own', has_text='mine')
    own.get_by_role('button', name='Rename').click()
    sheet.page.get_by_role('textbox', name='New name').fill('demo')
    sheet.press('Rename')
    sheet.page.locator('#status.refused', has_text='demo').wait_for()
    sheet.press('Worlds')
    own.get_by_role('button', name='Rename').click()
    sheet.page.get_by_role('textbox', name='New name').fill('yours')
    sheet.press('Rename')
    sheet.page.locator('#dock .note').get_by_text('Renamed to yours').wait_for()
    # It is the one that is shown.
    sheet.press('Save')
    assert sheet.page.get_by_role('textbox', name='Name of the world').input_value() == 'yours'
    sheet.press('Close')
    open_own(sheet, 'yours')
    delete_own(sheet, 'yours')
    undone(sheet, 'yours is deleted')
    sheet.told('World yours is back', exact=True)
    open_own(sheet, 'yours')


def test_an_offer_stays_while_somebody_is_at_its_button(sheet: Sheet) -> None:
    # Pauses of seconds end when the test says so.
    sheet.page.add_init_script(
        """const waits = setTimeout, ends = [];
        window.setTimeout = (call, pause) =>
            pause < 5000 ? waits(call, pause) : void ends.push(call);
        window.endAll = () => ends.splice(0).forEach((call) => call());"""
    )
    sheet.page.reload()
    save(sheet, 'mine')
    delete_own(sheet, 'mine')
    undo = sheet.page.locator('#dock .note').get_by_role('button', name='Undo')
    undo.focus()
    sheet.page.evaluate('endAll()')
    assert undo.is_visible()
    undo.evaluate('each => each.blur()')
    sheet.page.evaluate('endAll()')
    undo.wait_for(state='detached')


def test_a_dialog_goes_by_a_press_beside_it_and_not_by_a_selection_that_ends_there(
    sheet: Sheet,
) -> None:
    sheet.press('Save')
    dialog, mouse = sheet.page.get_by_role('dialog'), sheet.page.mouse
    box, name = dialog.bounding_box(), dialog.get_by_role('textbox').bounding_box()
    x, y, beside = name['x'] + 40, name['y'] + name['height'] / 2, box['x'] - 30
    mouse.move(x, y)
    mouse.down()
    mouse.move(beside, y, steps=3)
    mouse.up()
    # Its edge is of it, too.
    mouse.click(box['x'] + 6, y)
    sheet.wait('true')
    assert dialog.is_visible()
    mouse.click(beside, y)
    dialog.wait_for(state='hidden')


def test_a_name_that_cannot_be_is_refused_in_words(sheet: Sheet) -> None:
    sheet.press('Save')
    name = sheet.page.get_by_role('textbox', name='Name of the world')
    for text in ('', '  ', 'a/b', 'a.yaml'):
        name.fill(text)
        sheet.press('Save world')
        assert name.evaluate('each => !each.checkValidity()'), text
    assert 'without /' in name.get_attribute('title')


def test_what_a_killed_node_had_is_offered_at_the_next_start(
    chromium: Any, outside: Outside
) -> None:
    program, address = started_world(outside)
    sheet = Sheet(chromium, address)
    sheet.begin()
    before = sheet.names()
    sheet.drag(*circle(1.0, 5.0, 0.8))
    name = sheet.wait_for_new(before)
    directory = max(outside.directory.glob('*/page.yaml'), key=lambda path: path.stat().st_mtime)
    kept = directory.parent / '.autosave.yaml'
    sheet.until(lambda: kept.exists() and name in kept.read_text(), 'an autosave')
    program.interrupt(signal.SIGKILL)
    sheet.context.close()

    given = {'world_file': directory, 'world_dir': directory.parent, 'sketchpad': 'serve'}
    again = outside.start_world(**given)
    line = again.wait_for('/login?token=')
    again.wait_for('ready')
    found = re.search(r'http\S+', line)
    assert found
    sheet = Sheet(chromium, found[0])
    sheet.wait('Object.keys(physsim.bodies).length === 3')
    sheet.page.get_by_text('was not saved').wait_for()
    sheet.press('Open it')
    sheet.wait('name => name in physsim.bodies', name)
    sheet.until(
        lambda: not Path(directory.parent, '.unsaved.yaml').exists(), 'an offer that is taken'
    )
    sheet.close()


def test_a_wrong_token_is_explained(sheet: Sheet) -> None:
    other = sheet.context.new_page()
    origin = sheet.page.evaluate('location.origin')
    other.goto(f'{origin}/login?token=wrong')
    assert other.get_by_role('heading').inner_text() == 'This cannot be opened'
    assert 'token' in other.inner_text('body')


def test_the_card_of_strokes_is_in_the_help_and_beside_an_empty_canvas(sheet: Sheet) -> None:
    card = sheet.page.get_by_role('complementary', name='Strokes')
    assert not card.is_visible()
    sheet.press('Worlds')
    sheet.press('Empty room')
    card.wait_for()
    assert card.get_by_role('listitem').count() == 14
    # A person who has drawn something knows the strokes, though nothing moves yet.
    sheet.drag((-5.0, 2.0), (-1.0, 3.0))
    sheet.until(lambda: not card.is_visible(), 'no card beside what was drawn')
    sheet.press('Help')
    strokes = sheet.page.get_by_role('dialog').locator('.strokes li')
    sheet.until(lambda: strokes.count() == 14, 'the same strokes')


def test_an_empty_world_has_earth_and_walls_of_its_own(sheet: Sheet) -> None:
    sheet.press('Material')
    sheet.press('Moon')
    sheet.told('Gravity set')
    sheet.page.keyboard.press('Escape')
    sheet.press('Worlds')
    sheet.press('Empty room')
    sheet.told('An empty world')
    sheet.press('Material')
    gravity = sheet.page.get_by_label('Gravity [m/s²], typed')
    sheet.until(lambda: gravity.input_value() == '9.81', 'the gravity of the Earth')


def test_a_machine_that_is_too_slow_says_how_slow(open_sheet: OpenSheet, outside: Outside) -> None:
    # 10,000 frames a second, each of one step, are more than any machine makes.
    program, address = started_world(outside, physics_rate=10000.0, publish_rate=10000.0)
    sheet = open_sheet(address).begin()
    speed = sheet.page.locator('#speed')
    assert speed.inner_text() == '1×'
    sheet.press('Hand')
    sheet.press('Play')
    with sheet.dragging((0.0, 0.5), (1.0, 3.0)):
        told = re.compile(r'Speed (0\.\d+)×, slower than 1×')
        sheet.until(lambda: told.fullmatch(speed.get_attribute('aria-label')), 'the pace')
    sheet.close()
    program.interrupt()
