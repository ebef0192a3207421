# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The parameter services of the node, whose results are answers, too."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from physsim_ros.model.checks import shown
from physsim_ros.model.errors import BadProperty, Busy, UnknownProperty
from physsim_ros.model.snapshot import Answer
from physsim_ros.model.texts import abbreviated, message_text, nearest_name
from physsim_ros.ros.parameters import is_world_setting, SPECS
from physsim_ros.ros.parameters.table import Type
from physsim_ros.ros.requests.services import Fill, ServiceCalls
from physsim_ros.simulation.request_handler import Wait
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter_service import ParameterService
from rclpy.task import Future

_TYPES = {each.value for each in Type}


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
                calls.delay_replies(service)

    def _set_parameters_callback(
        self, request: SetParameters.Request, response: SetParameters.Response
    ) -> Future:
        set_each = super()._set_parameters_callback

        def fill(refusal: Busy | None) -> list[Answer]:
            if refusal is None:
                set_each(request, response)
            else:
                response.results = [_refused(refusal) for _ in request.parameters]
            return self._answers(request.parameters, response.results)

        return self._add_call(request.parameters, response, fill)

    def _set_parameters_atomically_callback(
        self,
        request: SetParametersAtomically.Request,
        response: SetParametersAtomically.Response,
    ) -> Future:
        set_all = super()._set_parameters_atomically_callback

        def fill(refusal: Busy | None) -> list[Answer]:
            if refusal is None:
                set_all(request, response)
            else:
                response.result = _refused(refusal)
            results = [response.result] * len(request.parameters)
            return self._answers(request.parameters, results)

        return self._add_call(request.parameters, response, fill)

    def _add_call(self, messages: Sequence[ParameterMessage], response: Any, fill: Fill) -> Future:
        _replace_unknown_types(messages)
        changes_world = any(is_world_setting(each.name) for each in messages)
        wait = Wait.FOR_SEEK if changes_world else Wait.BEHIND_REQUESTS
        return self._calls.add(response, fill, wait)

    def _answers(
        self, messages: Iterable[ParameterMessage], results: Iterable[SetParametersResult]
    ) -> list[Answer]:
        return [
            self._answer(message.name, result)
            for message, result in zip(messages, results, strict=True)
        ]

    def _answer(self, name: str, result: SetParametersResult) -> Answer:
        """Return the result for one parameter as an answer, whose message is its reason, too."""
        topic = '~/set_parameters'
        if result.successful:
            result.reason = f'{name} is {shown(self._get_node().get_parameter(name).value)}'
            return Answer(topic=topic, message=result.reason)
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
        return Answer(topic=topic, message=reason, code=code, field=abbreviated(name))


def _refused(refusal: Busy) -> SetParametersResult:
    return SetParametersResult(successful=False, reason=f'{refusal.code}: {refusal}')


def _replace_unknown_types(messages: Iterable[ParameterMessage]) -> None:
    """Replace the types of values that are unknown by NOT_SET, which is refused."""
    for message in messages:
        if message.value.type not in _TYPES:
            message.value.type = Type.NOT_SET.value
