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
