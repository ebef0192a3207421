# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Messages of a page: from untrusted text to checked values.

Laws: a message is checked whole, on the server's thread, before the world's thread gets it; what
it asks of the world is one of the world's own requests.

Not here: what is done with a message (`page_session`, `page_drawing`). Start with `envelope`,
then one file a kind: each has its values, and a table of the readers that make them of fields. A
new message is a value, a reader and a row there, and an action of `page_session` or
`page_drawing`.
"""

from __future__ import annotations

from physsim_ros.model.checks import check_key, shown
from physsim_ros.model.errors import Malformed
from physsim_ros.sketchpad.messages import bodies, drawing, joints, watching, worlds
from physsim_ros.sketchpad.messages.bodies import Copy, Submit
from physsim_ros.sketchpad.messages.drawing import Click, DrawWith, Drop, Instead, Stroke, UseHand
from physsim_ros.sketchpad.messages.envelope import Envelope, read_envelope
from physsim_ros.sketchpad.messages.fields import Readers
from physsim_ros.sketchpad.messages.joints import ChangeJoint
from physsim_ros.sketchpad.messages.watching import ShowParts, Watch
from physsim_ros.sketchpad.messages.worlds import (
    ACTIONS,
    ManageWorld,
    Perform,
    ReturnToCourse,
    Seek,
    SetSpeed,
    Share,
    Upload,
)

__all__ = [
    'ACTIONS',
    'OF_VIEWERS',
    'ChangeJoint',
    'Click',
    'Copy',
    'DrawWith',
    'Drop',
    'Envelope',
    'Instead',
    'ManageWorld',
    'Message',
    'Perform',
    'ReturnToCourse',
    'Seek',
    'SetSpeed',
    'Share',
    'ShowParts',
    'Stroke',
    'Submit',
    'Upload',
    'UseHand',
    'Watch',
    'message_from',
    'read_envelope',
]

Message = (
    Submit
    | Stroke
    | Click
    | Drop
    | Instead
    | UseHand
    | DrawWith
    | Copy
    | ChangeJoint
    | Watch
    | Share
    | Upload
    | Perform
    | ManageWorld
    | SetSpeed
    | Seek
    | ReturnToCourse
    | ShowParts
)
# Messages that a page may send which only shows the world.
OF_VIEWERS = (ShowParts, Watch)
# Fields and reader of each type of message.
_READERS: Readers = {
    **drawing.READERS,
    **bodies.READERS,
    **joints.READERS,
    **worlds.READERS,
    **watching.READERS,
}


def message_from(envelope: Envelope) -> Message:
    """
    Return the checked message of an envelope.

    :raises Refusal: it has an unknown type or field, or a value that is out of range
    """
    if envelope.kind not in _READERS:
        raise Malformed(f'there is no message {shown(envelope.kind)}', field='type')
    known, read = _READERS[envelope.kind]
    for key in envelope.fields:
        check_key(key, known)
    message: Message = read(envelope.fields)
    return message
