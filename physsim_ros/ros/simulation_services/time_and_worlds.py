# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Time and worlds, by the services of `simulation_interfaces`.

Stopped is paused at time 0; a step is a frame, as that of `~/step`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from physsim_ros.files import shipped_lessons, shipped_worlds, worlds_in
from physsim_ros.model.errors import BadWorldFile
from physsim_ros.model.requests import DeleteBodies, Restore
from physsim_ros.ros.simulation_services.entities import unknown_sources
from physsim_ros.ros.simulation_services.entity_filters import passes_tags
from physsim_ros.ros.simulation_services.results import Failed, failed
from physsim_ros.sketchpad import WorldControl
from simulation_interfaces.msg import Result, SimulationState, SimulatorFeatures, WorldResource
from simulation_interfaces.srv import LoadWorld, ResetSimulation, SetSimulationState

# Frames of one call: ten seconds of simulation time at 60 Hz. Meanwhile nothing else is done.
MOST_STEPS = 600
_STOPPED, _PLAYING, _PAUSED = (
    SimulationState.STATE_STOPPED,
    SimulationState.STATE_PLAYING,
    SimulationState.STATE_PAUSED,
)
_STATE, _SPAWNED = ResetSimulation.Request.SCOPE_STATE, ResetSimulation.Request.SCOPE_SPAWNED
# All scopes one by one are all.
_ALL = (
    ResetSimulation.Request.SCOPE_DEFAULT,
    ResetSimulation.Request.SCOPE_ALL,
    ResetSimulation.Request.SCOPE_TIME | _STATE | _SPAWNED,
)
FEATURES = [
    getattr(SimulatorFeatures, name)
    for name in (
        'SPAWNING',
        'DELETING',
        'ENTITY_TAGS',
        'ENTITY_BOUNDS',
        'ENTITY_BOUNDS_BOX',
        'ENTITY_CATEGORIES',
        'SPAWNING_RESOURCE_STRING',
        'ENTITY_STATE_GETTING',
        'ENTITY_STATE_SETTING',
        'ENTITY_INFO_GETTING',
        'SPAWNABLES',
        'SIMULATION_RESET',
        'SIMULATION_RESET_SPAWNED',
        'SIMULATION_STATE_GETTING',
        'SIMULATION_STATE_SETTING',
        'SIMULATION_STATE_PAUSE',
        'STEP_SIMULATION_SINGLE',
        'STEP_SIMULATION_MULTIPLE',
        'STEP_SIMULATION_ACTION',
        'WORLD_LOADING',
        'WORLD_TAGS',
        'WORLD_INFO_GETTING',
        'AVAILABLE_WORLDS',
    )
]


