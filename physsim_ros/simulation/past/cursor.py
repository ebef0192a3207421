# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The cursor: a world at a moment of the line of events in force, which a replay reaches.

Laws: a world that continues from a moment of the past makes the same bits as before, from the same
checkpoints and with the same requests, until a request changes its course; a difference is
reported as `divergence`. At each checkpoint on its way, the world moves into a space that is built
from it, as it did the first time.

Long work, a seek, an amendment of the past or steps, is made in slices. Meanwhile `moment` and the
settings are those of the goal of the seek, of the end of the amendment, of the last step that is
made; `arrive` finishes the work. A seek replaces another one, and steps; an amendment is finished
first.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from enum import Enum
from typing import Any, NamedTuple

from physsim_ros.model.answer import Answer
from physsim_ros.model.checkpoint import Checkpoint, WorldState
from physsim_ros.model.errors import OutOfHistory, Refusal
from physsim_ros.model.requests import Configure, Request
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.translation import Text
from physsim_ros.runtime.slices import finish
from physsim_ros.simulation.past.line import Keyframe, LineInForce, Moment, Node
from physsim_ros.simulation.past.tree import Tree
from physsim_ros.simulation.world import Change, World

# Share of the time between two checkpoints in which the bodies for the next one are built [1], so
# that no frame builds all.
_AHEAD = 0.75


class Replay:
    """
    A world that is sent to moments of the line in force.

    :param world: at a moment of the line, or sent there by `slices_of_resumption`
    :param line: in force
    :param reports: of events without a request, to which it adds

    :ivar serial: number of the last request that was applied
    """

    def __init__(self, world: World, line: LineInForce, reports: list[Answer]) -> None:
        self.serial = 0
        self._world = world
        self._line = line
        self._reports = reports
        # The checkpoint from which the present space was built.
        self._resumed: Moment | None = None

    @property
    def _here(self) -> Moment:
        """Step and serial of the world as it is."""
        return Moment(self._world.step_count, self.serial)

    def slices_of_resumption(
        self, keyframe: Keyframe, *, going_over: bool = False
    ) -> Generator[None]:
        """
        Go to a keyframe; yield after each slice.

        :param going_over: whether the world is at that moment now, with the same bits
        """
        yield from self._world.slices_of_resumption(keyframe.checkpoint, going_over=going_over)
        self.serial = keyframe.serial
        self._resumed = keyframe.moment

    def slices_to_shown(self, step: int) -> Generator[None]:
        """Replay up to a step of the line, with the requests with which it was shown."""
        yield from self._replay_to(step, self._line.serial_shown_at(step))

    def _replay_to(self, step: int, serial: int) -> Generator[None]:
        """Replay up to a moment of the line, no earlier than now; yield after each slice."""
        world = self._world
        while world.step_count < step:
            yield from self._replay_to_stop(min(step, world.step_count + world.frame_steps))
            yield
        yield from self._apply_logged(serial)

    def _replay_to_stop(self, end: int) -> Generator[None]:
        """Replay up to the next step with a request or a checkpoint, or to the end."""
        line, world = self._line, self._world
        yield from self._apply_logged(line.serial_at(world.step_count))
        yield from self.slices_of_entering()
        stop = line.next_stop(world.step_count, end)
        yield from world.slices_of_steps(stop - world.step_count)
        # Their events were reported the first time.
        world.take_lost()
        world.take_broken()
        yield from self._apply_logged(line.serial_shown_at(world.step_count))

    def _apply_logged(self, serial: int) -> Generator[None]:
        """Apply the logged requests of this step up to a serial; yield after each."""
        for node in self._line.nodes_between(self.serial, serial):
            yield from self.slices_of_entering()
            try:
                yield from self._world.slices_of_reapplying(node.request)
            except Refusal as refusal:
                message = Text('a request of the log is refused now: {wrong}', wrong=refusal.text)
                self._report('divergence', message)
            self.serial += 1
            yield

    def slices_of_entering(self) -> Generator[None]:
        """Move into a space that is built from the checkpoint of this moment, if there is one."""
        keyframe = self._line.keyframe_at(*self._here)
        if keyframe is not None and self._resumed != keyframe.moment:
            yield from self.slices_of_resumption(keyframe, going_over=self.check_digest())

    def check_digest(self) -> bool:
        """Return whether the world has the digest of the keyframe here; report a difference."""
        keyframe = self._line.keyframe_at(*self._here)
        same = keyframe is None or self._world.digest() == keyframe.digest
        if not same:
            seconds = self._world.step_count * self._world.dt
            message = Text('{time:.3f} s was reached with other bits than before', time=seconds)
            self._report('divergence', message)
        return same

    def _report(self, code: str, message: Text, subject: str = '') -> None:
        self._reports.append(Answer(topic=code, subject=subject, message=message, code=code))


