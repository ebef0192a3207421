# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The services and the action below `~/simulation/`: types, and when their calls are done."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Refusal
from physsim_ros.model.translation import verbatim
from physsim_ros.ros.node_control import NodeControl
from physsim_ros.ros.requests.services import Call, ServiceCalls
from physsim_ros.ros.simulation_services.entities import Entities
from physsim_ros.ros.simulation_services.named_poses import NamedPoses
from physsim_ros.ros.simulation_services.results import result_of
from physsim_ros.ros.simulation_services.simulation_states import SimulationStates
from physsim_ros.ros.simulation_services.spawning import Spawning
from physsim_ros.ros.simulation_services.worlds import Worlds
from physsim_ros.ros.topics import CALLS
from physsim_ros.runtime.slices import in_slices, Slices
from physsim_ros.simulation.entries import Wait
from rclpy.action import ActionServer
from rclpy.action.server import ServerGoalHandle
from rclpy.node import Node
from rclpy.task import Future
from simulation_interfaces import srv
from simulation_interfaces.action import SimulateSteps
from simulation_interfaces.msg import Result

# Fills in the response to a request, and returns a message about what was done.
_Perform = Callable[[Any, Any], str | Slices[str]]
# The action.
_STEPS = '~/simulation/simulate_steps'


class SimulationServices:
    """
    The services of `simulation_interfaces`, below `~/simulation/`.

    :param node: that offers them
    :param control: what they do to the node
    :param calls: of services
    """

    def __init__(self, node: Node, control: NodeControl, calls: ServiceCalls) -> None:
        self._control = control
        self._calls = calls
        entities, places, worlds = Entities(control), NamedPoses(control), Worlds(control)
        spawning = Spawning(control, worlds)
        self._states = states = SimulationStates(control, worlds)
        services: dict[str, tuple[Any, _Perform]] = {
            'get_simulator_features': (srv.GetSimulatorFeatures, states.features),
            'get_spawnables': (srv.GetSpawnables, spawning.spawnables),
            'spawn_entity': (srv.SpawnEntity, spawning.spawn),
            'spawn_entities': (srv.SpawnEntities, spawning.spawn_many),
            'delete_entity': (srv.DeleteEntity, entities.delete),
            'get_entity_state': (srv.GetEntityState, entities.state),
            'set_entity_state': (srv.SetEntityState, entities.set_state),
            'get_entities': (srv.GetEntities, entities.names),
            'get_entities_states': (srv.GetEntitiesStates, entities.states),
            'get_entity_info': (srv.GetEntityInfo, entities.info),
            'set_entity_info': (srv.SetEntityInfo, entities.set_info),
            'get_entity_bounds': (srv.GetEntityBounds, entities.bounds),
            'get_named_poses': (srv.GetNamedPoses, places.poses),
            'get_named_pose_bounds': (srv.GetNamedPoseBounds, places.bounds),
            'get_simulation_state': (srv.GetSimulationState, states.state),
            'set_simulation_state': (srv.SetSimulationState, states.set_state),
            'step_simulation': (srv.StepSimulation, states.step),
            'reset_simulation': (srv.ResetSimulation, states.reset),
            'get_available_worlds': (srv.GetAvailableWorlds, worlds.available),
            'load_world': (srv.LoadWorld, worlds.load),
            'unload_world': (srv.UnloadWorld, worlds.unload),
            'get_current_world': (srv.GetCurrentWorld, worlds.current),
        }
        for name, (kind, perform) in services.items():
            self._create(node, f'~/simulation/{name}', kind, perform)
        self._action = ActionServer(
            node,
            SimulateSteps,
            _STEPS,
            execute_callback=lambda _: None,
            handle_accepted_callback=self._simulate_steps,
            goal_service_qos_profile=CALLS,
            result_service_qos_profile=CALLS,
            cancel_service_qos_profile=CALLS,
            # All feedback of a goal may come in one burst.
            feedback_pub_qos_profile=CALLS,
        )

    def close(self) -> None:
        """Destroy the action, whose node else remains on the graph (rclpy 7.1)."""
        self._action.destroy()

    def _create(self, node: Node, topic: str, kind: Any, perform: _Perform) -> None:
        self._calls.create(node, kind, topic, partial(self._add, topic, perform))

    def _add(self, topic: str, perform: _Perform, request: Any, response: Any) -> Future:
        """Add a call, and return the future of its response; what only reads has no answer."""
        # Of all but one service.
        result = getattr(response, 'result', Result())

        async def carry_out() -> Sequence[Answer]:
            message = await in_slices(partial(perform, request, response))
            result.result = Result.RESULT_OK
            if not message:
                return []
            self._control.note_change()
            return [Answer(topic=topic, message=verbatim(message))]

        def refuse(refusal: Refusal) -> Sequence[Answer]:
            result.result, result.error_message = result_of(refusal), str(refusal)
            return [Answer.refused(refusal, topic=topic)]

        return self._calls.add(Call(topic, response, carry_out, refuse, Wait.FOR_SEEK))

    def _simulate_steps(self, goal: ServerGoalHandle) -> None:
        """Advance a paused world by frames, in the turn of the goal, and tell each."""
        response, steps = SimulateSteps.Result(), goal.request.steps

        def tell(count: int) -> None:
            goal.publish_feedback(
                SimulateSteps.Feedback(completed_steps=count, remaining_steps=steps - count)
            )

        def end(_: object) -> SimulateSteps.Result:
            if response.result.result == Result.RESULT_OK:
                goal.succeed()
            else:
                goal.abort()
            return response

        perform = partial(self._states.step, on_frame=tell)
        done = self._add(_STEPS, perform, goal.request, response)

        def execute(_: Future) -> None:
            # Of what a callback of a future raises, rclpy 7.1 only warns.
            with self._control.boundary.containing(_STEPS):
                goal.execute(end)

        # A callback that waits is a task, which rclpy 7.1 asks at each spin.
        done.add_done_callback(execute)
