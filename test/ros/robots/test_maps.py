# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Maps over topics: walls from an occupancy grid, and the map of the world."""

from __future__ import annotations

from nav_msgs.msg import OccupancyGrid
import numpy as np
from physsim_ros.testing import box, disc, PhysSim
import pytest

from ..messages import grid
from ...client import Client, KEPT, set_parameter


def test_occupied_cells_become_walls_in_place_of_earlier_ones(
    physsim: PhysSim, client: Client
) -> None:
    client.ask('~/walls', grid('###', '#..', '#..'))
    assert physsim.names == ('walls/0', 'walls/1')
    client.ask('~/walls', grid('...', '.#.', '...'))
    assert physsim.names == ('walls/0',)
    assert physsim.pose('walls/0')[:2] == pytest.approx((0.75, 0.75))
    # One message is undone at once.
    physsim.node.simulation.undo()
    physsim.node.loop.apply_requests()
    assert physsim.names == ('walls/0', 'walls/1')


def test_the_map_of_walls_is_the_grid_that_they_were_made_of(
    physsim: PhysSim, client: Client
) -> None:
    set_parameter(physsim, 'map_resolution', 0.5)
    maps = client.listen(OccupancyGrid, '~/map', KEPT)
    message = grid('#####', '#...#', '#.#.#', '#...#', '#####')
    client.ask('~/walls', message)
    physsim.step()
    assert maps[-1].data == message.data
    assert (maps[-1].info.width, maps[-1].info.height) == (5, 5)
    # Another one comes when it changes, and only then.
    count = len(maps)
    physsim.spawn(disc('ball/0', at=(1.25, 3.0), diameter=0.3))
    physsim.spawn(box('zone/0', at=(1.25, 0.75), size=(0.5, 0.5), anchored=True, sensor=True))
    physsim.run(0.5)
    assert len(maps) == count
    physsim.spawn(box('crate/0', at=(1.25, 0.75), size=(0.5, 0.5), anchored=True))
    physsim.step()
    assert len(maps) == count + 1
    assert np.count_nonzero(maps[-1].data) == np.count_nonzero(message.data) + 1
