# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The past of a world: a tree of requests with checkpoints, a cursor on it, cached frames, undo.

Not here: the moment that is shown (`playback`). `past` is the front: undo, redo, reset, courses.
`line` has the requests and checkpoints; `tree` all lines, and the budget of their memory; `cursor`
replays a world to a moment; `frames` caches what was shown; `amendment` changes earlier requests.
Folders other than `simulation` import the names below.

Theory of operation
-------------------

*Nodes.* A node is a request that changed the world, with the run of the world after it: the
checkpoints that were made up to the next request, and the last step that was reached. Its parent
is the request before. The root is the state with which the world began. The requests from the root
to a node, each at its step, decide every bit of the world; two requests after the same one are two
branches. The request of a node never changes, but that of a new root, which then is its state. A
node is added at an end, and removed when nothing uses it.

*The cursor.* A line of events is a node, its tip, with the last step that was reached there, its
head. One line is in force, with flat lists of its nodes and checkpoints, from the oldest that is
kept to the tip. The cursor is a world at a moment of that line: a step, and the number of requests
up to it, the serial of the last one. Everything that a person does with time moves it:

- Rewind, seek and play move it to another moment of the line in force.
- A request adds a node at the cursor, the new tip. If steps or requests lay ahead, that line is
  left as a course, with its number, and the line in force gets the next number.
- Undo moves it to the moment before a gesture. The node before it is the new tip, and the line
  keeps the number of its course. The line with the gesture is kept for redo, until the next
  request.
- Redo moves it back to the line and the moment of the undo.
- The return to a course moves it to that line. The line that was in force is left as a course.
- Reset moves it to a root of its own, with the state that was loaded last. The line before is
  kept, and undo at the root returns to it.

*A course after an undo in it* ends where the undo went, and continues from there. The undone
gesture is lost with the next request, or with the return to another course. Other courses lose
nothing, even if they began in the undone gesture: each is a line with all of its requests.

*Checkpoints* belong to a node; with its moment and the digest of the world, a checkpoint is a
keyframe. At each one the world moves into a space that is built from it, and so does every line
that passes it; a line that parted before it does not. Several lines may run from one node: they
have the same bits, and the first line at a step makes the checkpoint that all lines use. A request
at the step of a checkpoint comes before or after it, which `Node.after` says. The requests alone
decide when a checkpoint is due, not the frames in which steps are made. A checkpoint that is asked
for where another line has run on has a node of its own, whose request changes nothing.

*Dropping.* The tree counts the users of each node: its children and the lines that end with it. A
node without users is removed. The oldest checkpoint of the line in force is the root of all
moments that can be shown: when it is dropped, the next one replaces it, and lines that part before
that are lost. `Past` has the order in which things are dropped.

*Frames.* A course that is left keeps those that only it has shown; a page draws its bodies from
them. The frames of the line in force are in the frame cache.

Source: Driscoll, Sarnak, Sleator, Tarjan, "Making data structures persistent", 1989, full
persistence. Editors know such a tree as an undo tree.
"""

from physsim_ros.simulation.past.amendment import amend, take_back
from physsim_ros.simulation.past.line import CachedFrame, Moment, Node
from physsim_ros.simulation.past.past import Past
from physsim_ros.simulation.past.tree import DEFAULT_MEMORY, LEAST_MEMORY, MOST_MEMORY

__all__ = [
    'DEFAULT_MEMORY',
    'LEAST_MEMORY',
    'MOST_MEMORY',
    'CachedFrame',
    'Moment',
    'Node',
    'Past',
    'amend',
    'take_back',
]
