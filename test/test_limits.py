# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Limits are those that the documents promise, number by number."""

from pathlib import Path

from nav_msgs.msg import Path as PathMessage
from physsim_ros.drawing import cut_shape
from physsim_ros.files import drawing_file, yaml12
from physsim_ros.maps import occupancy_grid
from physsim_ros.model import attraction, body_properties, checks, names, settings, texts
from physsim_ros.model.shapes import validation
from physsim_ros.ros.requests import conversions, parameter_services, request_topics
from physsim_ros.simulation import request_queue
from physsim_ros.simulation.past import amendment
from physsim_ros.simulation.world import capacity
from physsim_ros.sketchpad import autosave, inbox, message
from physsim_ros.sketchpad.messages import worlds
from physsim_ros.sketchpad.server import (
    class_server,
    guarded,
    open_pages,
    page_socket,
    server,
    website,
    world_handlers,
)
import pytest

DOCS = Path(__file__).parents[1] / 'docs'
MIB = 2**20
PROMISES = {
    'interface/codes.md': [
        ('{:,} joints on one body', settings.MOST_JOINTS_ON_BODY),
        ('{:,} topics of robots', capacity.MOST_ROBOT_TOPICS),
        ('{:,} hands', capacity.MOST_HANDS),
        ('{:,} bodies that attract each other', attraction.MOST_ATTRACTING),
        ('more than {:,} requests', request_queue.MOST_WAITING),
        ('{:g} MB of requests', request_queue.MOST_BYTES / 1e6),
        ('Beyond {:,} waiting answers', 2 * request_queue.MOST_WAITING),
        ('more than {:,} samples of a stroke', settings.MOST_SAMPLES),
        ('more than {:,} parameters in a call', parameter_services.MOST_PARAMETERS),
        ('a message above {:g} MiB', max(request_topics.MOST_BYTES.values()) / MIB),
        (
            '(a stroke, or a command of a robot, {:g} MiB;',
            request_topics.MOST_BYTES[PathMessage] / MIB,
        ),
        ('hand {:g} KiB', request_topics.MOST_BYTES_OF_ONE / 2**10),
        ('into more than {:,} pieces', cut_shape.MOST_PIECES),
        ('parts have more than {:,} corners', cut_shape.MOST_CORNERS),
        ('more than {:g} simulated seconds after the request', amendment.LONGEST_AGAIN),
    ],
    'interface/properties.md': [
        ('1 mm .. {:g} km;', validation.LARGEST / 1e3),
        ('{:g} mm .. 100 km;', validation.SMALLEST * 1e3),
        ('centres of a compound | {:,} ', validation.MOST_POINTS),
        ('±1e{:g} m, ±1e7 rad', len(f'{checks.FARTHEST:.0f}') - 1),
        ('torque of a command | 1e{:g} N, N m', len(f'{checks.HEAVIEST:.0f}') - 1),
        ('`lifetime` | 1e{:g} s', len(f'{checks.LONGEST:.0f}') - 1),
        ('`label` | {:,} characters', body_properties.LONGEST_LABEL),
        ('a name | {:,} printable characters', names.LONGEST_NAME),
        ('`text` | {:,} characters', conversions.LONGEST_TEXT),
    ],
    'interface/world_files.md': [
        ('at most {:,} cells', occupancy_grid.MOST_CELLS),
        ('repeat at most {:,} values', yaml12.MOST_REPEATED),
    ],
    'drawing.md': [('and {:,} strokes', drawing_file.MOST_STROKES)],
    'security.md': [('at most {:,} printable characters', texts.LONGEST_WORD)],
    'page_protocol.md': [
        ('| a message | {:g} MiB;', server.MOST_BYTES / MIB),
        ('a request of the page of a class | {:g} KiB;', class_server.MOST_BYTES / 2**10),
        ('an uploaded world; a picture | {:g} MiB;', world_handlers.MOST_UPLOADED / MIB),
        ('Up to {:g} MiB are read', guarded.MOST_READ / MIB),
        ('levels of a message | {:,} ', message.DEEPEST),
        ('each part of a message | {:g} a second,', guarded.RATE),
        ('each part of a message | 200 a second, {:g} at once', guarded.BURST),
        ('wait for the world | {:,};', inbox.CAPACITY),
        ('pages, connections | {:,}, 256;', open_pages.MOST_PAGES),
        ('pages, connections | 64, {:,};', website.MOST_CONNECTIONS),
        ('its scenes | {:g} MiB,', open_pages.MOST_UNREAD / MIB),
        ('a PNG of at most {:g} kB', world_handlers.MOST_PICTURE / 1e3),
        ('an `id` (up to {:,} characters)', message.LONGEST_ID),
        ('`values.yaml`, up to {:g} MiB', worlds.MOST_SHARED / MIB),
        ('in `world_dir`, up to {:g} MiB', autosave.LONGEST / MIB),
        ('no person in the world, four frames a second', 1.0 / page_socket.WATCH_PERIOD == 4.0),
    ],
}


@pytest.mark.parametrize(
    ('document', 'promise', 'value'),
    [(document, *each) for document, promises in PROMISES.items() for each in promises],
)
def test_a_limit_is_the_one_that_is_promised(document, promise, value):
    assert value
    assert promise.format(value) in (DOCS / document).read_text('utf-8')
