# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Equal shapes share a form, which goes with the last of them."""

import gc
from weakref import ref

from physsim_ros.model.shapes import Box, Disc, Polygon
from physsim_ros.model.shapes.form_cache import MOST_KEPT

CORNERS = ((0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 4.0), (0.0, 4.0))


def test_equal_shapes_share_a_form_as_long_as_one_of_them_is_there() -> None:
    first, second = Polygon(outline=CORNERS), Polygon(outline=CORNERS)
    assert first.form is second.form
    form = first.form
    del first
    for number in range(3 * MOST_KEPT):
        Polygon(outline=tuple((x + number + 1.0, y) for x, y in CORNERS))

    assert Polygon(outline=CORNERS).form is form


def test_of_shapes_that_are_gone_the_last_forms_are_kept_and_no_others() -> None:
    forms = [ref(Box(width=0.0917, height=1.0 + 0.1 * number).form) for number in range(100)]
    forms += [ref(Disc(radius=0.0917 + number).form) for number in range(100)]
    gc.collect()

    alive = [form() is not None for form in forms]
    assert sum(alive) <= MOST_KEPT
    assert all(alive[-MOST_KEPT:])
