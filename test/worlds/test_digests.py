# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every shipped world and drawing moves as it did, to the bit; a rewind brings it back."""

import os
from pathlib import Path
import subprocess
import sys

import numpy as np
import pytest
import yaml

from .digests import digest_at, DIGESTS, scene, SCENES, TIMES
from ..slow import slow


def dispatched():
    """Return the vector features that NumPy finds here, and can do without."""
    return np.show_config(mode='dicts')['SIMD Extensions']['found']


ROOT = Path(__file__).parents[2]
# Processors by the kernels that OpenBLAS has for them, and by what NumPy may use of their vectors.
PROCESSORS = {
    'AMD, and Intel without AVX-512': {'OPENBLAS_CORETYPE': 'Haswell'},
    'Intel with AVX-512': {'OPENBLAS_CORETYPE': 'SkylakeX'},
    'before AVX, and NumPy without vectors': {
        'OPENBLAS_CORETYPE': 'Nehalem',
        'NPY_DISABLE_CPU_FEATURES': ' '.join(dispatched()),
    },
}
# Scenes that are played, and replayed, in less than five seconds.
QUICK = {
    *('worlds/demo', 'worlds/dominoes', 'worlds/newtons_cradle'),
    *('drawings/marble_run', 'drawings/pendulum', 'drawings/spring_and_mass'),
}
EXPECTED = yaml.safe_load(DIGESTS.read_text(encoding='utf-8'))


def test_every_scene_has_digests():
    assert sorted(EXPECTED) == sorted(SCENES)


@pytest.mark.parametrize('name', [name if name in QUICK else slow(name) for name in SCENES])
def test_it_moves_as_it_did_and_a_rewind_repeats_it(name):
    sim = scene(name)

    first = [digest_at(sim, time) for time in TIMES]
    sim.seek(TIMES[0] * 10**9)
    again = [digest_at(sim, time) for time in TIMES]

    assert again == first
    assert first == EXPECTED[name]


@pytest.mark.slow
@pytest.mark.parametrize('processor', PROCESSORS)
def test_it_moves_alike_on_every_processor_with_fma(processor):
    played = subprocess.run(
        [sys.executable, '-m', 'test.worlds.digests', '--print'],
        cwd=ROOT,
        env=os.environ | PROCESSORS[processor],
        check=True,
        capture_output=True,
    )

    assert yaml.safe_load(played.stdout) == {name: each[:1] for name, each in EXPECTED.items()}
