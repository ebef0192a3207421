# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A class on the page: a teacher and a pupil in one world, in two browsers."""

from __future__ import annotations

from collections.abc import Iterator
import re
from typing import Any

import pytest

from .chromium import circle, Sheet
from ..outside import Outside, Program

PIXELS = """([x, y]) => {
    const {data} = document.querySelector('canvas').getContext('2d')
        .getImageData(x * devicePixelRatio, y * devicePixelRatio, 80, 40);
    return new Set(new Uint32Array(data.buffer)).size;
}"""


def addresses(program: Program) -> list[str]:
    """Return the addresses that a world prints: of pupils, of viewers, of a teacher."""
    lines = [program.wait_for('/login?token=') for _ in range(3)]
    program.wait_for('ready')
    return [re.search(r'http\S+', line)[0] for line in lines]


@pytest.fixture
def pages(chromium: Any, outside: Outside, tmp_path: Any) -> Iterator[tuple[Sheet, Sheet]]:
    """Give a test the pages of a teacher and of a pupil, in an empty world that plays."""
    world = tmp_path / 'page.yaml'
    world.write_text('format: 1\nbounds: [-8, 0, 8, 8]\nbodies: []\n')
    program = outside.start_world(world_file=world, world_dir=tmp_path, sketchpad='serve')
    pupil, _, teacher = addresses(program)
    sheets = Sheet(chromium, teacher), Sheet(chromium, pupil)
    for sheet in sheets:
        sheet.wait('physsim.speed === 1')
    yield sheets
    for sheet in sheets:
        sheet.close()
    program.interrupt()


def call(sheet: Sheet, name: str) -> None:
    """Choose a name in the dialog of people."""
    sheet.press('People')
    sheet.page.get_by_role('textbox', name='Your name').fill(name)
    sheet.press('Use this name')


def test_a_teacher_freezes_a_pupil_and_sees_who_did_what(pages: tuple[Sheet, Sheet]) -> None:
    teacher, pupil = pages
    call(pupil, 'Anna')
    pupil.drag(*circle(0.0, 4.0, 0.8))
    status = teacher.page.get_by_role('status')
    status.get_by_text('Anna: Circle added').wait_for()
    # Of a long chain others get the first answers and the number of the rest; then each again.
    pupil.press('Chain')
    pupil.drag((-4.0, 3.0), (-4.0, 7.0))
    status.get_by_text('Anna: Chain of 13 links added').wait_for()
    pupil.press('Circle')
    pupil.drag((4.0, 5.0), (4.7, 5.0))
    status.get_by_text('Anna: Circle added').wait_for()
    pupil.press('Pen')
    teacher.press('People')
    teacher.page.get_by_role('listitem').get_by_text('Anna').wait_for()
    teacher.page.get_by_role('img', name='QR code').wait_for()
    teacher.press('Freeze all pupils')
    frozen = pupil.page.get_by_text('Your teacher has frozen this world.')
    frozen.wait_for()
    before = pupil.names()
    pupil.drag(*circle(3.0, 4.0, 0.8))
    pupil.told('frozen')
    assert pupil.names() == before
    teacher.press('Let them draw again')
    frozen.wait_for(state='detached')
    teacher.press('Delete what Anna drew')
    pupil.wait('Object.keys(physsim.bodies).length === 0')
    # A button stays while it is pressed, whoever comes meanwhile.
    teacher.page.get_by_role('button', name='Freeze all pupils').hover()
    teacher.page.mouse.down()
    call(pupil, 'Bea')
    teacher.wait('heard.people.includes("Bea")')
    teacher.page.mouse.up()
    frozen.wait_for()
    teacher.page.get_by_role('listitem').get_by_text('Bea').wait_for()


def test_a_teacher_works_by_keys_and_a_message_is_read_to_who_cannot_see_it(
    pages: tuple[Sheet, Sheet],
) -> None:
    teacher, pupil = pages
    teacher.press('People')
    button = teacher.page.get_by_role('button', name='Freeze all pupils')
    button.focus()
    teacher.page.keyboard.press('Enter')
    pupil.page.locator('[aria-live]').get_by_text('has frozen this world').wait_for()
    # Another button has taken its place.
    other = teacher.page.get_by_role('button', name='Let them draw again')
    other.wait_for()
    assert other.evaluate('each => each === document.activeElement')
    teacher.page.keyboard.press('Enter')
    button.wait_for()
    assert button.evaluate('each => each === document.activeElement')


def test_each_undoes_what_is_its_own_while_time_goes_on(pages: tuple[Sheet, Sheet]) -> None:
    teacher, pupil = pages
    pupil.drag(*circle(-3.0, 4.0, 0.8))
    first = pupil.wait_for_new(set())
    # Beside an empty canvas a card of strokes would be in the way.
    teacher.wait('name => name in physsim.bodies', first)
    teacher.drag(*circle(3.0, 4.0, 0.8))
    second = teacher.wait_for_new({first})
    time = pupil.page.evaluate('physsim.time')
    undo = pupil.page.get_by_role('button', name='Undo', exact=True)
    assert undo.get_attribute('title') == 'Undo what you did last'
    undo.click()
    pupil.wait('name => !(name in physsim.bodies)', first)
    assert pupil.names() == {second}
    assert pupil.page.evaluate('physsim.time') >= time


def test_the_cursor_of_the_other_is_shown_with_its_name(pages: tuple[Sheet, Sheet]) -> None:
    teacher, pupil = pages
    call(pupil, 'Anna')
    place = teacher.place(2.0, 3.0)
    blank = teacher.page.evaluate(PIXELS, place)

    def is_shown() -> bool:
        pupil.page.mouse.move(*pupil.place(2.0, 3.0))
        pupil.page.mouse.move(*pupil.place(2.01, 3.0))
        return bool(teacher.page.evaluate(PIXELS, place) > blank + 5)

    teacher.until(is_shown, 'a cursor')
