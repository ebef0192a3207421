# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The present state of a world, by the names of bodies and joints."""

from __future__ import annotations

from collections.abc import Sequence
import math

from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.texts import nearest_name
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.testing.values import Contact, Pose, Twist, UnknownName

# Bodies that a failure describes [1]: what a screen shows at a time; and those that it names in a
# line.
_MOST_DESCRIBED = 30
_MOST_NAMED = 10


class ObservedWorld:
    """
    The state of a world, as it is now.

    :param node: that owns the world
    """

    def __init__(self, node: PhysSimNode) -> None:
        self.node = node

    @property
    def time(self) -> float:
        """Return the simulation time [s]."""
        return self._snapshot.stamp * 1e-9

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all bodies, in spawn order."""
        return self._snapshot.scene.names

    def pose(self, name: str) -> Pose:
        """
        Return the pose of a body.

        :raises UnknownName: there is no such body
        """
        return Pose(*self._snapshot.poses[self._row(name)].tolist())

    def twist(self, name: str) -> Twist:
        """
        Return the twist of a body.

        :raises UnknownName: there is no such body
        """
        return Twist(*self._snapshot.twists[self._row(name)].tolist())

    def contacts(self, name: str | None = None) -> list[Contact]:
        """
        Return the contacts of the last frame.

        :param name: of a body, whose contacts are returned; 'world' is the walls of `bounds`
        :raises UnknownName: there is no such body, nor was there in that frame
        """
        frame = self.node.frame
        names = [*(() if frame is None else frame.snapshot.scene.names), 'world']
        if name is not None and name not in names:
            self._row(name)
        if frame is None or frame.contacts is None:
            return []
        found = frame.contacts
        vectors = (found.impulses, found.points, found.normals)
        contacts = [
            Contact(names[a], names[b], *map(tuple, each))
            for (a, b), *each in zip(
                found.pairs.tolist(), *(each.tolist() for each in vectors), strict=True
            )
        ]
        return [each for each in contacts if name is None or name in (each.a, each.b)]

    def energy(self) -> float:
        """Return kinetic, potential (0 at y = 0) and elastic energy of the world [J]."""
        snapshot = self._snapshot
        return snapshot.kinetic_energy + snapshot.potential_energy + snapshot.elastic_energy

    def force(self, joint: str) -> float:
        """
        Return the force of a joint in the last step [N].

        :raises UnknownName: there is no such joint
        """
        return float(self._snapshot.forces[index_of(joint, self.joints, 'joint')])

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of all joints, in the order of their creation."""
        return tuple(joint.name for joint in self._snapshot.scene.joints)

    def digest(self) -> str:
        """
        Return a hash of time, poses, velocities, wrenches and the descriptions of all objects.

        The impulse cache of the engine is not included: two worlds of one digest may differ after
        the next step, where bodies touch.
        """
        return self.node.simulation.world.digest()

    @property
    def _snapshot(self) -> Snapshot:
        return self.node.simulation.world.snapshot()

    def _row(self, name: str) -> int:
        return index_of(name, self.names, 'body')

    def describe_state(self) -> str:
        """Return the time, and pose and velocity of the first bodies, a line each."""
        names = self.names
        lines = [f'at {self.time:g} s, bodies: {len(names)}; x, y [m], yaw [rad]:']
        for name in names[:_MOST_DESCRIBED]:
            pose, twist = self.pose(name), self.twist(name)
            speed = math.hypot(twist.vx, twist.vy)
            lines.append(
                f'  {name:20}  {pose.x:8.3f} {pose.y:8.3f} {pose.yaw:8.3f}, '
                f'with {speed:.3f} m/s and {twist.spin:.3f} rad/s'
            )
        if len(names) > _MOST_DESCRIBED:
            lines.append(f'  and {len(names) - _MOST_DESCRIBED} more')
        return '\n'.join(lines)


def index_of(name: str, names: Sequence[str], kind: str) -> int:
    """
    Return the index of a name.

    :param kind: of what is named, for the message
    :raises UnknownName: it is not there
    """
    if name in names:
        return names.index(name)
    listed = ', '.join(names[:_MOST_NAMED]) + (', …' if len(names) > _MOST_NAMED else '')
    hint = nearest_name(name, names) or f'; there are {listed or "none"}'
    raise UnknownName(f'there is no {kind} {name!r}{hint}')
