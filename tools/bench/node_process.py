# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The installed node as a process, and those that listen to it: this one, and another."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
import os
from pathlib import Path
import signal
import subprocess
import sys
from typing import Any, Self

import psutil
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Trigger

# An installed package has its bytecode: without this variable the first run writes it.
ENVIRONMENT = {key: os.environ[key] for key in os.environ.keys() - {'PYTHONDONTWRITEBYTECODE'}}
# Subscribes to topics as serialised bytes.
_LISTENER = """
from importlib import import_module
import sys
import rclpy
from rclpy.experimental import EventsExecutor
rclpy.init(domain_id=int(sys.argv[1]))
node = rclpy.create_node('listener')
for word in sys.argv[2:]:
    topic, package, name = word.split('=')
    kind = getattr(import_module(f'{package}.msg'), name)
    node.create_subscription(kind, topic, lambda _: None, 5, raw=True)
executor = EventsExecutor()
executor.add_node(node)
executor.spin()
"""


@contextmanager
def executable(domain: int, **parameters: object) -> Iterator[subprocess.Popen[bytes]]:
    """Run the installed node on a domain."""
    given = {'viewer': 'none'} | parameters
    words = [word for name, value in given.items() for word in ('-p', f'{name}:={value}')]
    process = subprocess.Popen(
        [Path(sys.executable).with_name('physsim'), '--ros-args', *words],
        env=ENVIRONMENT | {'ROS_DOMAIN_ID': str(domain)},
        stderr=subprocess.DEVNULL,
    )
    try:
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        process.wait()


@contextmanager
def listening(domain: int, topics: Mapping[str, type]) -> Iterator[None]:
    """Have another process, whose cost is not counted, subscribe to topics of some types."""
    words = [
        f'{topic}={kind.__module__.partition(".")[0]}={kind.__name__}'
        for topic, kind in topics.items()
    ]
    listener = subprocess.Popen([sys.executable, '-c', _LISTENER, str(domain), *words])
    try:
        yield
    finally:
        # Its executor (rclpy 7, Jazzy) does not end by a signal that it handles.
        listener.kill()
        listener.wait()


def cpu_seconds(pid: int) -> float:
    """Return the CPU time that a process and its children have taken [s]."""
    process = psutil.Process(pid)
    all_times = [each.cpu_times() for each in (process, *process.children(recursive=True))]
    ended = all_times[0].children_user + all_times[0].children_system
    return float(sum(each.user + each.system for each in all_times) + ended)


class Remote:
    """
    A node of this process, on the domain of another one.

    :param domain: of both
    """

    def __init__(self, domain: int) -> None:
        self._context = rclpy.Context()
        rclpy.init(context=self._context, domain_id=domain)
        self.node = rclpy.create_node('remote', context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._clock = self.last_of(Clock, '/clock')

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._executor.shutdown()
        self.node.destroy_node()
        self._context.shutdown()

    def spin_until(self, condition: Callable[[], object]) -> None:
        """Spin until something holds."""
        while not condition():
            self._executor.spin_once(timeout_sec=0.05)

    def last_of(self, kind: type, topic: str) -> Callable[[], Any]:
        """Subscribe to a topic; return a function of its last message, None before the first."""
        heard = deque[Any]([None], maxlen=1)

        def hear(message: Any) -> None:
            heard.append(message)

        self.node.create_subscription(kind, topic, hear, 1)
        return lambda: heard[0]

    def now(self) -> float:
        """Return the time of the simulation [s]."""
        message = self._clock()
        return message.clock.sec + message.clock.nanosec * 1e-9 if message else 0.0

    def play(self) -> None:
        """Let the time of the simulation run."""
        client = self.node.create_client(Trigger, '/physsim/play')
        self.spin_until(client.service_is_ready)
        answer = client.call_async(Trigger.Request())
        self.spin_until(answer.done)
