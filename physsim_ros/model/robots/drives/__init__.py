# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Drives: by which wheels a robot moves, one file a kind.

A drive says where it aims at for a command, and how fast the rims of its wheels are. The engine
needs no more, so that a new drive is a file here and a member of `DRIVES`. Start with `drive`,
then `differential`.
"""

from __future__ import annotations

from physsim_ros.model.declarations import OfKind
from physsim_ros.model.robots.drives.car import Car
from physsim_ros.model.robots.drives.differential import Differential
from physsim_ros.model.robots.drives.drive import Drive
from physsim_ros.model.robots.drives.omni import Omni

# By the word for it.
DRIVES: dict[str, type[Drive]] = {each.KIND: each for each in (Differential, Omni, Car)}


# The check of a drive.
drive_from = OfKind('drive', DRIVES)

__all__ = ['DRIVES', 'Car', 'Differential', 'Drive', 'Omni', 'drive_from']
