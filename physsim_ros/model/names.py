# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Names of bodies: `<namespace>/<id>`, as markers have them, one spelling a name."""

from __future__ import annotations

import unicodedata

from physsim_ros.model.errors import Malformed

# The background's own name in joints, contacts and frames.
WORLD = 'world'
# What frame names and message strings can reasonably hold.
LONGEST_NAME = 1000
# Control characters, halves of characters, ends of lines and of paragraphs, as Unicode calls them.
# Others that show nothing are part of how Persian and Hindi are written, or join emoji.
_NO_TEXT = {'Cc', 'Cs', 'Zl', 'Zp'}
# What stands before the namespace of a joint in the picture, so that a body and a joint of one
# name do not hide each other; `~/join` knows it. What stands before those of its lines and of the
# x of an anchored body, and the namespace of the walls.
JOINT_PREFIX, LINES_PREFIX, CROSS_PREFIX, WALLS = 'joint:', 'lines:', 'anchor:', 'physsim:bounds'


def check_name(name: str) -> None:
    """
    Refuse a name that is not `<namespace>/<id>`, the id a 32-bit whole number.

    :raises Malformed: it is not, or is too long, or holds a character no message can
    """
    namespace, id_ = split_name(name)
    if not namespace:
        raise Malformed(
            f'{name!r} is not a name: <namespace>/<id>, the id a whole number', field='name'
        )
    if len(name) > LONGEST_NAME:
        raise Malformed(f'a name has at most {LONGEST_NAME} characters', field='name')
    if any(unicodedata.category(character) in _NO_TEXT for character in name):
        raise Malformed(f'{name!r} holds a character that cannot be printed', field='name')
    if not -(2**31) <= id_ < 2**31:
        raise Malformed(f'the id of {name!r} does not fit into 32 bits', field='name')


def check_body_name(name: str) -> None:
    """
    Refuse a name that is none of a body.

    :raises Malformed: it is no name at all, or is one of something else in the picture
    """
    check_name(name)
    if name.startswith((JOINT_PREFIX, LINES_PREFIX, CROSS_PREFIX, WALLS)):
        raise Malformed(f'{name!r} is no body in the picture', field='name')


def split_name(name: str) -> tuple[str, int]:
    """Return namespace and id of a name; the namespace is '' where it is no name."""
    namespace, _, id_ = name.rpartition('/')
    try:
        number = int(id_)
    except ValueError:
        return '', 0
    # One spelling a name: '7', not '07' or '+7', so that a marker leads back to it.
    return (namespace, number) if str(number) == id_ else ('', 0)
