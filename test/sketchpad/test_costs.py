# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""What each kind of message costs the world's thread at its greatest legal content."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import gc
import json
import math
from pathlib import Path
import time
from typing import Any

import numpy as np
from physsim_ros.model.settings import MOST_SAMPLES
from physsim_ros.sketchpad import Role
from physsim_ros.sketchpad.inbox import Opened
from physsim_ros.sketchpad.locks import MOST_PATTERNS
from physsim_ros.sketchpad.message import KINDS, Message, read_message
from physsim_ros.sketchpad.server.server import MOST_BYTES
from physsim_ros.testing import PhysSim
import pytest

pytestmark = pytest.mark.slow

# Greatest CPU time of a message [s], and what a slow or busy machine may take of it.
MOST, MARGIN = 0.02, 10.0
# CPU time for each body of a message about the whole world, as a file is [s].
EACH, WHOLE = 0.001, {'open', 'save', 'share', 'service'}
# Bodies of the world; and chains of a hundred points at one place, anchored.
BODIES, CHAINS = 300, 10
NAMES = [f'b/{number}' for number in range(BODIES)]
SHARE = np.linspace(0.0, 1.0, MOST_SAMPLES)
ROUND = [[5.0 * math.cos(turn), 5.0 * math.sin(turn)] for turn in np.linspace(0.0, 6.28, 999)]
WAVE = [[0.06 * number, math.sin(0.1 * number)] for number in range(1000)]
LONG = {'name': 'p/1', 'chain': {'points': WAVE, 'thickness': 0.1}, 'at': [0, 300]}
UNKNOWN = [f'unknown/{number}' for number in range(55_000)]


def stroke(x: Any, y: Any) -> dict[str, Any]:
    return {'points': np.column_stack((x, y, 60.0 * SHARE)).round(3).tolist()}


# By kind; several contents of a kind are tried in this order.
MESSAGES: list[tuple[str, dict[str, Any]]] = [
    ('stroke', stroke(60.0 * SHARE, 0.2 * np.sin(60.0 * SHARE))),
    ('stroke', stroke(2.0 + 1.9 * np.sin(200.0 * SHARE), 0.5 * np.sin(90.0 * SHARE))),
    ('stroke', stroke(2.0 + np.cos(6.28 * SHARE), np.sin(6.28 * SHARE))),
    ('instead', {}),
    ('click', {'tool': 'spring', 'point': [2.0, 0.0]}),
    ('drop', {}),
    # Through 30 discs, and through the chains.
    ('click', {'tool': 'knife', 'point': [-1.0, 10.05]}),
    ('click', {'tool': 'knife', 'point': [31.0, 10.06]}),
    ('click', {'tool': 'knife', 'point': [-1.0, 0.01]}),
    ('click', {'tool': 'knife', 'point': [5.0, 0.02]}),
    ('draw_with', {'density': 2.0, 'friction': 0.1, 'color': '#00ff00'}),
    ('spawn', {'body': {'name': 'p/0', 'polygon': ROUND, 'at': [0, 200]}}),
    ('spawn', {'body': LONG}),
    ('change', {'name': 'b/0', 'properties': {'density': 2.0}}),
    ('move_bodies', {'names': NAMES, 'by': [0.01, 0.0]}),
    ('move_bodies', {'names': UNKNOWN, 'by': [0.01, 0.0]}),
    # As many as a message of this size names with their poses.
    ('place', {'names': UNKNOWN[:30_000], 'poses': [[0.0, 0.0, 0.0]] * 30_000}),
    ('copy_machine', {'names': ['b/0'], 'by': [0.0, 400.0]}),
    ('copy_machine', {'names': NAMES, 'by': [0.0, 500.0]}),
    ('copy_machine', {'names': ['b/0'] * 100_000, 'by': [0.0, 500.0]}),
    ('delete', {'names': UNKNOWN}),
    ('follow', {'names': NAMES}),
    ('watch', {'name': 'b/0'}),
    ('drive', {'name': 'b/0', 'velocity': [1.0, 0.0, 0.0]}),
    ('change_joint', {'name': 'j/0', 'properties': {'stiffness': 50.0}}),
    ('motor', {'name': 'j/0', 'position': 1.0}),
    ('unjoin', {'name': 'j/0'}),
    ('gravity', {'gravity': [0.0, -9.0]}),
    ('air', {'damping': 0.1}),
    ('grab', {'point': [2.0, 10.0]}),
    ('move', {'point': [2.0, 11.0]}),
    ('let_go', {}),
    (
        'lock',
        {'names': [*UNKNOWN, *(f'{"*a" * 450}*{number}' for number in range(MOST_PATTERNS))]},
    ),
    ('delete', {'names': NAMES[:1]}),
    ('lock', {'names': []}),
    ('freeze', {'frozen': False}),
    ('person', {'name': 'Anna'}),
    ('answered', {'lesson': 'Free fall', 'answer': '1' * 1000, 'right': False}),
    ('raise_hand', {'raised': True}),
    ('lower_hand', {'page': 2}),
    ('leave', {}),
    ('forget_results', {}),
    ('say', {'text': 'Five minutes left'}),
    ('clear_of', {'person': 'Anna'}),
    ('take_back', {}),
    ('share', {}),
    ('save', {'name': 'mine'}),
    ('open', {'name': 'mine'}),
    ('rename', {'name': 'mine', 'to': 'yours'}),
    ('remove', {'name': 'yours'}),
    ('put_back', {'name': 'yours'}),
    ('forget', {}),
    ('speed', {'speed': 1.0}),
    ('seek', {'time': 0.0}),
    ('course', {'course': 1}),
    ('delete', {'names': NAMES}),
    ('service', {'name': 'undo'}),
    ('service', {'name': 'redo'}),
    ('service', {'name': 'reset'}),
    ('service', {'name': 'clear'}),
]


