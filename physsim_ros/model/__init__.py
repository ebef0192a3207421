# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Values that all folders use, frozen and checked.

NumPy is the most that is imported here. Nothing here moves, reads a clock or knows an engine.
Modules are imported by their names; the packages `shapes`, `requests` and `robots` by their
fronts. Start with `scene` and `requests`.

- Shared by all values: `names`, `colors`, `transform`, `arrays`, `checks`, `errors`, `texts`.
- Descriptions of a world: `shapes`, `body_properties`, `joints`, `robots`, `settings`, `scene`.
- Changes of it: `requests`, and the body that one describes, `body_description`.
- Parts of them that act: `actors`, `media`, `attraction`, `applied_forces`, `latency`, `noise`.
- How values are declared and kept: `declarations`, `sizes`, `weak_cache`.
- States: `snapshot` is shown, with `answer` and `preview`; `timeline` is its place in the past;
  `checkpoint` is saved.
"""
