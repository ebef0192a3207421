# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Robots and walls in ir-sim; run by a Python that has ir-sim, and not this project.

Reads {robots, walls, beams, speed, turn, step, seconds} as JSON from standard input, and prints
how many times faster than real time it is by CPU time, as the best of two.
"""

from __future__ import annotations

import json
from pathlib import Path
import sys
import tempfile
import time

import irsim
import numpy as np

asked = json.load(sys.stdin)
laser = {'name': 'lidar2d', 'range_min': 0.12, 'range_max': 3.5, 'angle_range': 6.2832}
robots = [
    {
        'kinematics': {'name': 'diff'},
        'shape': {'name': 'circle', 'radius': 0.105},
        'state': [x, y, 0.0],
        'vel_max': [0.22, 2.84],
        'sensors': [laser | {'number': asked['beams'], 'noise': False}],
    }
    for x, y in asked['robots']
]
obstacles = [
    {'shape': {'name': 'rectangle', 'length': 0.5, 'width': 0.1}, 'state': list(pose)}
    for pose in asked['walls']
]
world = {
    'height': 200,
    'width': 200,
    'offset': [-100, -100],
    'step_time': asked['step'],
    'sample_time': asked['step'],
    'collision_mode': 'stop',
}
with tempfile.TemporaryDirectory() as directory:
    path = Path(directory) / 'world.yaml'
    path.write_text(json.dumps({'world': world, 'robot': robots, 'obstacle': obstacles}))
    env = irsim.make(str(path), display=False, log_level='ERROR')
    action = [np.array([[asked['speed']], [asked['turn']]]) for _ in robots]
    steps = round(asked['seconds'] / asked['step'])
    env.step(action)
    best = float('inf')
    for _ in range(2):
        began = time.process_time()
        for _ in range(steps):
            env.step(action)
        best = min(best, time.process_time() - began)
    print(asked['seconds'] / best)
