# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every shipped world and drawing moves as it did, to the bit; a rewind brings it back."""

from importlib.util import find_spec
import shlex
import shutil
import sys

import numpy as np
import pytest
import yaml

from .digests import digest_at, DIGESTS, scene, SCENES, TIMES
from ..outside import run_python
from ..simulation.histories import history_of, play
from ..slow import slow
from ..source_tree import compile_core, copy_source, ROOT, zig_cache


def dispatched():
    """Return the vector features that NumPy finds here, and can do without."""
    return np.show_config(mode='dicts')['SIMD Extensions']['found']


# Processors by the kernels that OpenBLAS has for them, and by what NumPy may use of their vectors.
PROCESSORS = {
    'AMD, and Intel without AVX-512': {'OPENBLAS_CORETYPE': 'Haswell'},
    'Intel with AVX-512': {'OPENBLAS_CORETYPE': 'SkylakeX'},
    'before AVX, and NumPy without vectors': {
        'OPENBLAS_CORETYPE': 'Nehalem',
        'NPY_DISABLE_CPU_FEATURES': ' '.join(dispatched()),
    },
}
ZIG = shlex.join([sys.executable, '-m', 'ziglang', 'cc'])
# Compilations of the core by compiler and flags, which come after those of `setup.py`.
COMPILERS = {
    'gcc': {'CC': 'gcc'},
    'gcc without optimisation': {'CC': 'gcc', 'CFLAGS': '-O0'},
    'gcc with all that this processor has': {'CC': 'gcc', 'CFLAGS': '-O3 -march=native'},
    'clang': {'CC': 'clang' if shutil.which('clang') else ZIG},
}
# Of a random history that differs where GCC makes fused instructions of loops.
SEED = 42
# Scenes that are played, and replayed, in less than five seconds.
QUICK = {
    *('worlds/demo', 'worlds/dominoes', 'worlds/newtons_cradle'),
    *('drawings/marble_run', 'drawings/pendulum', 'drawings/spring_and_mass'),
}
EXPECTED = yaml.safe_load(DIGESTS.read_text(encoding='utf-8'))


def printed(module, *words, tree=ROOT, **variables):
    """Run a module of a source tree in a process of its own; return what it prints."""
    return run_python('-m', module, *words, cwd=tree, **{'PYTHONPATH': str(tree)} | variables)


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
    digests = yaml.safe_load(printed('test.worlds.digests', '--print', **PROCESSORS[processor]))

    assert digests == {name: each[:1] for name, each in EXPECTED.items()}


@pytest.mark.slow
@pytest.mark.parametrize('name', COMPILERS)
def test_it_moves_alike_by_every_compiler(name, tmp_path, tmp_path_factory):
    compiler = COMPILERS[name]
    if compiler['CC'] == ZIG and find_spec('ziglang') is None:
        pytest.skip('neither clang nor ziglang is installed')
    if compiler['CC'] == 'gcc' and shutil.which('gcc') is None:
        pytest.skip('gcc is not installed')
    tree = copy_source(tmp_path / 'source')
    compile_core(tree, **compiler, **zig_cache(tmp_path_factory))

    digests = yaml.safe_load(printed('test.worlds.digests', '--print', tree=tree))
    history = printed('test.simulation.histories', str(SEED), '--digest', tree=tree)

    assert digests == {name: each[:1] for name, each in EXPECTED.items()}
    assert history.strip() == play(history_of(SEED)).digest()