class _Kind(Enum):
    """The kinds of long work."""

    SEEK = 'seek'
    AMENDMENT = 'amendment'
    STEPS = 'steps'


class _Work(NamedTuple):
    """
    A seek, an amendment or steps that are under way.

    :ivar kind: of it
    :ivar slices: of the work
    :ivar moment: returns the moment that the cursor is at for others meanwhile
    """

    kind: _Kind
    slices: Iterator[None]
    moment: Callable[[], Moment]


class Cursor(Replay):
    """
    A world at a moment of the line in force.

    :param world: at a moment of the line, or sent there by `begin` or `restore`
    :param tree: of all lines
    :param reports: of events without a request, to which it adds
    """

    def __init__(self, world: World, tree: Tree, reports: list[Answer]) -> None:
        super().__init__(world, tree.line, reports)
        self._tree = tree
        self._work: _Work | None = None
        # Whether the world is where no way along the line in force leads to the goal of a seek.
        self._is_elsewhere = False
        # A tip, and the steps from which it needs neither a request nor a checkpoint.
        self._stretch: tuple[Node | None, range] = (None, range(0))

    # The moment

    def arrive(self) -> World:
        """Carry out the rest of the work that is under way, and return the world."""
        while self.carry_out_slice():
            pass
        return self._world

    @property
    def settings(self) -> WorldSettings:
        """Return the settings of the world at this moment."""
        return self._line.node(self.moment.serial).settings

    @property
    def moment(self) -> Moment:
        """Return step and serial."""
        return self._here if self._work is None else self._work.moment()

    @property
    def is_newest(self) -> bool:
        """Whether nothing lies ahead of this moment."""
        return self.moment == self._line.end

    @property
    def is_working(self) -> bool:
        """Whether a seek, an amendment or steps are under way."""
        return self._work is not None

    @property
    def is_seeking(self) -> bool:
        """Whether a seek is under way."""
        return self._work is not None and self._work.kind is _Kind.SEEK

    @property
    def is_amending(self) -> bool:
        """Whether an amendment is under way."""
        return self._work is not None and self._work.kind is _Kind.AMENDMENT

    def begin_amendment(self, slices: Iterator[None]) -> None:
        """Have an amendment be carried out slice by slice, from now on."""
        self.arrive()
        self._work = _Work(_Kind.AMENDMENT, slices, lambda: self._line.end)

    def carry_out_slice(self) -> bool:
        """
        Carry out a slice, a frame or a request, and return whether work is still under way.

        Of a frame that takes long, a slice is as many sub-steps as a call of the core makes.
        """
        # Within a slice, the world is where it is.
        work, self._work = self._work, None
        # An amendment that is refused ends with a seek back.
        if work is not None and next(work.slices, self) is not self:
            self._work = work
        return self._work is not None

    def slices_of_work(self) -> Iterator[None]:
        """Carry out the work that is under way as a part of other work."""
        work, self._work = self._work, None
        if work is not None:
            yield from work.slices

    def finish_amendment(self) -> None:
        """Carry out the rest of an amendment."""
        while self.is_amending:
            self.carry_out_slice()

    # To another moment

    def begin(self, state: WorldState) -> None:
        """
        Begin a line with a state, at time 0.

        :raises Refusal: it is too large, or cannot be simulated; nothing is changed
        """
        self.finish_amendment()
        self._world.begin(state, 0)
        self._begin_line(state, self._world.renew())

    def restore(self, checkpoint: Checkpoint, loaded: WorldState) -> None:
        """
        Begin a line at a checkpoint, at its time.

        :param loaded: the state that was loaded last
        """
        self.finish_amendment()
        self._world.resume(checkpoint)
        self._begin_line(loaded, checkpoint)

    def _begin_line(self, loaded: WorldState, checkpoint: Checkpoint) -> None:
        self._work, self._is_elsewhere, self.serial = None, False, 0
        self._tree.begin(loaded, checkpoint, self._world.digest())
        self._resumed = self.moment

    def seek_step(self, step: int, *, with_contacts: bool = True) -> None:
        """
        Go to a step of the line, as it was shown.

        :param with_contacts: whether the contacts of its frame are still to be shown
        :raises OutOfHistory: the time is no longer kept, or in the future
        """
        line, dt = self._line, self._world.dt
        if not line.oldest <= step <= line.head:
            raise OutOfHistory(
                '{time:.3f} s is not in the history, which reaches from {oldest:.3f} to '
                '{newest:.3f} s',
                field='clock',
                time=step * dt,
                oldest=line.oldest * dt,
                newest=line.head * dt,
            )
        self.seek_moment(step, line.serial_shown_at(step), with_contacts=with_contacts)

    def seek_moment(
        self, step: int, serial: int, *, with_contacts: bool = True, elsewhere: bool = False
    ) -> None:
        """
        Go to a moment of the past, from the checkpoint before it or from this moment.

        :param elsewhere: whether the world is on another line now
        """
        line, goal, frame_steps = self._line, Moment(step, serial), self._world.frame_steps
        # Contacts are those of one frame, as they were the first time.
        begin = max(line.oldest, step - (step % frame_steps or frame_steps))
        start = min(Moment(begin, line.serial_shown_at(begin)), goal)
        first = start if self._world.reports_contacts else goal
        keyframe = line.keyframe_before(*first)
        # A seek that this one replaces has also come to a moment of the line.
        is_within_step = self._world.is_within_step
        is_on_way = keyframe.moment <= self._here <= first
        self._is_elsewhere |= elsewhere or is_within_step or not is_on_way
        slices = self._slices_of_seek(
            keyframe if self._is_elsewhere else None, start, goal, with_contacts=with_contacts
        )
        self._work = _Work(_Kind.SEEK, slices, lambda: goal)

    def _slices_of_seek(
        self, keyframe: Keyframe | None, start: Moment, goal: Moment, *, with_contacts: bool
    ) -> Generator[None]:
        if keyframe is not None:
            yield from self.slices_of_resumption(keyframe)
            self._is_elsewhere = False
        yield from self._replay_to(*start)
        self._world.clear_contacts()
        yield from self._replay_to(*goal)
        if not with_contacts:
            self._world.clear_contacts()

    def follow(self, tip: Node, head: int, moment: tuple[int, int | None]) -> int:
        """
        Put another line in force, and go to a moment of it, or to the oldest that is kept.

        :param tip: of the line
        :param head: the last step that it has reached
        :param moment: step and serial; a serial of None is that with which the step was shown
        :return: the first step at which the lines differ
        """
        line, differs = self._line, self._tree.follow(tip, head)
        step, serial = max(moment[0], line.oldest), moment[1]
        if serial is None or step != moment[0] or (step, serial) < line.keyframes[0].moment:
            serial = line.serial_shown_at(step)
        self.seek_moment(step, serial, elsewhere=True)
        return differs

    def keep_within(self, length: int) -> bool:
        """
        Limit the past; if the world is before the oldest step that is kept then, go to it.

        :param length: steps that are kept
        :return: whether the world is at the same moment as before
        """
        # Before the steps that it replays are dropped.
        self.arrive()
        line = self._line
        self._tree.limit_length(length)
        if self._world.step_count >= line.oldest and self.moment >= line.keyframes[0].moment:
            return True
        self.seek_step(line.oldest)
        return False

    # Going on

    def log(self, request: Request, change: Change, gesture: int, author: str) -> None:
        """
        Add the request that has changed the world; it is the new tip.

        :param change: its effect
        :param author: name of the person who did it; '' is nobody
        """
        self._add_node(
            request,
            gesture=gesture,
            author=author,
            subject=change.answer.subject,
            joined=change.joined,
            adds=change.has_grown,
        )
        if self._tree.is_log_long:
            # A paused world can then drop its oldest requests.
            self.add_keyframe()

    def _add_node(self, request: Request, **fields: Any) -> None:
        """
        Add the node of a request at this moment, the new tip.

        :param fields: of it, beside those that follow from the moment
        """
        step, serial = self.moment
        parent, settings = self._line.node(serial), self._world.settings
        node = Node(parent=parent, step=step, request=request, settings=settings, **fields)
        self._tree.add_request(node)
        self.serial += 1

    def begin_advance(self, steps: int) -> None:
        """Have the world advance by a number of steps, slice by slice from now on."""
        end = self.arrive().step_count + steps
        self._work = _Work(_Kind.STEPS, self.slices_of_advance(end), self._last_made)

    def _last_made(self) -> Moment:
        """Return the last step that is made, with the requests with which it was shown."""
        step = self._world.step_count
        at_end = step >= self._line.head
        # Before the end, the world may be among the requests of this step.
        return self._line.end if at_end else Moment(step, self._line.serial_shown_at(step))

    def slices_of_advance(self, end: int) -> Generator[None]:
        """
        Advance to a step: by replay up to the head, then by new steps.

        Yield where steps take long.
        """
        world, line = self._world, self._line
        while (step := world.step_count) < end:
            if step < line.head:
                yield from self._replay_to_stop(min(end, line.head))
                continue
            tip, steps = self._stretch
            if tip is not line.tip or self.serial != tip.serial or step not in steps:
                yield from self._apply_logged(line.serial_at(step))
                yield from self._make_checkpoint()
                steps = range(step, line.next_stop(step, step + line.spacing))
                self._stretch = line.tip, steps
            yield from self._make_steps(min(end, steps.stop))

    def _make_steps(self, end: int) -> Generator[None]:
        """Make steps that the line has not reached before; yield where they take long."""
        world, tree = self._world, self._tree
        for _ in world.slices_of_steps(end - world.step_count):
            tree.reach(world.step_count)
            yield
        tree.reach(end)
        for name in world.take_lost():
            message = Text('{body} left the range of numbers and was removed', body=name)
            self._report('body_lost', message, name)
        for name, force in world.take_broken():
            message = Text(
                '{joint} broke at {force:.3g} N and was removed', joint=name, force=force
            )
            self._report('joint_broken', message, name)

    # Checkpoints

    def _make_checkpoint(self) -> Generator[None]:
        """Make a checkpoint if one is due, or if a request followed the last one at its step."""
        yield from self.slices_of_entering()
        step = self._world.step_count
        # Another line has run from this node before: its checkpoints are used.
        if step < self._line.tip.end:
            return
        due = self._tree.is_checkpoint_due(step) or (
            self._resumed is not None and self._resumed.step == step
        )
        if due and self._line.keyframe_at(*self._here) is None:
            yield from self.slices_of_keyframe()

    def add_keyframe(self) -> Checkpoint:
        """
        Make a checkpoint now, the last of the line, continue from it, and return it.

        Where another line has run on from here, which does not pass it, it has a node of its own,
        whose request changes nothing: an undo takes it back with the gesture before.
        """
        self.arrive()
        tip = self._line.tip
        if self._world.step_count < tip.end:
            self._add_node(Configure(changes={}), gesture=tip.gesture)
        return finish(self.slices_of_keyframe())

    def slices_of_keyframe(self) -> Generator[None, None, Checkpoint]:
        """Do as `add_keyframe` in slices, before whose end nothing else is done."""
        checkpoint = yield from self._world.slices_of_renewal()
        digest = self._world.digest()
        self._resumed = self._here
        self._tree.add_keyframe(self._here, checkpoint, digest)
        return checkpoint

    def build_ahead(self, steps: int) -> None:
        """Build the share of the bodies for the next checkpoint that is due in some steps."""
        world, spacing = self._world, self._line.spacing
        if not world.is_built_ahead:
            count = world.scene.piece_count + len(world.scene.joints)
            world.build_bodies(-(-count * steps // max(1, int(spacing * _AHEAD))))
