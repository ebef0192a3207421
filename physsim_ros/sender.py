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

"""
What goes out, in a thread of its own: while a frame is sent, the engine makes the next.

Laws: things go out in the order in which they were handed over; who hands over faster than they go
out has to wait; what fails in the thread fails for who hands over next.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

# What may wait to go out: a frame, and what was said beside it.
MOST_WAITING = 4


class Sender:
    """A thread that does one thing after the other."""

    def __init__(self) -> None:
        self._pool = ThreadPoolExecutor(1, thread_name_prefix='sender')
        self._waiting: deque[Future[None]] = deque()

    def send(self, act: Callable[..., None], *arguments: Any) -> None:
        """Have something done soon, after all that was asked for before."""
        self._waiting.append(self._pool.submit(act, *arguments))
        while len(self._waiting) > MOST_WAITING:
            self._waiting.popleft().result()

    def flush(self) -> None:
        """Wait until all is done."""
        while self._waiting:
            self._waiting.popleft().result()

    def close(self) -> None:
        """Do what waits, and end."""
        self._pool.shutdown()
