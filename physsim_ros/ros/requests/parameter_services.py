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

from physsim_ros.model.checks import shown
from physsim_ros.model.errors import BadProperty, Malformed, Refusal, UnknownProperty
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Answer
from physsim_ros.model.texts import abbreviated, message_text, nearest_name
from physsim_ros.ros.parameters import SPECS
from physsim_ros.ros.parameters.table import Type
from physsim_ros.ros.requests.services import ServiceCalls
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
from rclpy.parameter_service import ParameterService
from rclpy.task import Future

_TOPIC = '~/set_parameters'
_TYPES = {each.value for each in Type}
# Parameters that a call may be about: twice as many as there are. To set one takes 1.3 ms.
MOST_PARAMETERS = 100
_READING = (DescribeParameters, GetParameters, GetParameterTypes, ListParameters)


class ParameterServices(ParameterService):
    """
    The parameter services of a node, which set in the order of messages and requests.

    rclpy.parameter_service.ParameterService of ROS 2 Jazzy raises on a type of value that it does
    not know, which ends the node; such a value is refused here.

    :param node: whose parameters are set
    :param calls: of its services
    """

    def __init__(self, node: Node, calls: ServiceCalls) -> None:
        super().__init__(node)
        self._calls = calls
        for service in node.services:
            if service.srv_type in (SetParameters, SetParametersAtomically):
                calls.reply_when_done(service)
            elif service.srv_type in _READING:
                service.callback = partial(_read_bounded, service.callback)

    def _set_parameters_callback(
        self, request: SetParameters.Request, response: SetParameters.Response
    ) -> Future:
        return self._add_call(super()._set_parameters_callback, request, response)

    def _set_parameters_atomically_callback(
        self,
        request: SetParametersAtomically.Request,
        response: SetParametersAtomically.Response,
    ) -> Future:
        return self._add_call(super()._set_parameters_atomically_callback, request, response)

    def _add_call(
        self, set_parameters: Callable[..., object], request: Any, response: Any
    ) -> Future:
        """Set parameters in the turn of the call; return the future of the response."""
        messages: Sequence[ParameterMessage] = request.parameters
        too_many = len(messages) > MOST_PARAMETERS

        def fill(refusal: Refusal | None) -> list[Answer]:
            if too_many:
                refusal = Malformed(f'a call sets at most {MOST_PARAMETERS} parameters')
            if refusal is None:
                set_parameters(request, response)
                results = _results_of(response, len(messages))
                return [self._answer(*each) for each in zip(messages, results, strict=True)]
            result = SetParametersResult(successful=False, reason=f'{refusal.code}: {refusal}')
            if isinstance(response, SetParameters.Response):
                response.results = [result] * len(messages)
            else:
                response.result = result
            return [Answer.refused(refusal, topic=_TOPIC)]

        _replace_unknown_types(messages)
        changes_world = any(each.name in WorldSettings.FIELDS for each in messages)
        wait = Wait.FOR_SEEK if changes_world and not too_many else Wait.BEHIND_REQUESTS
        return self._calls.add(_TOPIC, response, fill, wait)

    def _answer(self, message: ParameterMessage, result: SetParametersResult) -> Answer:
        """Return the result for one parameter as an answer, whose message is its reason, too."""
        name = message.name
        if result.successful:
            result.reason = f'{name} is {shown(self._get_node().get_parameter(name).value)}'
            return Answer(topic=_TOPIC, message=result.reason)
        if not self._get_node().has_parameter(name):
            # rclpy 7.1 does not name the parameter that it refuses.
            nearest = nearest_name(abbreviated(name), SPECS)
            result.reason = f'there is no parameter {shown(name)}{nearest}'
        result.reason = message_text(result.reason)
        code, separator, reason = result.reason.partition(': ')
        if not separator or not code.isidentifier():
            # A refusal by rclpy: there is no such parameter, or it is read-only.
            code = BadProperty.code if name in SPECS else UnknownProperty.code
            reason = result.reason
        return Answer(topic=_TOPIC, message=reason, code=code, field=abbreviated(name))


def _read_bounded(read: Callable[[Any, Any], Any], request: Any, response: Any) -> Any:
    """Read parameters; leave the response about too many empty, as that about an unknown one."""
    names = request.prefixes if isinstance(request, ListParameters.Request) else request.names
    return response if len(names) > MOST_PARAMETERS else read(request, response)


def _results_of(response: Any, count: int) -> Sequence[SetParametersResult]:
    """Return the result for each of the parameters of a call."""
    if isinstance(response, SetParameters.Response):
        results: Sequence[SetParametersResult] = response.results
        return results
    return [response.result] * count


def _replace_unknown_types(messages: Iterable[ParameterMessage]) -> None:
    """Replace the types of values that are unknown by NOT_SET, which is refused."""
    for message in messages:
        if message.value.type not in _TYPES:
            message.value.type = Type.NOT_SET.value
