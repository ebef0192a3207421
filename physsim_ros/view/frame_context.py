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

"""Values of the program at a frame, which are not in the frame itself."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class FrameContext:
    """
    Figures of the program at a frame, which the world does not have.

    :param real_time_factor: simulation seconds a second; 0 where nothing paces the world
    :param cost: mean of a frame in the last second, its steps and its publishing [s]; None where
        nothing paces the world
    :param title: of the world, which names the recording; '' for none
    :param traced: names of the bodies whose way and flight are shown
    """

    real_time_factor: float = 0.0
    cost: float | None = None
    title: str = ''
    traced: tuple[str, ...] = ()
