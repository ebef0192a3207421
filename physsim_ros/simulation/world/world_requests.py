# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests for the whole world: changed settings, and a saved state in place of everything."""

from __future__ import annotations

from dataclasses import replace

from physsim_ros.model.requests import Configure, Restore
from physsim_ros.simulation.world.live_space import LiveSpace
from physsim_ros.simulation.world.lookup import Done


def configure(live: LiveSpace, request: Configure) -> Done:
    """
    Change settings.

    :raises Refusal: a value is out of range; nothing is changed
    """
    space, old = live.space, live.settings
    new = replace(old, **request.changes)
    space.configure(new)
    until = live.step_after(new.command_timeout)
    if until is not None and new.command_timeout != old.command_timeout:
        # No wrench acts longer than from now on to the new timeout.
        for rigid in space.pipeline.wrenches.acting():
            if rigid.wrench_until is None or rigid.wrench_until > until:
                space.set_wrench(rigid, rigid.wrench, until)
    return Done('', f'set {", ".join(request.changes)}')


def restore(live: LiveSpace, request: Restore) -> Done:
    """
    Replace bodies, joints and settings by those of a saved state, in a space of its own.

    :raises WorldFull: the state is too large; nothing is changed
    :raises BadProperty: springs are too stiff for the steps; nothing is changed
    """
    state = request.state
    live.capacity.check_state(state)
    live.begin(state)
    joints = f' and {len(state.joints)} joints' if state.joints else ''
    return Done('', f'loaded {len(state.bodies)} bodies{joints}')
