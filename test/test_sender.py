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

"""What is handed over goes out in order, in a thread of its own, and no faster than it can."""

from __future__ import annotations

from collections.abc import Iterator
import threading

from physsim_ros.sender import MOST_WAITING, Sender
import pytest

PATIENCE = 20.0


@pytest.fixture
def sender() -> Iterator[Sender]:
    sender = Sender()
    yield sender
    sender.close()


def test_things_go_out_in_the_order_in_which_they_were_handed_over(sender: Sender) -> None:
    out: list[int] = []
    for number in range(1000):
        sender.send(out.append, number)
    sender.flush()
    assert out == list(range(1000))


def test_who_hands_over_does_not_wait_for_the_first(sender: Sender) -> None:
    gate, out = threading.Event(), list[int]()
    sender.send(lambda: out.append(gate.wait(PATIENCE)))
    assert out == []
    gate.set()
    sender.flush()
    assert out == [True]


def test_who_is_too_fast_waits(sender: Sender) -> None:
    gate, handed = threading.Event(), list[int]()

    def hand_over() -> None:
        for number in range(MOST_WAITING + 2):
            sender.send(gate.wait, PATIENCE)
            handed.append(number)

    thread = threading.Thread(target=hand_over)
    thread.start()
    # It cannot get further, however long one looks.
    thread.join(0.2)
    assert len(handed) <= MOST_WAITING
    gate.set()
    thread.join(PATIENCE)
    assert len(handed) == MOST_WAITING + 2


def test_what_fails_is_loud(sender: Sender) -> None:
    def fail() -> None:
        raise LookupError('a bug')

    sender.send(fail)
    with pytest.raises(LookupError, match='a bug'):
        sender.flush()


def test_closing_does_what_waits() -> None:
    sender, out = Sender(), list[int]()
    for number in range(MOST_WAITING):
        sender.send(out.append, number)
    sender.close()
    assert out == list(range(MOST_WAITING))
