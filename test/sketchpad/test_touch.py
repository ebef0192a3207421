# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""The page under fingers and a stylus."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from .chromium import circle, Fingers, Sheet, Stylus


def test_a_second_finger_turns_the_body_that_is_placed(chromium: Any, address: str) -> None:
    sheet = Sheet(chromium, address, has_touch=True)
    sheet.begin()
    sheet.press('Hand')
    x, y = sheet.place(4.0, 0.5)
    fingers = Fingers(sheet)
    fingers.put((x, y))
    x, y = sheet.place(4.0, 4.0)
    fingers.move((x, y))
    sheet.wait('Math.abs(physsim.bodies["box/0"][1] - 4) < 0.1')
    fingers.put((x, y), (x + 100, y))
    # A quarter of a turn counter-clockwise, in steps.
    for angle in np.linspace(0.0, math.pi / 2, 9)[1:]:
        fingers.move((x, y), (x + 100 * math.cos(angle), y - 100 * math.sin(angle)))
    sheet.wait('angle => Math.abs(physsim.bodies["box/0"][2] - angle) < 0.05', math.pi / 2)
    fingers.lift()
    sheet.press('Undo')
    sheet.wait('physsim.bodies["box/0"].join() === "4,0.5,0"')
    sheet.close()


def test_a_finger_draws_and_two_fingers_zoom(chromium: Any, address: str) -> None:
    sheet = Sheet(chromium, address, has_touch=True)
    sheet.begin()
    before = sheet.names()
    fingers = Fingers(sheet)
    places = [sheet.place(*point) for point in circle(1.0, 5.0, 0.8)]
    fingers.put(places[0])
    for place in places[1:]:
        fingers.move(place)
    fingers.lift()
    sheet.wait_for_new(before)

    def width() -> float:
        return sheet.place(1.0, 0.0)[0] - sheet.place(0.0, 0.0)[0]

    narrow = width()
    fingers.put((500, 400), (600, 400))
    fingers.move((450, 400), (650, 400))
    fingers.lift()
    assert 1.7 * narrow < width() < 2.3 * narrow
    sheet.close()


def test_a_stylus_draws_and_from_then_on_a_finger_moves_the_view(
    chromium: Any, address: str
) -> None:
    sheet = Sheet(chromium, address, has_touch=True)
    sheet.begin()
    before = sheet.names()
    Stylus(sheet).draw([sheet.place(*point) for point in circle(1.0, 5.0, 0.8)])
    sheet.wait_for_new(before)
    x, y = sheet.place(0.0, 0.0)
    fingers = Fingers(sheet)
    fingers.put((500, 300))
    fingers.move((540, 330))
    fingers.lift()
    assert sheet.place(0.0, 0.0) == pytest.approx((x + 40, y + 30), abs=1.0)
    sheet.close()
