# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The services and the action below `~/simulation/`: types, and when their calls are done."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from physsim_ros.model.errors import Refusal, UnknownBody
from physsim_ros.model.snapshot import Answer
from physsim_ros.ros.requests.reply_pacer import SERVICE_QOS
from physsim_ros.ros.requests.services import ServiceCalls
from physsim_ros.ros.simulation_services.entities import Entities
from physsim_ros.ros.simulation_services.results import Failed
from physsim_ros.ros.simulation_services.time_and_worlds import TimeAndWorlds
from physsim_ros.simulation.request_handler import Wait
from physsim_ros.sketchpad import WorldControl
from rclpy.action import ActionServer
from rclpy.node import Node
from rclpy.task import Future
from simulation_interfaces import srv
from simulation_interfaces.action import SimulateSteps
from simulation_interfaces.msg import Result

# Fills in the response to a request, and returns a message about what was done.
_Perform = Callable[[Any, Any], str]


class SimulationServices:
    """
    The services of `simulation_interfaces`, below `~/simulation/`.

    :param node: that offers them
    :param control: what they do to the node
    :param calls: of services
    """

    def __init__(self, node: Node, control: WorldControl, calls: ServiceCalls) -> None:
        self._control = control
        self._calls = calls
        entities, self._time = Entities(control), TimeAndWorlds(control)
        time = self._time
        for name, (kind, perform) in {
            'get_simulator_features': (srv.GetSimulatorFeatures, time.features),
            'get_spawnables': (srv.GetSpawnables, entities.spawnables),
            'spawn_entity': (srv.SpawnEntity, entities.spawn),
            'delete_entity': (srv.DeleteEntity, entities.delete),
            'get_entity_state': (srv.GetEntityState, entities.state),
            'set_entity_state': (srv.SetEntityState, entities.set_state),
            'get_entities': (srv.GetEntities, entities.names),
            'get_entities_states': (srv.GetEntitiesStates, entities.states),
            'get_entity_info': (srv.GetEntityInfo, entities.info),
            'get_entity_bounds': (srv.GetEntityBounds, entities.bounds),
            'get_simulation_state': (srv.GetSimulationState, time.state),
            'set_simulation_state': (srv.SetSimulationState, time.set_state),
            'step_simulation': (srv.StepSimulation, time.step),
            'reset_simulation': (srv.ResetSimulation, time.reset),
            'get_available_worlds': (srv.GetAvailableWorlds, time.worlds),
            'load_world': (srv.LoadWorld, time.load),
            'get_current_world': (srv.GetCurrentWorld, time.current_world),
        }.items():
            self._create(node, f'~/simulation/{name}', kind, perform)
        ActionServer(node, SimulateSteps, '~/simulation/simulate_steps', self._simulate_steps)

    def _create(self, node: Node, topic: str, kind: Any, perform: _Perform) -> None:
        def callback(request: Any, response: Any) -> Future:
            fill = partial(self._fill, topic, perform, request, response)
            return self._calls.add(topic, response, fill, Wait.FOR_SEEK)

        service = node.create_service(kind, topic, callback, qos_profile=SERVICE_QOS)
        self._calls.delay_replies(service)

    def _fill(
        self,
        topic: str,
        perform: _Perform,
        request: Any,
        response: Any,
        refused: Refusal | None,
    ) -> list[Answer]:
        """Fill in a response, and return the answer; what only reads has none."""
        # Of all but one service.
        result = getattr(response, 'result', Result())
        try:
            if refused is not None:
                raise refused
            message = perform(request, response)
        except Failed as failure:
            refusal, result.result = failure.refusal, failure.result
        except UnknownBody as error:
            refusal, result.result = error, Result.RESULT_NOT_FOUND
        except Refusal as error:
            refusal, result.result = error, Result.RESULT_OPERATION_FAILED
        else:
            result.result = Result.RESULT_OK
            if not message:
                return []
            self._control.note_change()
            return [Answer(topic=topic, message=message)]
        result.error_message = str(refusal)
        return [Answer.refused(refusal, topic=topic)]

    def _simulate_steps(self, goal: Any) -> SimulateSteps.Result:
        """Advance a paused world by frames, and tell each."""
        response = SimulateSteps.Result()

        def perform(request: Any, _: Any) -> str:
            self._time.check_steps(request.steps)
            message = ''
            for done in range(1, request.steps + 1):
                message = self._time.step_once()
                goal.publish_feedback(
                    SimulateSteps.Feedback(
                        completed_steps=done, remaining_steps=request.steps - done
                    )
                )
            return message

        topic = '~/simulation/simulate_steps'
        fill = partial(self._fill, topic, perform, goal.request, response)
        for answer in self._calls.fill(topic, fill):
            self._control.simulation.requests.tell(answer)
        if response.result.result == Result.RESULT_OK:
            goal.succeed()
        else:
            goal.abort()
        return response