class TimeAndWorlds:
    """
    The services for time and worlds; each returns a message about what was done, '' for nothing.

    :param control: of the node
    """

    def __init__(self, control: WorldControl) -> None:
        self._control = control

    def features(self, _: Any, response: Any) -> str:
        """Tell what of the standard there is."""
        response.features = SimulatorFeatures(
            features=FEATURES,
            spawn_formats=['yaml'],
            custom_info='physsim: resource_string is a body of a world file, in YAML',
        )
        return ''

    def state(self, _: Any, response: Any) -> str:
        """Tell whether time runs."""
        response.state.state = self._state
        return ''

    def set_state(self, request: Any, _: Any) -> str:
        """Play, pause, or stop: pause and reset."""
        target, now = request.state.state, self._state
        codes = SetSimulationState.Response
        if target not in (_STOPPED, _PLAYING, _PAUSED):
            raise failed(
                f'there is no state {target} here; there are stopped, playing and paused',
                Result.RESULT_FEATURE_UNSUPPORTED,
                field='state',
            )
        if target == now:
            raise failed('it is in that state already', codes.ALREADY_IN_TARGET_STATE)
        if (now, target) == (_STOPPED, _PAUSED):
            raise failed('it is stopped; what is stopped is played', codes.INCORRECT_TRANSITION)
        if target == _PLAYING:
            return self._perform('play')
        message = self._perform('pause')
        return self._control.simulation.reset() if target == _STOPPED else message

    def step(self, request: Any, _: Any) -> str:
        """Advance a paused world by frames."""
        self.check_steps(request.steps)
        message = ''
        for _frame in range(request.steps):
            message = self.step_once()
        return message

    def check_steps(self, steps: int) -> None:
        """
        Refuse a number of steps.

        :raises Failed: time runs, or they are none or too many
        """
        if self._control.simulation.speed != 0:
            raise failed('time is running; pause first', Result.RESULT_OPERATION_FAILED)
        if not 1 <= steps <= MOST_STEPS:
            raise failed(
                f'steps is {steps}; a call has 1 to {MOST_STEPS}',
                Result.RESULT_OPERATION_FAILED,
                field='steps',
            )

    def step_once(self) -> str:
        """Advance a paused world by a frame."""
        return self._perform('step')

    def reset(self, request: Any, _: Any) -> str:
        """Go to the beginning, or restore some of it at the time that is shown."""
        scope = request.scope
        if scope in _ALL:
            return self._control.simulation.reset()
        simulation = self._control.simulation
        loaded = simulation.loaded
        if scope == _STATE | _SPAWNED:
            return simulation.perform(Restore(state=loaded))
        if scope == _SPAWNED:
            known = {each.body.name for each in loaded.bodies}
            scene = self._control.current_snapshot().scene
            spawned = tuple(name for name in scene.names if name not in known)
            return (
                simulation.perform(DeleteBodies(names=spawned)) if spawned else 'none was spawned'
            )
        raise failed(
            'the scope is all, what was spawned, or state and what was spawned',
            Result.RESULT_FEATURE_UNSUPPORTED,
            field='scope',
        )

    def worlds(self, request: Any, response: Any) -> str:
        """List the worlds that `load` takes by name."""
        response.worlds = [
            each for each in self._worlds() if passes_tags(set(each.tags), request.filter)
        ]
        response.result.error_message = unknown_sources(request.sources)
        return ''

    def load(self, request: Any, response: Any) -> str:
        """Load a world of a name, and stop."""
        codes = LoadWorld.Response
        uri = request.uri
        if not (uri or request.resource_string):
            raise failed('uri names no world', codes.NO_RESOURCE, field='uri')
        if not uri:
            raise failed(
                'a world is loaded by its name', Result.RESULT_FEATURE_UNSUPPORTED, field='uri'
            )
        if Path(uri).suffix not in ('', '.yaml'):
            raise failed('a world is a YAML file', codes.UNSUPPORTED_FORMAT, field='uri')
        try:
            message = self._control.perform_on('load_world', uri)
        except BadWorldFile as refusal:
            # One that is there, but no world, has a cause.
            result = codes.RESOURCE_PARSE_ERROR if refusal.cause else Result.RESULT_NOT_FOUND
            raise Failed(refusal, result) from refusal
        self._perform('pause')
        self._control.simulation.reset()
        response.world = self._current()
        return message

    def current_world(self, _: Any, response: Any) -> str:
        """Tell the world that was loaded."""
        response.world = self._current()
        return ''

    def _perform(self, service: str) -> str:
        perform, _ = self._control.services[service]
        return perform()

    @property
    def _state(self) -> int:
        simulation = self._control.simulation
        if simulation.speed != 0:
            return int(_PLAYING)
        return int(_PAUSED if simulation.step else _STOPPED)

    def _current(self) -> WorldResource:
        uri = str(self._control.values['world_file'])
        name = Path(uri).stem
        known = (each for each in self._worlds() if each.name == name)
        return next(known, WorldResource(name=name, uri=uri))

    def _worlds(self) -> list[WorldResource]:
        directories = (
            ('own', self._control.world_dir),
            ('shipped', shipped_worlds()),
            ('lesson', shipped_lessons()),
        )
        # An own one comes before a shipped one of its name.
        found = {
            name: WorldResource(name=name, uri=name, tags=[tag])
            for tag, directory in reversed(directories)
            for name in worlds_in(directory)
        }
        return sorted(found.values(), key=lambda each: each.name)
