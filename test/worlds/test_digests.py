# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every shipped world and drawing moves as it did, to the bit; a rewind brings it back."""

import numpy as np
import pytest
import yaml

from .digests import digest_at, DIGESTS, scene, SCENES, TIMES

# How NumPy and its BLAS round sums depends on the vectors of the processor: with those of 512 bits
# the digests were taken. (NumPy 2.4 gave them another name.)
VECTORS = {'AVX512_SKX', 'X86_V4'}
EXPECTED = yaml.safe_load(DIGESTS.read_text(encoding='utf-8'))


def test_every_scene_has_digests():
    assert sorted(EXPECTED) == sorted(SCENES)


@pytest.mark.parametrize('name', SCENES)
def test_it_moves_as_it_did_and_a_rewind_repeats_it(name):
    sim = scene(name)

    first = [digest_at(sim, time) for time in TIMES]
    sim.seek(TIMES[0] * 10**9)
    again = [digest_at(sim, time) for time in TIMES]

    assert again == first
    if VECTORS.isdisjoint(np.show_config(mode='dicts')['SIMD Extensions']['found']):
        pytest.skip('the digests are of processors with AVX-512')
    assert first == EXPECTED[name]
