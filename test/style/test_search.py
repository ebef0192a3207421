# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The search of the site: words that people try lead first to the page that answers."""

from collections.abc import Iterator
from pathlib import Path
import subprocess
import sys
from typing import Any

import pytest

from .sources import ROOT
from ..sketchpad.chromium import launched_chromium

pytestmark = pytest.mark.slow

# Words, and the pages of which one is to be the first result.
WORDS = {
    'pause': 'time',
    'speed': 'time',
    'slow motion': 'time',
    'rewind': 'time tutorials/rewind_to_the_crash',
    'undo': 'time',
    'pendulum': 'worlds',
    'demo': 'worlds',
    'bounce': 'interface/properties',
    'friction': 'interface/properties',
    'mass': 'interface/properties',
    'spring': 'interface/properties',
    'motor': 'interface/properties',
    'gravity': 'interface/parameters',
    'cmd_vel': 'robots',
    'odometry': 'robots',
    'Nav2': 'nav2',
    'lidar': 'interface/properties',
    'keyboard': 'cheat_sheet',
    'shortcut': 'cheat_sheet',
    'gazebo': 'beside_others',
    'turtlesim': 'beside_others',
    'install': 'installation',
    'docker': 'installation',
    'pytest': 'testing tutorials/test_your_robot',
    'gymnasium': 'learning',
    'rosbag': 'viewers',
    'rviz': 'viewers',
    'classroom': 'classroom',
    'lesson': 'lessons',
    'error': 'interface/codes',
    'token': 'security',
    'deterministic': 'physics',
    'pulley': 'interface/properties',
    'winch': 'interface/properties',
    'ratchet': 'interface/properties',
    'belt': 'interface/properties',
    'platform': 'interface/properties',
    'water': 'interface/properties',
    'buoyancy': 'interface/properties',
    'drag': 'interface/properties',
    'wind': 'interface/properties',
    'orbit': 'worlds lessons',
    'battery': 'robots',
    'latency': 'robots',
    'trailer': 'robots',
    'gripper': 'robots',
    'pedestrian': 'actors',
    'knife': 'drawing',
    'CSV': 'tutorials/record_and_look',
    'parameter': 'interface/parameters',
    'domain': 'installation',
    'tiled': 'convert',
    'reinforcement learning': 'learning',
    'homework': 'lessons',
    'inclined plane': 'worlds lessons',
    'print': 'cheat_sheet',
    'teleop': 'robots',
    'servo': 'robots',
    'noise': 'interface/properties',
    'launch file': 'installation',
    'line follower': 'worlds',
    'rubber': 'interface/properties',
    'explosion': 'questions',
    'upgrade': 'changelog',
}


@pytest.fixture(scope='module')
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the pages without those of modules, which the search ranks last."""
    pytest.importorskip('sphinx', reason='Sphinx builds the site: make docs brings it')
    folder = tmp_path_factory.mktemp('site')
    options = (
        '-q',
        '-D',
        'extensions=myst_parser,sphinx.ext.autodoc',
        '-D',
        'suppress_warnings=ref,toc',
    )
    docs = str(ROOT / 'docs')
    subprocess.run([sys.executable, '-m', 'sphinx', *options, docs, str(folder)], check=True)
    return folder


@pytest.fixture(scope='module')
def page() -> Iterator[Any]:
    """Open a page in a browser."""
    sync_api = pytest.importorskip('playwright.sync_api', reason='there is no browser')
    with sync_api.sync_playwright() as playwright:
        browser = launched_chromium(playwright)
        yield browser.new_page()
        browser.close()


@pytest.mark.parametrize('word', WORDS)
def test_a_word_leads_first_to_the_page_that_answers(site: Path, page: Any, word: str) -> None:
    page.goto(f'{(site / "search.html").as_uri()}?q={word}')
    page.wait_for_selector('#search-results ul.search li a')

    first = page.get_attribute('#search-results ul.search li a', 'href')
    assert first.partition('.html')[0] in WORDS[word].split()
