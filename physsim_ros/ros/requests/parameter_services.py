# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The parameter services of the node, whose results are answers, too.

Law: a call takes no longer than a message may. rclpy reads 100,000 parameters in 8 s, during which
the node does nothing else.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any

from physsim_ros.model.answer import Answer
from physsim_ros.model.checks import shown
from physsim_ros.model.errors import Malformed, Refusal
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.texts import abbreviated, message_text
from physsim_ros.model.translation import Text
from physsim_ros.ros.live_parameters import LiveParameters
from physsim_ros.ros.parameters.table import Type
from physsim_ros.ros.requests.services import Call, ServiceCalls
from physsim_ros.simulation.entries import Wait
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_service import ParameterService
from rclpy.task import Future

_TOPIC = '~/set_parameters'
_TYPES = {each.value for each in Type}
# Parameters that a call may be about: twice as many as there are. To set one takes 1.3 ms.
MOST_PARAMETERS = 100
# Parameters whose effect needs the world at the moment that is shown.
_OF_WORLD = {*WorldSettings.FIELDS, 'history'}
_READING = (DescribeParameters, GetParameters, GetParameterTypes, ListParameters)


class ParameterServices(ParameterService):
    """
    The parameter services of a node, which set in the order of messages and requests.

    rclpy.parameter_service.ParameterService of ROS 2 Jazzy raises on a type of value that it does
    not know, which ends the node; such a value is refused here.

    :param node: whose parameters are set
    :param live: its parameters
    :param calls: of its services
    """

    def __init__(self, node: Node, live: LiveParameters, calls: ServiceCalls) -> None:
        super().__init__(node)
        self._live = live
        self._calls = calls
        for service in node.services:
            if service.srv_type in (SetParameters, SetParametersAtomically):
                calls.reply_when_done(service)
            elif service.srv_type in _READING:
                service.callback = partial(_read_bounded, service.callback)

    def _set_parameters_callback(
        self, request: SetParameters.Request, response: SetParameters.Response
    ) -> Future:
        return self._add_call(request, response, [[each] for each in request.parameters])

    def _set_parameters_atomically_callback(
        self,
        request: SetParametersAtomically.Request,
        response: SetParametersAtomically.Response,
    ) -> Future:
        return self._add_call(request, response, [request.parameters])

    def _add_call(
        self, request: Any, response: Any, groups: Sequence[Sequence[ParameterMessage]]
    ) -> Future:
        """Set groups of parameters in the turn of the call; return the future of the response."""
        messages: Sequence[ParameterMessage] = request.parameters
        too_many = len(messages) > MOST_PARAMETERS

        def respond(results: Sequence[SetParametersResult]) -> None:
            if isinstance(response, SetParameters.Response):
                response.results = results
            else:
                (response.result,) = results

        def perform() -> list[Answer]:
            if too_many:
                raise Malformed('a call sets at most {most} parameters', most=MOST_PARAMETERS)
            told = [self._set_together(each) for each in groups]
            respond([result for result, _ in told])
            return [answer for _, answers in told for answer in answers]

        def refuse(refusal: Refusal) -> list[Answer]:
            respond([_refused(refusal)] * len(groups))
            return [Answer.refused(refusal, topic=_TOPIC)]

        _replace_unknown_types(messages)
        needs_world = any(each.name in _OF_WORLD for each in messages)
        wait = Wait.FOR_SEEK if needs_world and not too_many else Wait.BEHIND_REQUESTS
        return self._calls.add(Call(_TOPIC, response, perform, refuse, wait))

    def _set_together(
        self, messages: Sequence[ParameterMessage]
    ) -> tuple[SetParametersResult, list[Answer]]:
        """Set parameters, all or none; return the result, and the answers about it."""
        try:
            self._live.set_together(map(Parameter.from_parameter_msg, messages))
        except Refusal as refusal:
            # A refusal that names no field is about the only parameter.
            field = abbreviated(messages[0].name) if len(messages) == 1 else ''
            return _refused(refusal), [Answer.refused(refusal, topic=_TOPIC, field=field)]
        node = self._get_node()
        # A name that is given twice is told once.
        names = dict.fromkeys(each.name for each in messages)
        told = [
            Text('{name} is {value}', name=name, value=shown(node.get_parameter(name).value))
            for name in names
        ]
        result = SetParametersResult(successful=True, reason=message_text(', '.join(told)))
        return result, [Answer(topic=_TOPIC, message=each) for each in told]


def _refused(refusal: Refusal) -> SetParametersResult:
    return SetParametersResult(successful=False, reason=f'{refusal.code}: {refusal}')


def _read_bounded(read: Callable[[Any, Any], Any], request: Any, response: Any) -> Any:
    """Read parameters; leave the response about too many empty, as that about an unknown one."""
    names = request.prefixes if isinstance(request, ListParameters.Request) else request.names
    return response if len(names) > MOST_PARAMETERS else read(request, response)


def _replace_unknown_types(messages: Iterable[ParameterMessage]) -> None:
    """Replace the types of values that are unknown by NOT_SET, which is refused."""
    for message in messages:
        if message.value.type not in _TYPES:
            message.value.type = Type.NOT_SET.value
