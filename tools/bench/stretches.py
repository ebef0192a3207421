# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Longest stretch of CPU [ms] in which the world's thread does nothing else, by file and operation.

A file is full of one kind of thing, as long as a page may send it, or as long as the limits of a
world allow. A stretch is a tick of the node, with its frame for a page in another process, or the
call of a service. `python -m tools.bench.stretches` writes the table into docs/security.md; with
names of kinds it measures these, and keeps the other rows.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
import gc
import sys
import time

from physsim_ros.files import load_mapping, on_thread, text_of
from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import PhysSimError, WorldFull
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.ros.programs.collector import Collector
from physsim_ros.runtime.slices import in_slices, Sliced
from physsim_ros.simulation.entries import Origin, Wait
from physsim_ros.sketchpad.world_control import open_content
from physsim_ros.testing import own_context
import pytest
from tools.bench.full_files import KindOfFile, KINDS
from tools.bench.full_files import text_of as text_full_of
from tools.bench.pages import open_pages, run_until, served_node
from tools.tables.documents import ROOT, with_parts

# Length of a file, the greatest that a page may send [characters], and what is left of one that is
# refused as too large.
LENGTH, SHORTER = 2**20, 0.9
# Longest wait for the end of an operation [s].
LATEST = 120.0
# Simulation time of a run, in which a checkpoint is made [s], and its longest wall time [s].
RUN, LONGEST_RUN = 3.2, 20.0
# Pause between two ticks, in which other threads work [s].
PAUSE = 0.002
DOCUMENT = ROOT / 'docs' / 'security.md'
PART = 'longest stretches'
COMMENT = '<!-- {}: made by `python -m tools.bench.stretches` -->'


class Watched:
    """
    A node whose stretches are measured.

    :param node: that is served

    :ivar longest: CPU time of the longest stretch since it was set to 0 [s]
    """

    def __init__(self, node: PhysSimNode) -> None:
        self.node = node
        self.longest = 0.0
        self._collector = Collector()

    def call(self, action: Sliced[str], wait: Wait = Wait.FOR_SEEK) -> None:
        """
        Perform an action in its turn, as a service does, and wait for its end.

        :raises PhysSimError: it is refused
        """
        refusals: list[PhysSimError] = []
        told: list[str] = []

        async def answers() -> Sequence[Answer]:
            try:
                told.append(await in_slices(action))
            except PhysSimError as refusal:
                refusals.append(refusal)
            return ()

        self._measure(lambda: self.node.loop.make_call(answers, wait))
        self.tick_until(lambda: bool(told or refusals))
        if refusals:
            raise refusals[0]

    def seek(self, stamp: int) -> None:
        """Go to a simulation time [ns]."""
        self._measure(lambda: self.node.control.time.submit_seek(stamp, Origin('~/seek')))
        self.tick_until(lambda: True)

    def tick_until(self, is_over: Callable[[], bool]) -> None:
        """Tick until something holds and nothing is under way, and twice more."""
        applier, playback = self.node.simulation.applier, self.node.simulation.playback
        end, more = time.monotonic() + LATEST, 2
        while more:
            more -= is_over() and playback.is_there and not applier.is_busy
            if time.monotonic() > end:
                raise TimeoutError(f'an operation takes more than {LATEST:g} s')
            self._measure(self._tick)
            time.sleep(PAUSE)

    def _tick(self) -> None:
        self.node.tick(time.monotonic_ns())
        self._collector.collect_if_due()

    def _measure(self, act: Callable[[], object]) -> None:
        """Do a stretch of work, and note its CPU time."""
        began = time.thread_time()
        act()
        self.longest = max(self.longest, time.thread_time() - began)


Operation = Callable[[Watched, str], None]


def load(watched: Watched, text: str) -> None:
    """Begin with the world of a text, as an upload does."""
    content = load_mapping(text, field='world')
    watched.call(partial(open_content, watched.node.simulation, content))


def run(watched: Watched, _: str) -> None:
    """Run the world over a checkpoint, or for a while."""
    simulation = watched.node.simulation
    simulation.speed = 1.0
    end = simulation.step + round(RUN * simulation.physics_rate)
    latest = time.monotonic() + LONGEST_RUN
    watched.tick_until(lambda: simulation.step >= end or time.monotonic() > latest)
    simulation.speed = 0.0
    watched.tick_until(lambda: True)


def seek(watched: Watched, _: str) -> None:
    """Go to a step whose frame is not cached, by a replay from a checkpoint, and back."""
    simulation = watched.node.simulation
    for step in (simulation.step // 2 + 1, simulation.past.line.head):
        watched.seek(round(step * 1e9 / simulation.physics_rate))


def save(watched: Watched, _: str) -> None:
    """Write the world on a thread, as a page's `share`, files and autosaves do."""
    simulation = watched.node.simulation

    async def written() -> str:
        saved, rate = simulation.saver(), simulation.physics_rate
        return await on_thread(lambda: text_of(saved(), rate, longest=4 * LENGTH))

    watched.call(written)


def of_service(name: str) -> Operation:
    """Return the operation that calls a service."""
    return lambda watched, _: watched.call(*watched.node.control.services[name])


# By the head of the column; they are carried out in this order.
OPERATIONS: Mapping[str, Operation] = {
    'load': load,
    'run': run,
    'seek': seek,
    'save': save,
    'reset': of_service('reset'),
    'undo': of_service('undo'),
    'redo': of_service('redo'),
    'clear': of_service('clear'),
    'undo of it': of_service('undo'),
}


@contextmanager
def watched_node() -> Iterator[Watched]:
    """Give a paused node with a page in another process, which reads all frames."""
    with pytest.MonkeyPatch.context() as patch, own_context(patch) as context:
        node = served_node(context)
        node.loop.started = True
        try:
            with open_pages(node, 1) as read_line:
                run_until((node,), read_line)
                yield Watched(node)
        finally:
            node.destroy_node()
            gc.collect()


def stretches_of(kind: KindOfFile) -> dict[str, float]:
    """Return the longest stretch of each operation with the world of a file [s]."""
    found: dict[str, float] = {}
    with watched_node() as watched:
        length = LENGTH
        for name, operate in OPERATIONS.items():
            text = text_full_of(kind, length)
            while True:
                watched.longest = 0.0
                try:
                    operate(watched, text)
                    break
                except WorldFull:
                    if operate is not load:
                        # A world whose text is too long is refused once that is written.
                        break
                    # The limits of a world are reached before that of a file.
                    length = int(SHORTER * length)
                    text = text_full_of(kind, length)
            found[name] = watched.longest
    return found


def main(kinds: Sequence[str]) -> None:
    """Measure files of some kinds, or of all, and write their rows."""
    _, _, part = DOCUMENT.read_text(encoding='utf-8').partition(COMMENT.format(PART))
    part, _, _ = part.partition(COMMENT.format('end'))
    rows = {line.split('|')[1].strip(): line for line in part.split('\n') if line[:2] == '| '}
    head = ('full of', *OPERATIONS)
    for kind in kinds or KINDS:
        costs = stretches_of(KINDS[kind]).values()
        rows[kind] = f'| {kind} | {" | ".join(f"{1e3 * cost:.0f}" for cost in costs)} |'
        print(rows[kind], flush=True)
        kept = [rows[each] for each in KINDS if each in rows]
        text = '\n'.join(('', f'| {" | ".join(head)} |', '|---' * len(head) + '|', *kept, '', ''))
        DOCUMENT.write_text(with_parts(DOCUMENT, {PART: text}, COMMENT), encoding='utf-8')


if __name__ == '__main__':
    main(sys.argv[1:])
