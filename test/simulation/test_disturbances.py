# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A world whose past is looked at goes on as one that nobody disturbs, to the bit."""

from __future__ import annotations

from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st
from hypothesis.stateful import initialize, invariant, rule, RuleBasedStateMachine
from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import Configure, Delete, Request, Spawn
from physsim_ros.model.shapes import Disc
from physsim_ros.simulation.simulation import Simulation

from .histories import request_of, spawn_of

requests = st.randoms().map(request_of)
spawns = st.randoms().map(spawn_of)
PERIOD = 1e9 / 60
# Requests that the engine never sees.
REFUSED: list[Request] = [
    Delete(name='nobody/0'),
    Spawn(name='a/0', shape=Disc(radius=0.3), pose=(0.0, 3.0, 0.0), frame='nowhere'),
]


class Disturbances(RuleBasedStateMachine):
    """
    Two worlds with the same requests at the same steps.

    One makes them straight on. The other is taken to its past and back, undone and redone, saved,
    asked for what it refuses, watched and not watched in between.
    """

    @initialize(
        several=st.lists(spawns, min_size=3, max_size=6), spacing=st.sampled_from([0.25, 0.17])
    )
    def begin(self, several: list[Spawn], spacing: float) -> None:
        self.straight = Simulation(history=60.0, checkpoints=spacing)
        self.disturbed = Simulation(history=60.0, checkpoints=spacing)
        self.now = 0
        self.request(Configure(changes={'bounds': (-4.0, 0.0, 4.0, 9.0)}))
        for spawn in several:
            self.request(spawn)

    def request(self, request: Request) -> None:
        answers = []
        for simulation in (self.straight, self.disturbed):
            simulation.requests.submit(request, topic='')
            frame = simulation.apply_requests()
            assert frame is not None
            answers.append([each for each in frame.answers if not each.topic])
        assert answers[0] == answers[1]

    # Done in both

    @rule(request=requests)
    def change(self, request: Request) -> None:
        self.request(request)

    @rule(frames=st.integers(1, 40))
    def go_on(self, frames: int) -> None:
        for _ in range(frames):
            self.straight.advance_frame()
            self.disturbed.advance_frame()

    @rule(share=st.floats(0.0, 1.0), request=requests)
    def branch(self, share: float, request: Request) -> None:
        stamp = self.stamp_at(share)
        self.straight.seek(stamp)
        self.disturbed.seek(stamp)
        self.request(request)

    @rule()
    def undo(self) -> None:
        said = []
        for simulation in (self.straight, self.disturbed):
            try:
                said.append(simulation.undo())
            except Refusal as refusal:
                said.append(str(refusal))
        assert said[0] == said[1]

    # Done in one

    @rule(shares=st.lists(st.floats(0.0, 1.0), min_size=1, max_size=4))
    def visit_the_past(self, shares: list[float]) -> None:
        here = self.disturbed.step
        for share in shares:
            self.disturbed.seek(self.stamp_at(share))
            self.disturbed.apply_requests()
        self.return_to(here)

    @rule(speed=st.sampled_from([-8.0, -1.0, -0.3]), frames=st.integers(1, 30))
    def play_backward(self, speed: float, frames: int) -> None:
        here = self.disturbed.step
        self.disturbed.speed = speed
        for _ in range(frames):
            self.now += round(PERIOD)
            self.disturbed.advance(self.now)
        self.disturbed.speed = 0.0
        self.return_to(here)

    @rule(frames=st.integers(0, 10))
    def undo_and_redo(self, frames: int) -> None:
        try:
            self.disturbed.undo()
        except Refusal:
            return
        for _ in range(frames):
            self.disturbed.advance_frame()
        self.disturbed.redo()

    @rule(request=st.sampled_from(REFUSED))
    def refuse(self, request: Request) -> None:
        self.disturbed.requests.submit(request, topic='')
        frame = self.disturbed.apply_requests()
        assert frame is not None
        assert frame.answers[-1].code

    @rule(reports_contacts=st.booleans())
    def watch(self, reports_contacts: bool) -> None:
        self.disturbed.reports_contacts = reports_contacts

    @rule()
    def read(self) -> None:
        self.disturbed.world.snapshot()

    @rule()
    def save(self) -> None:
        state = self.disturbed.save()
        elsewhere = Simulation()
        elsewhere.begin(state)
        assert elsewhere.world.save() == state

    def stamp_at(self, share: float) -> int:
        """Return a time between the oldest step and this one [ns]."""
        oldest, here = self.straight.past.timeline.history.oldest, self.straight.step
        return round((oldest + round(share * (here - oldest))) * 1e9 / 240)

    def return_to(self, step: int) -> None:
        self.disturbed.seek(round(step * 1e9 / 240))

    @invariant()
    def both_are_the_same_to_the_bit(self) -> None:
        if hasattr(self, 'straight'):
            assert self.disturbed.step == self.straight.step
            assert self.disturbed.world.digest() == self.straight.world.digest()


TestDisturbances = Disturbances.TestCase
TestDisturbances.settings = settings(
    max_examples=40,
    stateful_step_count=20,
    deadline=None,
    # A failing example is long, and to shrink it takes minutes.
    phases=[Phase.explicit, Phase.reuse, Phase.generate],
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
