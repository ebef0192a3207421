# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Nothing on the way from a request to a state or a reading rounds otherwise on another processor.

OpenBLAS chooses its kernels by processor, NumPy its loops by vectors: products of matrices, and
functions whose loops for AVX-512 round otherwise than the others.
"""

import ast

import pytest

from .sources import PACKAGE, trees

FOLDERS = ('model', 'sensing', 'engine', 'simulation', 'drawing')
BLAS = {'dot', 'vdot', 'inner', 'matmul', 'einsum', 'tensordot', 'linalg', 'convolve', 'correlate'}
# Measured: without AVX-512 these have other bits (NumPy 2.4).
VECTORS = {'arctan2', 'angle', 'exp', 'log', 'power'}


def _names(tree):
    """Yield what a module calls of NumPy, with its line."""
    for node in ast.walk(tree):
        match node:
            case ast.BinOp(op=ast.MatMult()) | ast.AugAssign(op=ast.MatMult()):
                yield '@', node.lineno
            case ast.Attribute(value=ast.Name(id='np'), attr=name) if name in BLAS | VECTORS:
                yield name, node.lineno


@pytest.mark.linter
@pytest.mark.parametrize('folder', FOLDERS)
def test_what_moves_bodies_calls_nothing_that_depends_on_the_processor(folder):
    found = [
        f'{path.relative_to(PACKAGE)}:{line}: {name}'
        for path, tree in trees().items()
        if path.is_relative_to(PACKAGE / folder)
        for name, line in _names(tree)
    ]

    assert found == []


def test_a_product_of_matrices_is_found():
    source = 'import numpy as np\nx = a @ b\ny = np.linalg.norm(x)\n'

    assert [name for name, _ in _names(ast.parse(source))] == ['@', 'linalg']
