# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Stops the process of the world for a while, and reads how much simulation time that took."""

from __future__ import annotations

import os
import signal
import sys
import time

from rosgraph_msgs.msg import Clock
from visitor import Visitor

STOPPED, AFTER = 5.0, 1.0


def main(process: int) -> None:
    visitor = Visitor()
    times: list[float] = []
    clock = visitor.listen(Clock, '/clock')

    def newest() -> float:
        return float(clock[-1].clock.sec + clock[-1].clock.nanosec / 1e9)

    visitor.spin_until(lambda: clock, 'the clock')
    for signal_number, seconds in ((signal.SIGSTOP, STOPPED), (signal.SIGCONT, AFTER)):
        os.kill(process, signal_number)
        times.append(newest())
        until = time.monotonic() + seconds
        visitor.spin_until(lambda until=until: time.monotonic() > until, 'the wait')
    # A busy machine may have this process wait longer than that.
    visitor.finish(passed=newest() - times[0], read=time.monotonic() - until + AFTER)


if __name__ == '__main__':
    main(int(sys.argv[1]))
