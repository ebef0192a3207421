# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Strokes are read to the same bits on every x86-64 processor with FMA.

`OPENBLAS_CORETYPE` has OpenBLAS run the kernels of another processor, `NPY_DISABLE_CPU_FEATURES`
takes vector loops from NumPy. Both are read when NumPy is loaded, so that each is a process.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
import hashlib
import os
import pickle
import platform
import subprocess
import sys

import numpy as np
from numpy._core._multiarray_umath import __cpu_dispatch__, __cpu_features__
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.choice import reading_of
from physsim_ros.drawing.strokes.forms import classification_of
from physsim_ros.drawing.strokes.reading import guesses_of
from physsim_ros.drawing.strokes.stages import MOST_GUESSES
from physsim_ros.drawing.strokes.stroke import resample_stroke
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import Refusal
from physsim_ros.simulation.world import World
import pytest
from tools.evaluation.scenes import faulty_scenes, scenes

from .machines import LAWS, strokes_of

pytestmark = pytest.mark.slow

# Strokes of each kind and of each fault.
_COUNT = 2
# NumPy's sets of vector instructions that this processor has, AVX-512 alone and all.
_HAS = [each for each in __cpu_dispatch__ if __cpu_features__[each]]
_AVX512 = [each for each in _HAS if each.startswith('AVX512') or each == 'X86_V4']
_PROCESSORS = {
    'Haswell': {'OPENBLAS_CORETYPE': 'Haswell'},
    'Zen': {'OPENBLAS_CORETYPE': 'Zen', 'NPY_DISABLE_CPU_FEATURES': ' '.join(_AVX512)},
    'SkylakeX': {'OPENBLAS_CORETYPE': 'SkylakeX'},
    'no vectors': {'OPENBLAS_CORETYPE': 'Nehalem', 'NPY_DISABLE_CPU_FEATURES': ' '.join(_HAS)},
}


@pytest.mark.skipif(platform.machine() != 'x86_64', reason='the kernels are those of x86-64')
def test_strokes_are_read_to_the_same_bits_on_every_processor() -> None:
    children = {
        name: subprocess.Popen(
            [sys.executable, '-m', __name__],
            env={**os.environ, **settings, 'OPENBLAS_NUM_THREADS': '1'},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )
        for name, settings in _PROCESSORS.items()
    }
    # The hands compute with BLAS, so that all processes are given the same strokes.
    strokes = list(_strokes())
    message = pickle.dumps(strokes)
    digests = {name: child.communicate(message)[0] for name, child in children.items()}

    assert not any(child.returncode for child in children.values())
    assert digests == dict.fromkeys(digests, digest_of_readings(strokes).encode())


def digest_of_readings(strokes: Iterable[tuple[Floats, SceneQuery]]) -> str:
    """Return the digest of the readings of many strokes: guesses, requests and outlines."""
    total = hashlib.sha256()
    for samples, scene in strokes:
        try:
            drawn = classification_of(resample_stroke(samples))
            guesses = guesses_of(drawn, scene, DrawingSettings())
        except Refusal as refusal:
            total.update(repr(refusal).encode())
            continue
        for guess in guesses:
            total.update(repr((guess.meaning, guess.confidence)).encode())
        for number in range(min(len(guesses), MOST_GUESSES)):
            try:
                reading = reading_of(guesses, number)
            except Refusal as refusal:
                total.update(repr(refusal).encode())
                continue
            total.update(repr(reading.requests).encode())
            total.update(np.ascontiguousarray(reading.outline).tobytes())
    return total.hexdigest()


def _strokes() -> Iterator[tuple[Floats, SceneQuery]]:
    """Yield strokes of hands and of rulers."""
    for scene in (*scenes(_COUNT, 'report'), *faulty_scenes(_COUNT, 'report')):
        yield scene.samples, scene.view
    empty = SceneQuery(World().snapshot())
    for name in LAWS:
        for stroke in strokes_of(name):
            yield stroke, empty


if __name__ == '__main__':
    # Written by the test above.
    given = pickle.load(sys.stdin.buffer)  # noqa: S301
    sys.stdout.write(digest_of_readings(given))
