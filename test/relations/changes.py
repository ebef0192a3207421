# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Worlds of a world: each function takes the state of a world and returns that of another one.

States are those of a beginning, without caches; what is not told stays as it was.
"""

from dataclasses import replace
import itertools
import math
import random

from physsim_ros.model.actors import Actor
from physsim_ros.model.checkpoint import BodyState
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.names import WORLD
from physsim_ros.model.scene import Body, Joint, Seat
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Polygon, SMALLEST, Triangles
from physsim_ros.model.transform import local_to_world, rotated

# Number of bodies to which something is joined: as much as makes islands of joints of a crowd,
# and what a step takes for joints stays small.
FEW = 8


# Parts of a state


def with_bodies(state, change):
    """Return a state with another body for each."""
    return replace(state, bodies=tuple(map(change, state.bodies)))


def with_joints(state, change):
    """Return a state with another joint for each."""
    return replace(state, joints=tuple(map(change, state.joints)))


def moves_freely(body):
    """Return whether a body is moved by forces alone, and is no sensor."""
    return body.dynamic and not body.sensor and body.robot is None and body.actor is None


def is_plain(held):
    """Return whether a body of a state is moved by forces alone, and is no sensor."""
    return moves_freely(held.body)


def few_plain(state):
    """Return the first of the plain bodies, those that nothing is joined to first."""
    joined = {name for joint in state.joints for name in (joint.a, joint.b)}
    plain = [held for held in state.bodies if is_plain(held)]
    return sorted(plain, key=lambda held: held.body.name in joined)[:FEW]


def with_guides(joint, change):
    """Return a joint with another guide for each."""
    return replace(joint, guides=tuple(map(change, joint.guides)))


def with_members(joint, names):
    """Return a joint of other bodies, by the names of its own."""
    joint = replace(joint, a=names[joint.a], b=names[joint.b])
    joint = with_guides(joint, lambda guide: guide._replace(body=names[guide.body]))
    over = tuple(names[name] for name in joint.properties.over or ())
    return joint_properties(joint, over=over) if over else joint


def joint_properties(joint, **changes):
    """Return a joint with changed properties."""
    return replace(joint, properties=replace(joint.properties, **changes))


def explicit(joint):
    """Return a joint whose dimensional properties are set, as they are by default or as drawn."""
    names = {
        JointKind.MOTOR: ('rate', 'max_torque'),
        JointKind.SPRING: ('stiffness', 'damping'),
    }.get(joint.kind, ())
    set_ = {name: joint.number(name) for name in names}
    set_ |= {
        name: value
        for name, value in joint.drawn_values().items()
        if getattr(joint.properties, name) is None
    }
    return joint_properties(joint, **set_)


def scaled(joint, **factors):
    """Return a joint with its properties times factors; those that are not set stay so."""
    values = {name: getattr(joint.properties, name) for name in factors}
    return joint_properties(
        joint,
        **{name: value * factors[name] for name, value in values.items() if value is not None},
    )


def with_media(state, change):
    """Return a state with another medium for each of its regions, and for its air."""

    def body(held):
        medium = held.body.medium
        return replace(
            held, body=replace(held.body, medium=None if medium is None else change(medium))
        )

    air = change(state.settings.air)
    settings = replace(
        state.settings,
        air_density=air.density,
        air_viscosity=air.viscosity,
        wind=air.flow,
        gusts=air.gusts,
        gust_time=air.gust_time,
    )
    return replace(with_bodies(state, body), settings=settings)


# Where and which way


def moved(state, by):
    """Move a world by a vector [m]."""
    x, y = by

    def body(held):
        px, py, yaw = held.pose
        actor = held.body.actor
        if actor is not None:
            actor = replace(
                actor, points=tuple((p[0] + x, p[1] + y, *p[2:]) for p in actor.points)
            )
        return replace(held, pose=(px + x, py + y, yaw), body=replace(held.body, actor=actor))

    def guide(each):
        return each._replace(x=each.x + x, y=each.y + y) if each.body == WORLD else each

    def joint(each):
        each = with_guides(each, guide)
        if each.b != WORLD:
            return each
        seat = each.seat
        return replace(each, seat=seat._replace(bx=seat.bx + x, by=seat.by + y))

    bounds = state.settings.bounds
    if bounds is not None:
        bounds = (bounds[0] + x, bounds[1] + y, bounds[2] + x, bounds[3] + y)
    settings = replace(state.settings, bounds=bounds)
    return replace(with_joints(with_bodies(state, body), joint), settings=settings)


def turned(state, angle, vector):
    """
    Turn a world and its gravity counter-clockwise.

    :param angle: [rad]
    :param vector: function that turns a vector by it
    """

    def body(held):
        x, y = vector(held.pose[:2])
        vx, vy = vector(held.twist[:2])
        changed = held.body
        if changed.actor is not None:
            changed = replace(changed, actor=_actor_turned(changed.actor, angle, vector))
        forces = tuple(
            replace(each, force=vector(each.force)) if each.axes == 'world' else each
            for each in changed.forces
        )
        return replace(
            held,
            pose=(x, y, held.pose[2] + angle),
            twist=(vx, vy, held.twist[2]),
            body=replace(changed, forces=forces),
        )

    def guide(each):
        headings = {'heading_in': each.heading_in + angle, 'heading_out': each.heading_out + angle}
        if each.body != WORLD:
            return each._replace(yaw=each.yaw + angle, **headings)
        x, y = vector((each.x, each.y))
        return each._replace(x=x, y=y, **headings)

    def joint(each):
        each = with_guides(each, guide)
        seat, ratio = each.seat, each.number('ratio')
        if each.b == WORLD:
            bx, by = vector((seat.bx, seat.by))
            ux, uy = vector((seat.ux, seat.uy))
            seat = seat._replace(bx=bx, by=by, ux=ux, uy=uy, phase=seat.phase - angle)
        else:
            seat = seat._replace(phase=seat.phase + (ratio - 1.0) * angle)
        by = seat.phase - each.seat.phase
        phase = each.properties.phase
        changed = replace(each, seat=seat)
        return changed if phase is None else joint_properties(changed, phase=phase + by)

    settings = replace(
        state.settings,
        gravity=vector(state.settings.gravity),
        wind=vector(state.settings.wind),
        bounds=_bounds(state.settings.bounds, vector),
    )
    return replace(with_joints(with_bodies(state, body), joint), settings=settings)


def quarter(vector):
    """Return a vector, turned by a right angle, to the bit."""
    return (-vector[1], vector[0])


def _bounds(bounds, vector):
    """Return the box of the corners of bounds, each mapped by a function."""
    if bounds is None:
        return None
    corners = [vector(bounds[:2]), vector(bounds[2:])]
    (left, right), (bottom, top) = (sorted(side) for side in zip(*corners, strict=True))
    return left, bottom, right, top


def _actor_turned(actor, angle, vector):
    points = tuple((*vector(p[:2]), *(yaw + angle for yaw in p[2:])) for p in actor.points)
    return replace(actor, points=points)


def _flip(vector):
    return (vector[0], -vector[1])


def mirrored(state):
    """Mirror a world in its x axis, to the bit: y and all angles change their signs."""

    def body(held):
        x, y, yaw = held.pose
        vx, vy, spin = held.twist
        changed = held.body
        if changed.actor is not None:
            points = tuple((p[0], -p[1], *(-yaw for yaw in p[2:])) for p in changed.actor.points)
            changed = replace(changed, actor=replace(changed.actor, points=points))
        driven = held.driven
        if driven is not None:
            ahead, aside, turn = driven.aim
            driven = driven._replace(aim=(ahead, -aside, -turn))
        forces = tuple(
            replace(each, force=_flip(each.force), at=None if each.at is None else _flip(each.at))
            for each in changed.forces
        )
        changed = replace(
            changed,
            shape=mirrored_shape(changed.shape),
            forces=forces,
            surface_velocity=_flip(changed.surface_velocity),
            belt=-changed.belt,
            one_way=_flip(changed.one_way),
        )
        return replace(
            held, pose=(x, -y, -yaw), twist=(vx, -vy, -spin), body=changed, driven=driven
        )

    def guide(each):
        names = ('y', 'radius', 'yaw', 'heading_in', 'heading_out')
        return each._replace(**{name: -getattr(each, name) for name in names})

    def joint(each):
        seat = each.seat
        seat = seat._replace(ay=-seat.ay, by=-seat.by, uy=-seat.uy, phase=-seat.phase)
        each = with_guides(replace(each, seat=seat), guide)
        said = each.properties
        if each.kind is JointKind.AXLE:
            lower, upper = said.lower, said.upper
            return joint_properties(
                each,
                lower=None if upper is None else -upper,
                upper=None if lower is None else -lower,
                ratchet=None if said.ratchet is None else -said.ratchet,
                rest_angle=None if said.rest_angle is None else -said.rest_angle,
            )
        if each.kind is JointKind.RACK:
            return replace(each, seat=seat._replace(ux=-seat.ux, uy=-seat.uy))
        if each.kind is JointKind.MOTOR:
            return joint_properties(each, rate=-each.number('rate'))
        if said.phase is not None:
            return joint_properties(each, phase=-said.phase)
        return each

    settings = replace(
        state.settings,
        gravity=_flip(state.settings.gravity),
        bounds=_bounds(state.settings.bounds, _flip),
    )
    changed = replace(with_joints(with_bodies(state, body), joint), settings=settings)
    return with_media(changed, lambda medium: replace(medium, flow=_flip(medium.flow)))


def mirrored_shape(shape):
    """Return the mirror image of a shape in its x axis."""
    match shape:
        case Polygon():
            return Polygon(outline=tuple(map(_flip, shape.outline)))
        case Chain():
            return Chain(points=tuple(map(_flip, shape.points)), thickness=shape.thickness)
        case Triangles():
            return Triangles(vertices=tuple(map(_flip, shape.vertices)))
        case Compound():
            return Compound(element=shape.element, centers=tuple(map(_flip, shape.centers)))
    return shape


def carried(state, velocity):
    """
    Have a world move at a constant velocity [m/s], its background too.

    What is fixed to the background is joined to a kinematic body instead, and anchored bodies are
    kinematic.
    """
    vx, vy = velocity

    names = {held.body.name: held.body.name for held in state.bodies} | {WORLD: 'carriage/0'}

    def body(held):
        x, y, spin = held.twist
        changed = held.body
        if changed.anchored:
            changed = replace(changed, anchored=False, kinematic=True)
        return replace(held, twist=(x + vx, y + vy, spin), body=changed)

    def joint(each):
        return with_members(each, names)

    wind = state.settings.wind
    settings = replace(state.settings, wind=(wind[0] + vx, wind[1] + vy))
    changed = replace(with_joints(with_bodies(state, body), joint), settings=settings)
    carriage = Body(
        name='carriage/0',
        shape=Disc(radius=0.01),
        color=(0.0, 0.0, 0.0, 1.0),
        density=1.0,
        friction=0.0,
        elasticity=0.0,
        kinematic=True,
        sensor=True,
    )
    held = BodyState(body=carriage, pose=(0.0, 0.0, 0.0), twist=(vx, vy, 0.0))
    return replace(changed, bodies=(*changed.bodies, held))


# Units


def heavier(state, factor):
    """Multiply all masses by a factor, and all forces."""

    def body(held):
        forces = tuple(
            replace(each, force=tuple(factor * part for part in each.force))
            for each in held.body.forces
        )
        mass = held.body.total_mass * factor
        return replace(held, body=replace(held.body, mass=mass, forces=forces))

    def medium(each):
        return replace(each, density=each.density * factor, viscosity=each.viscosity * factor)

    settings = replace(
        state.settings,
        gravitation=state.settings.gravitation / factor,
        coulomb=state.settings.coulomb * factor,
    )
    state = replace(state, settings=settings)
    names = ('max_torque', 'stiffness', 'damping', 'friction', 'max_force', 'break_force')
    return with_joints(
        with_media(with_bodies(state, body), medium),
        lambda joint: scaled(explicit(joint), **dict.fromkeys(names, factor)),
    )


def larger(state, size, time):
    """Multiply all lengths by a factor, and all times by another; masses stay."""
    speed = size / time

    def body(held):
        x, y, yaw = held.pose
        vx, vy, spin = held.twist
        changed = held.body
        forces = tuple(
            replace(
                each,
                force=tuple(part * speed / time for part in each.force),
                at=None if each.at is None else tuple(size * part for part in each.at),
            )
            for each in changed.forces
        )
        changed = replace(
            changed,
            shape=larger_shape(changed.shape, size),
            mass=changed.total_mass,
            forces=forces,
            surface_velocity=tuple(speed * part for part in changed.surface_velocity),
            belt=speed * changed.belt,
        )
        return replace(
            held,
            body=changed,
            pose=(size * x, size * y, yaw),
            twist=(speed * vx, speed * vy, spin / time),
        )

    def guide(each):
        names = ('x', 'y', 'radius', 'span')
        return each._replace(**{name: size * getattr(each, name) for name in names})

    def joint(each):
        seat = each.seat
        points = {name: size * getattr(seat, name) for name in ('ax', 'ay', 'bx', 'by', 'length')}
        # Values as drawn in the units of before.
        each = with_guides(replace(explicit(each), seat=seat._replace(**points)), guide)
        along = size if each.kind in {JointKind.SLIDER, JointKind.ROPE} else 1.0
        # Torque by angle and force by way, torque and force: powers of the length.
        arm = size**2 if each.kind is JointKind.AXLE else 1.0
        force = arm if each.kind is JointKind.AXLE else size
        return scaled(
            each,
            rate=along / time,
            max_torque=speed**2,
            stiffness=arm / time**2,
            damping=arm / time,
            friction=force / time**2,
            rest_length=size,
            length=size,
            lower=along,
            upper=along,
        )

    of_attraction = size ** (1 + state.settings.attraction_power) / time**2
    settings = replace(
        state.settings,
        gravitation=state.settings.gravitation * of_attraction,
        coulomb=state.settings.coulomb * of_attraction,
        softening=state.settings.softening * size,
        gravity=tuple(part * speed / time for part in state.settings.gravity),
        bounds=None
        if state.settings.bounds is None
        else tuple(size * side for side in state.settings.bounds),
    )

    def medium(each):
        return replace(
            each,
            density=each.density / size**2,
            viscosity=each.viscosity / (size * time),
            flow=tuple(speed * part for part in each.flow),
            gusts=each.gusts * speed,
            gust_time=each.gust_time * time,
        )

    changed = replace(with_joints(with_bodies(state, body), joint), settings=settings)
    return with_media(changed, medium)


def larger_shape(shape, size):
    """Return a shape with all lengths multiplied by a factor."""

    def points(these):
        return tuple((size * x, size * y) for x, y in these)

    match shape:
        case Disc():
            return Disc(radius=size * shape.radius)
        case Box():
            return Box(width=size * shape.width, height=size * shape.height)
        case Polygon():
            return Polygon(outline=points(shape.outline))
        case Chain():
            return Chain(points=points(shape.points), thickness=size * shape.thickness)
        case Triangles():
            return Triangles(vertices=points(shape.vertices))
        case Compound():
            element = larger_shape(shape.element, size)
            return Compound(element=element, centers=points(shape.centers))
    raise AssertionError(shape)


# Shapes and bodies


def of_other_kinds(state):
    """Make polygons of boxes, and compounds of one disc of discs."""

    def body(held):
        match held.body.shape:
            case Box() as box:
                shape = Polygon(outline=box.corners())
            case Disc() as disc:
                shape = Compound(element=disc, centers=((0.0, 0.0),))
            case shape:
                pass
        return replace(held, body=replace(held.body, shape=shape))

    return with_bodies(state, body)


def is_splittable(held):
    """Return whether a body can be made of two halves of a box."""
    return is_plain(held) and isinstance(held.body.shape, Box)


def _halves(box):
    """Return the outlines of two halves of a box, cut across its longer side."""
    x, y = box.width / 2, box.height / 2
    if box.width >= box.height:
        cuts = ((-x, -y, 0.0, y), (0.0, -y, x, y))
    else:
        cuts = ((-x, -y, x, 0.0), (-x, 0.0, x, y))
    return [
        ((left, bottom), (right, bottom), (right, top), (left, top))
        for left, bottom, right, top in cuts
    ]


def compounds(state):
    """Make a compound of two halves of each box that forces move."""

    def body(held):
        if not is_splittable(held):
            return held
        box = held.body.shape
        x, y = box.width / 4, box.height / 4
        if box.width >= box.height:
            element, centers = Box(width=2 * x, height=4 * y), ((-x, 0.0), (x, 0.0))
        else:
            element, centers = Box(width=4 * x, height=2 * y), ((0.0, -y), (0.0, y))
        shape = Compound(element=element, centers=centers)
        changed = replace(held.body, shape=shape, mass=held.body.total_mass)
        return replace(held, body=changed)

    return with_bodies(state, body)


def _held_apart(joints, half_of):
    """Yield slack ropes between bodies that do not collide as wholes, where one is a half."""
    count = itertools.count()
    for joint in joints:
        if joint.collide or WORLD in (joint.a, joint.b):
            continue
        parts = [[name, *half_of.get(name, ())] for name in (joint.a, joint.b)]
        for a, b in list(itertools.product(*parts))[1:]:
            yield Joint(
                name=f'slack/{next(count)}',
                kind=JointKind.ROPE,
                a=a,
                b=b,
                seat=Seat(0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0),
                properties=JointProperties(length=1e4),
            )


def welded(state):
    """Make two halves of a few boxes, which a pin holds together."""
    chosen = {held.body.name for held in few_plain(state) if is_splittable(held)}
    bodies, others, joints, half_of = [], [], list(state.joints), {}
    for held in state.bodies:
        if held.body.name not in chosen:
            bodies.append(held)
            continue
        body, (vx, vy, spin) = held.body, held.twist
        mass = body.total_mass / 2
        forces = tuple(
            replace(each, at=(0.0, 0.0)) if each.at is None else each for each in body.forces
        )
        halves = [Polygon(outline=outline) for outline in _halves(body.shape)]
        for number, half in enumerate(halves):
            arm = rotated(half.form.centroid, held.pose[2])
            made = replace(
                body,
                name=f'half/{len(others)}' if number else body.name,
                shape=half,
                mass=mass,
                forces=() if number else forces,
            )
            twist = (vx - spin * arm[1], vy + spin * arm[0], spin)
            (others if number else bodies).append(replace(held, body=made, twist=twist))
        half_of[body.name] = (others[-1].body.name,)
        joints.append(
            Joint(
                name=f'weld/{len(others)}',
                kind=JointKind.PIN,
                a=others[-1].body.name,
                b=body.name,
                seat=Seat(0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0),
                properties=JointProperties(),
            )
        )
    joints += _held_apart(state.joints, half_of)
    return replace(state, bodies=(*bodies, *others), joints=tuple(joints))


# Number of tiles of a floor: more than there are seams under what happens.
TILES = 40
# Heights of tiles beside each other, as shares of that of the floor; their tops lie in one plane.
TILE_HEIGHTS = (1.0, 0.6, 0.8)


def is_floor(state, held):
    """Return whether a body is an anchored box that can be tiled."""
    body = held.body
    joined = any(body.name in (joint.a, joint.b) for joint in state.joints)
    return (
        body.anchored
        and not body.sensor
        and not joined
        and isinstance(body.shape, Box)
        and body.shape.width >= 1.0
        and body.actor is None
    )


def tiled(state):
    """Make floors of tiles, each of another height than its neighbours."""
    bodies, count = [], itertools.count()
    for held in state.bodies:
        if not is_floor(state, held):
            bodies.append(held)
            continue
        box = held.body.shape
        width = box.width / TILES
        for number in range(TILES):
            height = TILE_HEIGHTS[number % len(TILE_HEIGHTS)] * box.height
            tile = Box(width=width, height=height)
            x = (number + 0.5) * width - box.width / 2
            place = local_to_world((x, (box.height - height) / 2), held.pose)
            made = replace(held.body, name=f'tile/{next(count)}', shape=tile)
            bodies.append(replace(held, body=made, pose=(*place, held.pose[2])))
    return replace(state, bodies=tuple(bodies))


# What changes nothing


def _ornament(held, share):
    """Return a small body at the centre of mass of another, with a share of its mass."""
    body = held.body
    form = body.shape.form
    made = Body(
        name=f'ornament/{body.name.replace("/", "_")}',
        shape=Disc(radius=max(0.01 * form.outer, SMALLEST)),
        color=body.color,
        mass=share * body.total_mass,
        density=1.0,
        friction=0.0,
        elasticity=0.0,
        sensor=True,
    )
    place = local_to_world(form.centroid, held.pose)
    return BodyState(body=made, pose=(*place, held.pose[2]), twist=held.twist)


def pinned(state, share):
    """Pin a small body on a few; both together have the mass of the one before."""
    few = few_plain(state)
    chosen = {held.body.name for held in few}

    def body(held):
        if held.body.name not in chosen:
            return held
        mass = held.body.total_mass * (1.0 - share)
        return replace(held, body=replace(held.body, mass=mass))

    ornaments = [_ornament(held, share) for held in few]
    joints = tuple(
        Joint(
            name=f'on/{number}',
            kind=JointKind.PIN,
            a=ornament.body.name,
            b=held.body.name,
            seat=Seat(0.0, 0.0, *held.body.shape.form.centroid, 1.0, 0.0, 0.0, 0.0),
            properties=JointProperties(),
        )
        for number, (held, ornament) in enumerate(zip(few, ornaments, strict=True))
    )
    changed = with_bodies(state, body)
    return replace(
        changed, bodies=(*changed.bodies, *ornaments), joints=(*changed.joints, *joints)
    )


def tied(state, kind, **said):
    """Join a few bodies to a point of the background beside them."""
    joints = []
    for number, held in enumerate(few_plain(state)):
        centroid = held.body.shape.form.centroid
        x, y = local_to_world(centroid, held.pose)
        values = {
            name: value(held.body) if callable(value) else value for name, value in said.items()
        }
        joints.append(
            Joint(
                name=f'tie/{number}',
                kind=kind,
                a=held.body.name,
                b=WORLD,
                seat=Seat(*centroid, x + 1.0, y + 2.0, 1.0, 0.0, 0.0, math.hypot(1.0, 2.0)),
                properties=JointProperties(**values),
            )
        )
    return replace(state, joints=(*state.joints, *joints))


def limited(state):
    """Set limits that are never reached: of forces of all joints, of ways of axles and sliders."""

    def joint(each):
        said = each.properties
        far = {'break_force': 1e9 if said.break_force is None else said.break_force}
        far['max_force'] = 1e9 if said.max_force is None else said.max_force
        if each.kind in {JointKind.AXLE, JointKind.SLIDER}:
            far['lower'] = -1e3 if said.lower is None else said.lower
            far['upper'] = 1e3 if said.upper is None else said.upper
        return joint_properties(each, **far)

    return with_joints(state, joint)


def beside(state, other, by):
    """Put bodies and joints of another world beside those of a world, moved by a vector [m]."""
    names = {WORLD: WORLD} | {held.body.name: f'far/{held.body.name}' for held in other.bodies}
    far = moved(other, by)
    far = with_bodies(
        far, lambda held: replace(held, body=replace(held.body, name=names[held.body.name]))
    )
    far = with_joints(
        far,
        lambda each: with_members(replace(each, name=f'far/{each.name}'), names),
    )
    return replace(state, bodies=(*state.bodies, *far.bodies), joints=(*state.joints, *far.joints))


# Names and orders


def reordered(state):
    """Turn the orders of bodies and joints round."""
    return replace(state, bodies=state.bodies[::-1], joints=state.joints[::-1])


def new_names(state):
    """Return other names of the bodies, by their names, in another alphabetical order."""
    count = len(state.bodies)
    return {held.body.name: f'thing/{count - row}' for row, held in enumerate(state.bodies)}


def renamed(state):
    """Name bodies and joints otherwise."""
    names = new_names(state) | {WORLD: WORLD}

    def actor(of):
        if not isinstance(of, Actor):
            return of
        start = of.start
        said = {key: names[name] for key, name in start.bodies.items()}
        return replace(of, start=replace(start, **said))

    def body(held):
        changed = replace(held.body, name=names[held.body.name], actor=actor(held.body.actor))
        return replace(held, body=changed)

    def joint(each):
        return with_members(replace(each, name=f'link/{each.name.replace("/", "_")}'), names)

    return with_joints(with_bodies(state, body), joint)


def shaken(state, by, seed):
    """Move each body that forces move by a random vector of a length [m]."""
    pick = random.Random(seed)

    def body(held):
        if not held.body.dynamic:
            return held
        angle = pick.uniform(0.0, math.tau)
        x, y, yaw = held.pose
        place = (x + by * math.cos(angle), y + by * math.sin(angle))
        return replace(held, pose=(*place, yaw))

    return with_bodies(state, body)
