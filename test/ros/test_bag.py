# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bags (MCAP, as of rosbag2) with the topics of a world: Rerun opens them, worlds replay them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
import sys

from geometry_msgs.msg import PoseArray
from physsim_ros.testing import box, disc, PhysSim
import pytest
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import Marker, MarkerArray

from ..client import Client
from ..outside import PATIENCE
from ..rerun_program import rerun

mcap_writer = pytest.importorskip('mcap.writer', reason='mcap is not installed')
mcap_reader = pytest.importorskip('mcap.reader')
chunk = pytest.importorskip('rerun.chunk')

TOPICS = {
    '~/spawn': Marker,
    '~/poses': PoseArray,
    '~/states': MultiDOFJointState,
    '~/markers': MarkerArray,
    '/clock': Clock,
}
# Between the definitions of the types that a message is made of.
SEPARATOR = '=' * 80


def definition(name: str) -> str:
    """Return the definition of a message `package/Type` with all that it is made of."""
    texts: dict[str, str] = {}
    waiting = [name]
    while waiting:
        package, kind = waiting.pop().split('/')
        if f'{package}/{kind}' in texts:
            continue
        text = Path(sys.prefix, 'share', package, 'msg', f'{kind}.msg').read_text(encoding='utf-8')
        texts[f'{package}/{kind}'] = text
        for line in text.splitlines():
            word = line.partition('#')[0].split('[')[0].strip().split(' ')[0]
            if word[:1].isupper():
                waiting.append(f'{package}/{word}')
            elif '/' in word:
                waiting.append(word)
    first, *others = texts
    parts = [texts[first], *(f'{SEPARATOR}\nMSG: {other}\n{texts[other]}' for other in others)]
    return '\n'.join(parts)


class Bag:
    """A bag with all messages of the topics, as rosbag2 writes it: without decoding any."""

    def __init__(self, path: Path, client: Client) -> None:
        self._physsim = client.physsim
        self._file = path.open('wb')
        self._writer = mcap_writer.Writer(self._file)
        self._writer.start(profile='ros2')
        for topic, kind in TOPICS.items():
            name = topic.replace('~', '/physsim')
            package = kind.__module__.partition('.')[0]
            text = definition(f'{package}/{kind.__name__}').encode()
            schema = self._writer.register_schema(
                f'{package}/msg/{kind.__name__}', 'ros2msg', text
            )
            channel = self._writer.register_channel(name, 'cdr', schema)
            subscription = client.node.create_subscription(
                kind, name, lambda data, to=channel: self._write(data, to), client.qos, raw=True
            )
            if topic != '~/spawn':
                client.spin_until(subscription.get_publisher_count)

    def _write(self, data: bytes, channel: int) -> None:
        now = round(self._physsim.time * 1e9)
        self._writer.add_message(channel, now, data, now)

    def close(self) -> Path:
        """Complete the file, and return its path."""
        self._writer.finish()
        self._file.close()
        return Path(self._file.name)


def messages(path: Path, topic: str) -> Iterator[bytes]:
    """Yield the messages of a topic."""
    with path.open('rb') as file:
        for _, _, message in mcap_reader.make_reader(file).iter_messages([topic]):
            yield message.data


@pytest.fixture
def bag(physsim: PhysSim, client: Client, tmp_path: Path) -> Path:
    """Record a second of a ball that falls onto a box."""
    bag = Bag(tmp_path / 'it.mcap', client)
    client.ask('~/spawn', box('box/0', size=(2.0, 0.5), at=(0.0, 0.25)))
    client.ask('~/spawn', disc('ball/0', diameter=0.4, at=(0.1, 2.0)))
    physsim.run(1.0)
    physsim.settle()
    return bag.close()


def test_rerun_opens_a_bag_of_the_topics(bag: Path, tmp_path: Path) -> None:
    path = tmp_path / 'it.rrd'

    assert rerun('mcap', 'convert', bag, '-o', path).wait(PATIENCE) == 0

    rows = {each.entity_path: each.num_rows for each in chunk.RrdReader(path).stream()}
    assert {f'/physsim/{name}' for name in ('spawn', 'poses', 'states', 'markers')} <= rows.keys()
    assert rows['/physsim/poses'] >= 60


def test_spawns_that_are_replayed_from_a_bag_make_the_same_world(
    bag: Path, physsim: PhysSim, client: Client
) -> None:
    before = physsim.digest()
    client.call('~/reset')
    assert physsim.names == ()

    publisher = client.node.create_publisher(Marker, '/physsim/spawn', client.qos)
    client.spin_until(publisher.get_subscription_count)
    answered = len(client.events) + 2
    for message in messages(bag, '/physsim/spawn'):
        publisher.publish(message)
    client.spin_until(lambda: physsim.node.loop.apply_requests() or len(client.events) == answered)
    physsim.run(1.0)

    assert physsim.digest() == before
