# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law: in whatever order pupils and a teacher act, no message of a pupil changes a locked body."""

from __future__ import annotations

from pathlib import Path
from random import Random
from typing import Any

from physsim_ros.sketchpad import Role
from physsim_ros.testing import PhysSim
import pytest

from .browser import Browser, Page
from .test_locks import ATTEMPTS, load_world, states_of, tell
from ..slow import slow

# A message: its kind and its fields.
Message = tuple[str, dict[str, Any]]
# Actions of a history, and its shares that are those of a teacher, and of time before others.
LENGTH, OF_TEACHER, OF_TIME = 40, 0.3, 0.2
# Patterns of which a teacher locks some.
PATTERNS = ('a/0', 'a/*', 'b/0', 'b/*', '*/1', 'c/*')
# Messages of pupils that matter only after others; half of what they send.
IN_TURN: tuple[Message, ...] = (
    ('seek', {'time': 0.0}),
    ('seek', {'time': 0.05}),
    ('gravity', {'gravity': [0, 0]}),
    ('spawn', {'body': {'name': 'c/0', 'circle': {'radius': 0.5}, 'at': [1, 5]}}),
    ('change', {'name': 'b/0', 'properties': {'friction': 0.7}}),
    ('delete', {'names': ['b/0']}),
    ('unjoin', {'name': 'rod/0'}),
    ('person', {'name': 'Boss'}),
    ('person', {'name': 'Ben'}),
    *(('take_back', {}) for _ in range(4)),
    *(('service', {'name': name}) for name in ('undo', 'redo', 'reset', 'clear') * 2),
)


def of_pupil(random: Random) -> Message:
    """Return a message of a pupil."""
    if random.random() < 0.5:
        return random.choice(IN_TURN)
    # Time at another speed, and a step, are physics, which knows no lock.
    kind = random.choice([each for each in ATTEMPTS if each != 'speed'])
    return kind, random.choice([each for each in ATTEMPTS[kind] if each != {'name': 'step'}])


def of_teacher(random: Random) -> Message:
    """Return a message of a teacher."""
    names = random.sample(PATTERNS, random.choice((0, 1, 1, 1, 2)))
    number, x = random.randrange(3), random.uniform(-9.0, 9.0)
    return random.choice(
        (
            *[('lock', {'names': names})] * 6,
            ('spawn', {'body': {'name': f'c/{number}', 'circle': {'radius': 0.5}, 'at': [x, 9]}}),
            ('change', {'name': f'a/{number}', 'properties': {'friction': random.random()}}),
            ('delete', {'names': [random.choice(('a/0', 'b/1', 'c/0', 'c/1'))]}),
            ('move_bodies', {'names': ['b/0'], 'by': [0.3, 0.0]}),
            ('take_back', {}),
            ('person', {'name': 'Boss'}),
            ('open', {'name': random.choice(('locked', 'lever'))}),
            ('service', {'name': random.choice(('undo', 'redo', 'reset'))}),
            ('freeze', {'frozen': random.random() < 0.2}),
            ('clear_of', {'person': random.choice(('Ben', 'Page 1', 'Page 2', 'Boss'))}),
        )
    )


def return_to_newest(physsim: PhysSim, boss: Page) -> None:
    """Have what is under way be done, and the newest moment be shown."""
    simulation = physsim.node.simulation
    simulation.ticks.continue_work(lambda: False)
    physsim.settle()
    if not simulation.playback.is_newest:
        assert boss.ask('seek', time=simulation.status.newest)['ok']
        simulation.ticks.continue_work(lambda: False)


@pytest.mark.parametrize('seed', [0, 1, 2, *map(slow, (3, 4, 5))])
def test_no_message_of_a_pupil_changes_a_locked_body_whatever_came_before(
    browser: Browser, tmp_path: Path, seed: int
) -> None:
    random, physsim = Random(seed), browser.physsim

    def locked() -> dict[str, str]:
        return states_of(physsim, physsim.node.control.locked_bodies)

    load_world(browser, tmp_path)
    pupils = [browser.open_page() for _ in range(2)]
    boss = browser.open_page(cookie=browser.cookie_of(Role.TEACH))
    for _ in range(LENGTH):
        if random.random() < OF_TEACHER:
            tell(boss, *of_teacher(random))
            continue
        if random.random() < OF_TIME:
            physsim.step(random.randrange(1, 30))
        return_to_newest(physsim, boss)
        before, message = locked(), of_pupil(random)
        tell(random.choice(pupils), *message)
        return_to_newest(physsim, boss)
        assert before.items() <= locked().items(), message


def test_a_pupil_takes_back_what_concerns_no_locked_body_and_nothing_else(
    browser: Browser, tmp_path: Path
) -> None:
    load_world(browser, tmp_path)
    pupil, boss = browser.open_page(), browser.open_page(cookie=browser.cookie_of(Role.TEACH))
    assert pupil.spawn('c/0', y=30.0)['ok']
    for name, code in (('c/0', ''), ('b/0', 'frozen')):
        # Joint `rod/0` is that of `b/0` and of `a/0`.
        assert pupil.ask('delete', names=[name])['ok']
        assert boss.ask('lock', names=['a/0'])['ok']
        assert pupil.ask('take_back')['code'] == code
        assert boss.ask('lock', names=[])['ok']
    assert pupil.ask('take_back')['ok']
    assert boss.ask('lock', names=['a/0'])['ok']
    assert pupil.ask('delete', names=['c/0'])['ok']
    assert pupil.ask('delete', names=['b/0'])['code'] == 'frozen'
