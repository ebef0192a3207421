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

"""`make bench`; `make bench ARGS='300 1000'` chooses the counts of bodies."""

import gc
import sys

from . import (
    capacity,
    chromium_page,
    crowd,
    frames,
    joints,
    outside,
    pages,
    picture,
    recording_page,
    resting,
    rewinding,
    startup,
)

# As the node does: what has been imported stays, and the collector need not look at it.
gc.collect()
gc.freeze()
frames.table([int(word) for word in sys.argv[1:]] or [100, 300, 1000])
outside.table()
resting.table()
capacity.table()
crowd.table()
joints.table()
rewinding.table()
pages.table()
chromium_page.table()
picture.table()
recording_page.table()
startup.table()
