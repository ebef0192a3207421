# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Worlds of other programs become world files: `python -m physsim_ros.convert FILE`.

`__main__` reads a file, asks `files` for its kind, and hands its `content` to the module of that
kind, which fills a `conversion`: a world file as a mapping, and a list of what has no like here.
Not here: the check of the result, which is that of any world file (`files`). Start with
`conversion`, then `flatland`.
"""
