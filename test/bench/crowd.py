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

"""The cost of fast bodies: a crowd of small discs that falls, lands and lies."""

import time

from physsim_ros.model.requests import Configure, Spawn
from physsim_ros.model.shapes import Disc
from physsim_ros.simulation.world import World

FRAMES = 100


def crowd(count: int) -> World:
    """Return discs of 10 cm in rows of a hundred, 5 m above the ground."""
    world = World()
    world.apply(Configure(changes={'bounds': (-10.0, 0.0, 10.0, 30.0)}))
    for number in range(count):
        row, column = divmod(number, 100)
        pose = (0.15 * column - 8.0, 5.0 + 0.15 * row, 0.0)
        world.apply(Spawn(name=f'disc/{number}', shape=Disc(radius=0.05), pose=pose))
    return world


def table() -> None:
    """Print it."""
    print('\nA frame of 4 steps while small discs fall from 5 m [ms]')
    print('bodies    mean  longest')
    for count in (100, 1000):
        world, costs = crowd(count), []
        for _ in range(FRAMES):
            began = time.perf_counter_ns()
            world.step(4)
            costs.append((time.perf_counter_ns() - began) * 1e-6)
        print(f'{count:6} {sum(costs) / FRAMES:7.1f} {max(costs):8.1f}')
