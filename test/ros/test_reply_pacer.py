# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Replies are sent when they are finished, whatever they say, and no others wait for them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.ros.requests.reply_pacer import BURST, ReplyPacer
from rclpy.task import Future
from std_srvs.srv import Empty, Trigger


def test_a_reply_is_sent_when_it_is_finished_even_if_it_says_nothing() -> None:
    sent: list[tuple[object, int]] = []
    node: Any = SimpleNamespace(count_clients=lambda _: 1)
    service: Any = SimpleNamespace(
        srv_name='/physsim/clear',
        send_response=lambda response, header: sent.append((response, header)),
    )
    pacer = ReplyPacer(node, ErrorBoundary())
    pacer.add(service)
    replies = [Future() for _ in range(4)]
    # Finished before the executor asks for it, as where no message waits.
    pacer.finish(replies[0], Empty.Response())
    for header, reply in enumerate(replies):
        service.send_response(reply, header)
    assert sent == [(Empty.Response(), 0)]

    pacer.finish(replies[2], Trigger.Response())
    pacer.finish(replies[1], Trigger.Response(message='deleted 2 bodies'))

    assert [header for _, header in sent] == [0, 2, 1]
    assert sent[1][0] == Trigger.Response()


def test_replies_that_are_paced_keep_the_order_in_which_they_were_finished() -> None:
    sent: list[int] = []
    # Clients that would read for an hour.
    node: Any = SimpleNamespace(count_clients=lambda _: 3_600_000)
    service: Any = SimpleNamespace(
        srv_name='/physsim/pause', send_response=lambda _, header: sent.append(header)
    )
    pacer = ReplyPacer(node, ErrorBoundary())
    pacer.paced = True
    pacer.add(service)
    for header in range(2 * BURST):
        reply = Future()
        service.send_response(reply, header)
        pacer.finish(reply, Trigger.Response())
    begun = list(sent)
    pacer.paced = False
    pacer.flush()
    assert begun == list(range(len(begun)))
    assert BURST <= len(begun) < 2 * BURST
    assert sent == list(range(2 * BURST))
