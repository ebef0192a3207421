# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
State and time of the simulation, by the services of `simulation_interfaces`.

Stopped is paused at time 0, where nobody has paused it; a step is a frame, as that of `~/step`. A
world is loaded within one call, so that no state is that of loading.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.requests import DeleteBodies
from physsim_ros.ros.node_control import NodeControl
from physsim_ros.ros.simulation_services.results import coded
from physsim_ros.ros.simulation_services.worlds import Worlds
from physsim_ros.runtime.slices import end_slice
from simulation_interfaces.msg import Result, SimulationState, SimulatorFeatures
from simulation_interfaces.srv import ResetSimulation, SetSimulationState

# Frames of one call: ten seconds of simulation time at 60 Hz. Meanwhile requests wait.
MOST_STEPS = 600
_STOPPED, _PLAYING, _PAUSED, _QUITTING, _NO_WORLD = (
    SimulationState.STATE_STOPPED,
    SimulationState.STATE_PLAYING,
    SimulationState.STATE_PAUSED,
    SimulationState.STATE_QUITTING,
    SimulationState.STATE_NO_WORLD,
)
_STATE, _SPAWNED = ResetSimulation.Request.SCOPE_STATE, ResetSimulation.Request.SCOPE_SPAWNED
# All scopes one by one are all.
_ALL = (
    ResetSimulation.Request.SCOPE_DEFAULT,
    ResetSimulation.Request.SCOPE_ALL,
    ResetSimulation.Request.SCOPE_TIME | _STATE | _SPAWNED,
)
_FEATURES = (
    'SPAWNING', 'DELETING', 'NAMED_POSES', 'POSE_BOUNDS', 'ENTITY_TAGS', 'ENTITY_BOUNDS',
    'ENTITY_BOUNDS_BOX', 'ENTITY_CATEGORIES', 'SPAWNING_RESOURCE_STRING', 'ENTITY_STATE_GETTING',
    'ENTITY_STATE_SETTING', 'ENTITY_INFO_GETTING', 'ENTITY_INFO_SETTING', 'SPAWNABLES',
    'SIMULATION_RESET', 'SIMULATION_RESET_SPAWNED', 'SIMULATION_STATE_GETTING',
    'SIMULATION_STATE_SETTING', 'SIMULATION_STATE_PAUSE', 'STEP_SIMULATION_SINGLE',
    'STEP_SIMULATION_MULTIPLE', 'STEP_SIMULATION_ACTION', 'WORLD_LOADING', 'WORLD_TAGS',
    'WORLD_UNLOADING', 'WORLD_INFO_GETTING', 'AVAILABLE_WORLDS', 'SPAWNING_ENTITIES',
)  # fmt: skip


class SimulationStates:
    """
    The services for state and time; each returns a message about what was done, '' for nothing.

    :param control: of the node
    :param worlds: of the services
    """

    def __init__(self, control: NodeControl, worlds: Worlds) -> None:
        self._control = control
        self._worlds = worlds
        self._quits = False
        # The world that was paused while it was stopped, and how often time had begun to run then.
        self._begins_paused: tuple[WorldState | None, int] = None, 0

    def features(self, _: Any, response: Any) -> str:
        """Tell what of the standard there is."""
        response.features = SimulatorFeatures(
            features=[getattr(SimulatorFeatures, name) for name in _FEATURES],
            spawn_formats=['yaml'],
            custom_info='physsim: resource_string is a body of a world file, in YAML',
        )
        return ''

    def state(self, _: Any, response: Any) -> str:
        """Tell whether time runs."""
        response.state.state = self._state
        return ''

    async def set_state(self, request: Any, _: Any) -> str:
        """Play, pause, stop (pause and reset), or end the program."""
        target, now = request.state.state, self._state
        codes = SetSimulationState.Response
        if target not in (_STOPPED, _PLAYING, _PAUSED, _QUITTING):
            raise coded(
                f'state {target} cannot be set; stopped, playing, paused and quitting can',
                Result.RESULT_FEATURE_UNSUPPORTED,
                field='state',
            )
        if target == now:
            raise coded('it is in that state already', codes.ALREADY_IN_TARGET_STATE)
        if target == _QUITTING:
            return self._quit()
        if now in (_NO_WORLD, _QUITTING):
            reason = 'no world is loaded' if now == _NO_WORLD else 'the program ends'
            raise coded(reason, codes.INCORRECT_TRANSITION)
        begins_paused = (now, target) == (_STOPPED, _PAUSED)
        simulation = self._control.simulation
        self._begins_paused = (
            simulation.loaded if begins_paused else None,
            simulation.playback.starts,
        )
        if target == _PLAYING:
            return self._control.time.play()
        message = self._control.time.pause()
        return await self._control.time.reset() if target == _STOPPED else message

    def _quit(self) -> str:
        if not self._control.end_program():
            raise coded(
                'this world is not the only one of its program, or is in a test',
                Result.RESULT_FEATURE_UNSUPPORTED,
                field='state',
            )
        self._quits = True
        self._control.time.pause()
        return 'the program ends'

    async def step(
        self, request: Any, _: Any, on_frame: Callable[[int], object] = lambda _: None
    ) -> str:
        """
        Advance a paused world by frames, a slice each.

        :param on_frame: called after each with the count of frames up to it
        """
        self._check_steps(request.steps)
        message = ''
        for count in range(1, request.steps + 1):
            if count > 1:
                await end_slice()
            message = self._control.time.step_now()
            on_frame(count)
        return message

    def _check_steps(self, steps: int) -> None:
        """
        Refuse a number of steps.

        :raises CodedRefusal: time runs, no world is loaded, or they are none or too many
        """
        self._worlds.check_loaded()
        if self._control.simulation.speed != 0:
            raise coded('time is running; pause first', Result.RESULT_OPERATION_FAILED)
        if not 1 <= steps <= MOST_STEPS:
            raise coded(
                f'steps is {steps}; a call has 1 to {MOST_STEPS}',
                Result.RESULT_OPERATION_FAILED,
                field='steps',
            )

    async def reset(self, request: Any, _: Any) -> str:
        """Go to the beginning, or restore some of it at the time that is shown."""
        self._worlds.check_loaded()
        scope = request.scope
        if scope in _ALL:
            self._begins_paused = None, 0
            return await self._control.time.reset()
        simulation = self._control.simulation
        loaded = simulation.loaded
        if scope == _STATE | _SPAWNED:
            return simulation.load(await self._control.time.beginning())
        if scope == _SPAWNED:
            known = {each.body.name for each in loaded.bodies}
            scene = self._control.loop.bring_up_to_date().scene
            spawned = tuple(name for name in scene.names if name not in known)
            return (
                simulation.perform(DeleteBodies(names=spawned)) if spawned else 'none was spawned'
            )
        raise coded(
            'the scope is all, what was spawned, or state and what was spawned',
            Result.RESULT_FEATURE_UNSUPPORTED,
            field='scope',
        )

    @property
    def _state(self) -> int:
        if self._quits:
            return int(_QUITTING)
        if self._worlds.is_none_loaded:
            return int(_NO_WORLD)
        simulation = self._control.simulation
        if simulation.speed != 0:
            return int(_PLAYING)
        world, starts = self._begins_paused
        begins_paused = world is simulation.loaded and starts == simulation.playback.starts
        return int(_PAUSED if simulation.step or begins_paused else _STOPPED)
