# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Maps: occupancy grids of worlds, and walls of occupancy grids.

The anchored bodies of a world become a grid; a grid becomes a few anchored boxes
(`rectangle_partition`). Files of maps are read in `files`, messages in `ros`. Start with
`occupancy_grid`.
"""

from physsim_ros.maps.occupancy_grid import anchored_grid, Grid, is_on_map, MOST_CELLS, walls_of
from physsim_ros.maps.rectangle_partition import rectangles_of

__all__ = ['MOST_CELLS', 'Grid', 'anchored_grid', 'is_on_map', 'rectangles_of', 'walls_of']
