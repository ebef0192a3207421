# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Frames as bytes: poses as columns of float32, and the other parts that a page shows.

Law: a frame is encoded once for all pages that show the same parts.

Little endian, each column on a multiple of four bytes::

    u8 version, u8 flags, u16 0, u32 epoch, f64 time [s], f32 speed, u32 n
    f32 x[n] [m], y[n] [m], yaw[n] [rad]                                   of each body's origin
    VELOCITIES  f32 vx[n] [m/s], vy[n] [m/s], spin[n] [rad/s]              of each centre of mass
    CONTACTS    u32 m, u32 steps, i32 a[m], b[m]                           rows, -1 is a wall
                f32 x[m] [m], y[m] [m], nx[m], ny[m], jx[m] [N s], jy[m] [N s]
    FORCES      u32 j, f32 force[j] [N]                                    of each joint
    PULLS       u32 j, f32 fx[j] [N], fy[j] [N]                            of each joint on body b
    SCAN        u32 k, f32 x[k] [m], y[k] [m], hit[k]                      of a laser, see below
    HANDS       u32 h, f32 x[h] [m], y[h] [m], hand x[h] [m], hand y[h] [m]   of each grip
    FIELDS      f32 fx[n] [N], fy[n] [N]                     of media and attraction, on each body

The first point of a scan is the laser; the others are the ends of its beams, 1 where they hit.

`docs/page_protocol.md` tells how a page reads it; `page/frame_codec.js` does.
"""

from __future__ import annotations

from enum import IntFlag
import struct

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.snapshot import Contacts, Frame

VERSION = 2
_HEADER = struct.Struct('<BBHIdfI')
_COUNT = struct.Struct('<I')


class Show(IntFlag):
    """
    The parts of a frame besides the poses.

    A frame has velocities, contacts and forces where a page asks for them, pulls and fields with
    contacts, hands while they drag, and a scan where the page shows a robot's laser. A ghost is a
    frame of a course of events that was left.
    """

    POSES = 0
    VELOCITIES = 1
    CONTACTS = 2
    FORCES = 4
    HANDS = 8
    GHOST = 16
    PULLS = 32
    SCAN = 64
    FIELDS = 128


def encode_frame(frame: Frame, *, epoch: int, show: Show, scan: Floats | None = None) -> bytes:
    """
    Return the message of a frame.

    :param epoch: number of its scene
    :param show: the parts that are asked for; parts that the frame lacks are left out
    :param scan: (k, 3) float64, as `LaserScans` has it; None is none
    """
    snapshot = frame.snapshot
    parts: list[bytes] = [_columns(snapshot.poses)]
    flags = show & Show.GHOST
    if Show.VELOCITIES in show:
        flags |= Show.VELOCITIES
        parts.append(_columns(snapshot.twists))
    if Show.CONTACTS in show and frame.contacts is not None:
        flags |= Show.CONTACTS
        parts.append(_contacts(frame.contacts))
    if Show.FORCES in show and len(snapshot.forces) == len(snapshot.scene.joints):
        flags |= Show.FORCES
        parts += [_COUNT.pack(len(snapshot.forces)), _columns(snapshot.forces[:, None])]
    if snapshot.grips:
        flags |= Show.HANDS
        lines = snapshot.grip_lines.reshape(-1, 4)
        parts += [_COUNT.pack(len(lines)), _columns(lines)]
    if Show.CONTACTS in flags and len(snapshot.pulls) == len(snapshot.scene.joints):
        flags |= Show.PULLS
        parts += [_COUNT.pack(len(snapshot.pulls)), _columns(snapshot.pulls)]
    if scan is not None:
        flags |= Show.SCAN
        parts += [_COUNT.pack(len(scan)), _columns(scan)]
    if Show.CONTACTS in flags and len(snapshot.fields):
        flags |= Show.FIELDS
        parts.append(_columns(snapshot.fields))
    header = _HEADER.pack(
        VERSION, flags, 0, epoch, snapshot.stamp * 1e-9, frame.speed, len(snapshot.poses)
    )
    return b''.join((header, *parts))


def _contacts(contacts: Contacts) -> bytes:
    rows = np.column_stack((contacts.points, contacts.normals, contacts.impulses))
    pairs = np.ascontiguousarray(contacts.pairs.T, dtype='<i4').tobytes()
    counts = _COUNT.pack(len(rows)) + _COUNT.pack(contacts.steps)
    return counts + pairs + _columns(rows)


def _columns(rows: Floats) -> bytes:
    """Return the columns of an array, one after the other, as float32."""
    # A number beyond float32, of a body that is very far away, becomes infinite.
    with np.errstate(over='ignore'):
        return np.ascontiguousarray(rows.T, dtype='<f4').tobytes()
