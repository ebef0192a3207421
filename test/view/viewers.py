# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Frames for the tests of viewers, and records of what a viewer told and recorded of them."""

from __future__ import annotations

from collections import Counter
import os
import textwrap
import warnings

import numpy as np
from physsim_ros.model.answer import Answer
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Frame, Snapshot
import pytest

from ..building import PLAIN_BODY
from ..outside import run_python, until
from ..rerun_program import free_port, is_open, rerun

chunk = pytest.importorskip('rerun.chunk')

# The entity of the only body.
BOX = '/world/bodies/box/0'
SCENE = Scene(bodies=(PLAIN_BODY,), settings=WorldSettings())


def frame(step, *messages):
    pose = np.array([[float(step), 0.0, 0.0]])
    snapshot = Snapshot(step=step, stamp=step * 4_166_667, scene=SCENE, poses=pose, twists=pose)
    answers = tuple(Answer(topic='~/spawn', message=each) for each in messages)
    return Frame(snapshot=snapshot, contacts=None, answers=answers)


def show(viewer, count, first=0):
    for step in range(first, first + count):
        viewer.show(frame(step))


def bulk():
    """Return words that cannot be compressed, so that a few hundred frames fill every buffer."""
    return os.urandom(100_000).hex()


def rows(path):
    """Return how many rows each entity of a recording has, which may be written meanwhile."""
    counts = Counter()
    with warnings.catch_warnings():
        warnings.filterwarnings('ignore', 'RRD file has no footer')
        for each in chunk.RrdReader(path).stream():
            if not each.is_static:
                counts[each.entity_path] += each.num_rows
    return counts


def rows_when(path, entity, count):
    """Wait until a recording that is being written has so many rows of an entity; return all."""

    def enough():
        try:
            counts = rows(path)
        except (OSError, RuntimeError, ValueError):
            # Not there yet, or in the middle of a message.
            return None
        return counts if counts[entity] >= count else None

    return until(enough)


def run_alone(program, *arguments):
    """Run a program in a process of its own, and return what it prints."""
    return run_python('-c', textwrap.dedent(program), *arguments)


class Server:
    """A Rerun server that writes what it is sent, of somebody else's."""

    def __init__(self, path):
        self.path = path
        self.port = free_port()
        self.url = f'rerun+http://127.0.0.1:{self.port}/proxy'
        self.process = None

    def start(self):
        self.process = rerun(f'--port={self.port}', '--save', self.path)
        until(lambda: is_open(self.port))

    def kill(self):
        self.process.kill()
        self.process.wait()

    def wait_for(self, entity, count):
        """Wait until it has written so many rows of an entity; return how many of all."""
        return rows_when(self.path, entity, count)


class Events:
    """The answers of a viewer so far."""

    def __init__(self, viewer):
        self._viewer = viewer
        self.all = []

    def wait_for(self, code):
        """Return the first event with that code that has not been waited for."""

        def found():
            self.all += self._viewer.poll()
            return [each for each in self.all if each.code == code]

        first = until(found)[0]
        self.all.remove(first)
        return first