def world_text() -> str:
    """Return the text of the world."""
    discs = (
        {'name': name, 'circle': {'radius': 0.4}, 'at': [row % 30, 10 + row // 30]}
        for row, name in enumerate(NAMES)
    )
    points = [[0.04 * each, 0.3 * math.sin(0.4 * each)] for each in range(100)]
    chains = (
        {'name': f'c/{each}', 'chain': {'points': points, 'thickness': 0.1}, 'anchored': True}
        for each in range(CHAINS)
    )
    lines = [f'  - {json.dumps(each)}\n' for each in (*discs, *chains)]
    joint = {'name': 'j/0', 'kind': 'spring', 'a': 'b/0', 'b': 'b/1', 'points': [[0, 10], [1, 10]]}
    return f'format: 1\nbodies:\n{"".join(lines)}joints:\n  - {json.dumps(joint)}\n'


@pytest.fixture
def crowded(start: Callable[..., PhysSim], tmp_path: Path) -> Iterator[PhysSim]:
    """Give a test a world of many bodies, which has a page."""
    physsim = start(sketchpad='serve', sketchpad_port=0)
    (tmp_path / 'crowded.yaml').write_text(world_text())
    physsim.load(tmp_path / 'crowded.yaml')
    physsim.step(2)
    # Garbage of other tests would be collected within a message.
    gc.collect()
    gc.freeze()
    yield physsim
    gc.unfreeze()


def test_no_message_takes_the_thread_of_the_world_for_long(crowded: PhysSim) -> None:
    node, sketchpad = crowded.node, crowded.node.outputs.sketchpad
    assert sketchpad is not None
    # A teacher's page, which may send all kinds, and a pupil's, whose bodies are looked up.
    for page, role in ((1, Role.TEACH), (2, Role.DRAW)):
        sketchpad._open(page, Opened(role=role, person=page, key=''))  # noqa: SLF001 - no socket
    for_world = {type_ for type_, kind in KINDS.items() if kind.for_world}
    messages = [*MESSAGES, ('open_text', {'world': world_text()})]
    assert {kind for kind, _ in messages} == for_world
    # CPU time in shares of what it may be.
    longest: list[tuple[float, str]] = []

    def note(began: float, kind: str, what: str) -> None:
        took, most = time.thread_time() - began, MOST + EACH * len(crowded.names) * (kind in WHOLE)
        longest.append((took / most, f'{kind}, {what}: {took * 1e3:.1f} ms'))

    for kind, fields in messages:
        text = json.dumps({'type': kind, **fields})
        assert len(text) <= MOST_BYTES + 400_000
        for page, role in ((1, Role.TEACH), (2, Role.DRAW)):
            if page == 2 and kind not in ('delete', 'stroke', 'move_bodies'):
                continue
            _, message = read_message(text, role, node.boundary)
            assert isinstance(message, Message), message
            began = time.thread_time()
            sketchpad._sessions[page].handle(message)  # noqa: SLF001 - no socket
            note(began, kind, 'handled')
            # A tick applies a request after the other while there is time.
            while node.simulation.applier.has_requests:
                began = time.thread_time()
                node.simulation.applier.apply_ready(lambda: True)
                note(began, kind, 'applied')
            crowded.step()
    longest.sort(reverse=True)
    report = [text for _, text in longest[:8]]
    print(*report, sep='\n')  # noqa: T201 - for who reads the log
    assert longest[0][0] < MARGIN, report
