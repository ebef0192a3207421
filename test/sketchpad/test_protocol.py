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

"""What a page gets is what the world is, and what it sends becomes the world's own requests."""

import math

import numpy as np
import pytest

from .browser import Browser


def circle(x: float, y: float, radius: float) -> list[list[float]]:
    turns = [math.tau * each / 60 for each in range(61)]
    return [[x + radius * math.cos(a), y + radius * math.sin(a), a / 6] for a in turns]


def test_a_page_gets_the_poses_of_the_world(browser: Browser) -> None:
    physsim, page = browser.physsim, browser.open_page()
    page.send('stroke', points=circle(0.0, 5.0, 0.5))
    page.until(lambda: physsim.names)
    physsim.run(0.5)
    page.until(lambda: page.frames and page.frames[-1].time == pytest.approx(0.5))
    picture, scene = page.frames[-1], page.of_type('scene')[-1]
    assert [body['name'] for body in scene['bodies']] == list(physsim.names)
    assert picture.epoch == scene['epoch']
    assert picture.poses == pytest.approx(np.array([physsim.pose(physsim.names[0])]), abs=1e-6)
    assert picture.poses[0, 1] < 5.0


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


def test_a_wrong_token_opens_nothing(browser: Browser) -> None:
    assert browser.fetch('/login?token=guess', cookie='').code == 403
    for path in ('/', '/session', '/page/app.js', '/ws'):
        assert browser.fetch(path, cookie='').code == 403
