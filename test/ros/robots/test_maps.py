# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Maps over topics: walls from an occupancy grid, and the map of the world."""

from __future__ import annotations

from array import array
import math

from nav_msgs.msg import OccupancyGrid
import numpy as np
from physsim_ros.testing import box, PhysSim
import pytest

from ...client import Client, KEPT, set_parameter


def grid(rows: list[str], resolution: float = 0.5, yaw: float = 0.0) -> OccupancyGrid:
    """Return a map of rows of # and ., the highest first."""
    message = OccupancyGrid()
    message.header.frame_id = 'map'
    cells = [[100 if cell == '#' else 0 for cell in row] for row in reversed(rows)]
    message.info.height, message.info.width = len(cells), len(cells[0])
    message.info.resolution = resolution
    message.info.origin.orientation.z = math.sin(yaw / 2)
    message.info.origin.orientation.w = math.cos(yaw / 2)
    message.data = array('b', [cell for row in cells for cell in row])
    return message


def test_occupied_cells_become_walls_in_place_of_earlier_ones(
    physsim: PhysSim, client: Client
) -> None:
    client.ask('~/walls', grid(['###', '#..', '#..']))
    assert physsim.names == ('walls/0', 'walls/1')
    client.ask('~/walls', grid(['...', '.#.', '...']))
    assert physsim.names == ('walls/0',)
    assert physsim.pose('walls/0')[:2] == pytest.approx((0.75, 0.75))
    # One message is undone at once.
    physsim.node.simulation.undo()
    physsim.node.apply_requests()
    assert physsim.names == ('walls/0', 'walls/1')


@pytest.mark.parametrize(
    ('change', 'code', 'field'),
    [
        (lambda message: message.data.pop(), 'malformed', 'data'),
        (lambda message: setattr(message.info, 'resolution', 0.0), 'bad_size', 'resolution'),
        (lambda message: setattr(message.info, 'resolution', math.nan), 'malformed', 'resolution'),
        (
            lambda message: setattr(message.header, 'frame_id', 'base_link'),
            'unknown_frame',
            'header.frame_id',
        ),
        (
            lambda message: setattr(message.info.origin.orientation, 'x', 1.0),
            'not_planar',
            'info.origin.orientation',
        ),
    ],
)
def test_a_map_that_is_none_is_refused(
    physsim: PhysSim, client: Client, change: object, code: str, field: str
) -> None:
    message = grid(['#.', '.#'])
    change(message)  # type: ignore[operator]
    (event,) = client.ask('~/walls', message)
    assert (event.name, event.code, event.field) == ('~/walls', code, field)
    assert physsim.names == ()


def test_the_map_of_walls_is_the_grid_that_they_were_made_of(
    physsim: PhysSim, client: Client
) -> None:
    set_parameter(physsim, 'map_resolution', 0.5)
    maps: list[OccupancyGrid] = []
    client.node.create_subscription(OccupancyGrid, '/physsim/map', maps.append, KEPT)
    client.spin_until(lambda: client.node.count_publishers('/physsim/map'))
    message = grid(['#####', '#...#', '#.#.#', '#...#', '#####'])
    client.ask('~/walls', message)
    physsim.step()
    assert maps[-1].data == message.data
    assert (maps[-1].info.width, maps[-1].info.height) == (5, 5)
    # Another one comes when it changes, and only then.
    count = len(maps)
    physsim.run(0.5)
    assert len(maps) == count
    physsim.spawn(box('crate/0', at=(1.25, 0.75), size=(0.5, 0.5), anchored=True))
    physsim.step()
    assert len(maps) == count + 1
    assert np.count_nonzero(maps[-1].data) == np.count_nonzero(message.data) + 1
