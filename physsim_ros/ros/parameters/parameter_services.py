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

"""The parameter services of the node, whose results are answers, too."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from physsim_ros.model.checks import shown
from physsim_ros.model.errors import BadProperty, UnknownProperty
from physsim_ros.model.snapshot import Answer
from physsim_ros.model.texts import abbreviated, message_text, nearest_name
from physsim_ros.ros.parameters.spec import Type
from physsim_ros.ros.parameters.table import SPECS
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter_service import ParameterService

_TYPES = {each.value for each in Type}


class ParameterServices(ParameterService):
    """
    The parameter services of a node, whose results are answers, too.

    rclpy.parameter_service.ParameterService of ROS 2 Jazzy raises on a type of value that it does
    not know, which ends the node; such a value is refused here.

    :param node: whose parameters are set
    :param tell: called with the answer to each parameter that is set or refused
    """

    def __init__(self, node: Node, tell: Callable[[Answer], None]) -> None:
        super().__init__(node)
        self._tell = tell

    def _set_parameters_callback(
        self, request: SetParameters.Request, response: SetParameters.Response
    ) -> SetParameters.Response:
        _replace_unknown_types(request.parameters)
        response = super()._set_parameters_callback(request, response)
        for parameter, result in zip(request.parameters, response.results, strict=True):
            self._tell_result(parameter.name, result)
        return response

    def _set_parameters_atomically_callback(
        self,
        request: SetParametersAtomically.Request,
        response: SetParametersAtomically.Response,
    ) -> SetParametersAtomically.Response:
        _replace_unknown_types(request.parameters)
        response = super()._set_parameters_atomically_callback(request, response)
        for parameter in request.parameters:
            self._tell_result(parameter.name, response.result)
        return response

    def _tell_result(self, name: str, result: SetParametersResult) -> None:
        """Answer with the result for one parameter, whose reason becomes the message."""
        topic = '~/set_parameters'
        if result.successful:
            result.reason = f'{name} is {shown(self._get_node().get_parameter(name).value)}'
            self._tell(Answer(topic=topic, message=result.reason))
            return
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
        answer = Answer(topic=topic, message=reason, code=code, field=abbreviated(name))
        self._tell(answer)


def _replace_unknown_types(messages: Iterable[ParameterMessage]) -> None:
    """Replace the types of values that are unknown by NOT_SET, which is refused."""
    for message in messages:
        if message.value.type not in _TYPES:
            message.value.type = Type.NOT_SET.value
