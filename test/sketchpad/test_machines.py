# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Machines on the page: robots of several parts, and belts."""

from __future__ import annotations

import pytest

from .chromium import OpenSheet, Sheet

WORLD = """
format: 1
bounds: [-4, 0, 4, 5]
bodies:
  - {name: arm/0, robot: arm, at: [-2, 2]}
  - {name: belt/0, box: {width: 4, height: 0.5}, at: [1.5, 1], anchored: true, belt: -1}
  - {name: gripper/0, robot: gripper, at: [2, 4]}
  - {name: conveyor/0, box: {width: 3, height: 1}, at: [-2, 4], anchored: true, sensor: true,
    surface_velocity: [1, 0]}
"""
BODIES = 9
# Colours along a horizontal line of the page [px].
ROW = """([x, y, width]) => [...document.querySelector('canvas').getContext('2d').getImageData(
    x * devicePixelRatio, y * devicePixelRatio, width * devicePixelRatio, 1).data]"""


@pytest.fixture
def sheet(open_sheet: OpenSheet) -> Sheet:
    """Give a test a page with the hand, and the world from its beginning, paused."""
    sheet = open_sheet().begin(BODIES)
    sheet.press('Hand')
    return sheet


def heading(sheet: Sheet, name: str) -> None:
    """Wait for the panel of a body to have a heading."""
    panel = sheet.page.get_by_role('complementary', name='Body')
    panel.get_by_role('heading', name=name, exact=True).wait_for()


def test_a_part_has_the_name_of_its_link_and_a_robot_without_a_drive_no_stick(
    sheet: Sheet,
) -> None:
    sheet.tap(-1.8, 2.0)
    heading(sheet, 'Upper arm/0/upper/0')
    sheet.tap(2.0, 4.0)
    heading(sheet, 'gripper/0')
    heading(sheet, 'Robot · /gripper_0')
    assert sheet.page.get_by_role('img', name='Stick: drag to drive').count() == 0


def test_a_copy_of_a_part_is_a_whole_robot(sheet: Sheet) -> None:
    before = sheet.names()
    sheet.tap(-1.8, 2.0)
    heading(sheet, 'Upper arm/0/upper/0')
    sheet.press('Copy beside')
    sheet.wait('count => Object.keys(physsim.bodies).length === count', BODIES + 3)
    sheet.told('Copied a robot')
    assert {name.partition('/')[0] for name in sheet.names() - before} == {'drawn'}
    sheet.press('Undo')
    sheet.wait('count => Object.keys(physsim.bodies).length === count', BODIES)


def test_a_rail_ends_where_the_world_does(sheet: Sheet) -> None:
    # Of the gripper, whose hand could go 1.5 m down; it stands 1 m above the floor.
    sheet.page.evaluate(
        """() => new Promise((resolve) => {
            const socket = new WebSocket(`ws://${location.host}/ws`);
            socket.binaryType = 'arraybuffer';
            socket.onopen = () => {
                const body = {name: 'gripper/1', robot: 'gripper', at: [3, 1]};
                socket.send(JSON.stringify({id: '1', type: 'spawn', body}));
            };
            socket.onmessage = ({data}) => String(data).includes('gripper/1') && resolve();
        })"""
    )
    sheet.wait('"gripper/1" in physsim.bodies')

    def column(low: float, high: float) -> set[tuple[int, ...]]:
        places = [(3.0, low + step / 50 * (high - low)) for step in range(51)]
        return {tuple(sheet.color_at(x, y)) for x, y in places}

    assert (35, 38, 45) in column(0.2, 0.5)
    assert (35, 38, 45) not in column(-0.5, -0.1)


@pytest.mark.parametrize('at', [(0.0, 1.25), (-2.5, 4.0)], ids=['side', 'above'])
def test_the_treads_of_a_belt_run_with_time(sheet: Sheet, at: tuple[float, float]) -> None:
    def treads() -> list[int]:
        x, y = sheet.place(*at)
        colors: list[int] = sheet.page.evaluate(ROW, [x, y, 60])
        return colors

    before = treads()
    time = sheet.play_until(0.05)
    sheet.until(lambda: treads() != before, f'treads that have gone {time} m')
    sheet.press('Reset')
    sheet.until(lambda: treads() == before, 'treads of the beginning')
