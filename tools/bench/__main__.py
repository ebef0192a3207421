# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`make bench`; `make bench ARGS='300 1000'` chooses the counts of bodies."""

import gc
import sys

from . import (
    capacity,
    chromium_page,
    classroom,
    crowd,
    fixture,
    frames,
    joints,
    outside,
    pages,
    picture,
    recording_page,
    resting,
    rewinding,
    robots,
    sensors,
    startup,
)

# As the node does: what has been imported stays, and the collector need not look at it.
gc.collect()
gc.freeze()
frames.table([int(word) for word in sys.argv[1:]] or [100, 300, 1000])
fixture.table()
outside.table()
resting.table()
capacity.table()
crowd.table()
joints.table()
sensors.table()
robots.table()
rewinding.table()
pages.table()
classroom.table()
chromium_page.table()
picture.table()
recording_page.table()
startup.table()
