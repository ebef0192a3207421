# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The noise of odometry, which the core reads step by step from blocks that are made ahead.

Law: it depends on seed, name and step alone, so that a rewind repeats it.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.engine.core_world import Table
from physsim_ros.model.noise import normals
from physsim_ros.model.scene import Scene

# Steps whose noise is made at once: a call of `normals` takes as long as 300 of its numbers.
_BLOCK = 64


class OdometryNoise:
    """
    The noise of the odometry of robots.

    :param robots: (r,) `Robot`, which refer to it
    :param scene: with these robots
    """

    def __init__(self, robots: Table, scene: Scene) -> None:
        self._robots = robots
        self._scene = scene
        # Numbers of the robots whose odometry is noisy.
        self._noisy = np.flatnonzero(robots['slip'].any(axis=1))
        # Numbers of the blocks that are made, as the core reads them, and the addresses of their
        # first numbers.
        self._blocks = range(0)
        self._noise = np.empty((0, 0, 2 * _BLOCK))
        self._rows = np.empty(0, np.int64)

    def make(self, step: int, count: int) -> None:
        """Make the noise of some steps after a step."""
        if not len(self._noisy):
            return
        blocks = range(step // _BLOCK, (step + count - 1) // _BLOCK + 1)
        if blocks != self._blocks:
            self._make_blocks(blocks)
        begin = step - self._blocks[0] * _BLOCK
        self._robots['noise'][self._noisy] = self._rows + 2 * self._noise.itemsize * begin

    def _make_blocks(self, blocks: range) -> None:
        """Make blocks of noise, two numbers a step, in a row of each robot that has noise."""
        kept = {block: place for place, block in enumerate(self._blocks)}
        noise = np.empty((len(self._noisy), len(blocks), 2 * _BLOCK))
        names = [self._scene.names[row] for row in self._robots['body'][self._noisy].tolist()]
        for place, block in enumerate(blocks):
            if block in kept:
                noise[:, place] = self._noise[:, kept[block]]
                continue
            for row, name in zip(noise, names, strict=True):
                row[place] = normals(
                    self._scene.settings.seed, f'odometry of {name}', block, 2 * _BLOCK
                )
        self._blocks, self._noise = blocks, noise
        self._rows = noise.ctypes.data + noise.strides[0] * np.arange(len(noise))
