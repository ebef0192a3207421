# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Maps of map_server in world files: what they are, and what is refused."""

import math
import struct
import zlib

import numpy as np
from physsim_ros.model.errors import BadWorldFile, WorldFull
from PIL import Image
import pytest

from .world_files import load, restored, save, write

MAP = {
    'image': 'maze.pgm',
    'resolution': 0.5,
    'origin': [-1.0, 2.0, 0.0],
    'negate': 0,
    'occupied_thresh': 0.65,
    'free_thresh': 0.25,
}
# The first row is the top one: a wall above, and one cell below on the left.
PIXELS = np.array([[0, 0, 0], [0, 205, 254]], dtype=np.uint8)


def add_map(folder, pixels=PIXELS, **changes):
    """Write map and world file; return the path of the latter."""
    content = {key: value for key, value in (MAP | changes).items() if value is not None}
    lines = [f'{key}: {value}' for key, value in content.items()]
    write(folder, '\n'.join(lines), 'maze.yaml')
    if pixels is not None:
        Image.fromarray(pixels).save(folder / content.get('image', 'maze.pgm'))
    return write(
        folder, 'format: 1\nmap: maze.yaml\nbodies:\n  - {name: a/0, circle: {radius: 0.1}}'
    )


def boxes(state):
    """Return x, y, width, height of the walls, rounded."""
    return [
        tuple(
            round(each, 9)
            for each in (*body.pose[:2], body.body.shape.width, body.body.shape.height)
        )
        for body in state.bodies
        if body.body.anchored
    ]


WALLS = [(-0.75, 2.5, 0.5, 1.0), (0.0, 2.75, 1.0, 0.5)]


def both_ways(found):
    """Return whether these are the two cells and the wall, in one of its two partitions."""
    return found in (WALLS, [(-0.75, 2.25, 0.5, 0.5), (-0.25, 2.75, 1.5, 0.5)])


def test_a_map_is_anchored_boxes_before_the_bodies(folder):
    state = load(add_map(folder))

    assert [body.body.name for body in state.bodies] == ['map/0', 'map/1', 'a/0']
    assert [body.body.anchored for body in state.bodies] == [True, True, False]
    assert both_ways(boxes(state))


def test_a_world_with_a_map_is_saved_with_its_walls(folder):
    state = load(add_map(folder))

    again = load(save(restored(state), folder, 'again'))

    assert boxes(again) == boxes(state)


def test_the_origin_may_be_turned(folder):
    state = load(add_map(folder, pixels=PIXELS[:1], origin=[1.0, 1.0, math.pi / 2]))

    assert state.bodies[0].pose == pytest.approx((0.75, 1.75, math.pi / 2))


@pytest.mark.parametrize(
    'pixels',
    [
        PIXELS,
        np.repeat(PIXELS[..., None], 3, axis=2),
        np.dstack((*[PIXELS] * 3, np.zeros_like(PIXELS))),
        PIXELS.astype(np.uint16) * 257,
        PIXELS > 100,
    ],
    ids=['grey', 'colours', 'clear', '16 bits', '1 bit'],
)
def test_every_kind_of_image_is_read(folder, pixels):
    assert both_ways(boxes(load(add_map(folder, pixels=pixels, image='maze.png'))))


def test_a_plain_pgm_of_text_is_read(folder):
    path = add_map(folder, pixels=None)
    write(folder, 'P2\n# a comment\n3 2\n255\n0 0 0\n0 205 254\n', 'maze.pgm')

    assert both_ways(boxes(load(path)))


def test_negate_turns_light_and_dark_round(folder):
    assert both_ways(boxes(load(add_map(folder, pixels=255 - PIXELS, negate=1))))


def test_what_is_unknown_is_no_wall_and_the_threshold_counts(folder):
    # 205 is 0.196 dark: unknown by these thresholds, and occupied by a lower one.
    assert len(boxes(load(add_map(folder, occupied_thresh=0.19, free_thresh=0.1)))) == 2
    assert len(boxes(load(add_map(folder, pixels=np.full((3, 3), 205, np.uint8))))) == 0
    # 51 is 0.2 dark: no more than the threshold.
    dark = {'pixels': np.full((3, 3), 51, np.uint8), 'negate': 1}
    assert len(boxes(load(add_map(folder, **dark, occupied_thresh=0.2, free_thresh=0.1)))) == 0


def chunk(kind, content=b''):
    checked = kind + content
    return struct.pack('>I', len(content)) + checked + struct.pack('>I', zlib.crc32(checked))


def png(width, height, data=b'', late=()):
    """Return a PNG that claims a size, with one more chunk after its data."""
    header = struct.pack('>IIBBBBB', width, height, 8, 0, 0, 0, 0)
    chunks = [(b'IHDR', header), (b'IDAT', data), *([late] if late else []), (b'IEND',)]
    return b'\x89PNG\r\n\x1a\n' + b''.join(chunk(*each) for each in chunks)


@pytest.mark.parametrize(
    'data',
    [
        png(60_000, 60_000, zlib.compress(bytes(10_000_000))),
        png(5_000, 5_000, zlib.compress(bytes(25_005_000))),
        png(2**31 - 1, 2**31 - 1),
        png(100, 100, zlib.compress(bytes(10))),
        png(0, 0),
        b'P5\n100000 100000\n255\n',
        b'P5\n10 10\n255\n' + bytes(20),
        b'P5\n-3 10\n255\n',
        b'P5\n',
        b'GIF89a' + bytes(100),
        b'',
    ],
    ids=['bomb', 'large', 'huge', 'short', 'empty size', 'huge pgm', 'short pgm', 'negative pgm',
         'no size', 'gif', 'nothing'],
)  # fmt: skip
def test_images_that_are_bombs_or_none_are_refused(folder, data):
    path = add_map(folder, pixels=None)
    (folder / 'maze.pgm').write_bytes(data)

    with pytest.raises(BadWorldFile) as refused:
        load(path)

    assert refused.value.field == 'image'
    assert ' at 0x' not in str(refused.value)


def test_a_file_of_a_gigabyte_is_refused(folder):
    path = add_map(folder, pixels=None)
    with (folder / 'maze.pgm').open('wb') as file:
        file.write(b'P5\n1000 1000\n255\n')
        file.truncate(2**30)

    with pytest.raises(BadWorldFile, match='64 MiB'):
        load(path)


def test_a_map_of_more_walls_than_bodies_is_refused(folder):
    board = np.indices((20, 20)).sum(axis=0) % 2 * 255

    with pytest.raises(WorldFull):
        load(add_map(folder, pixels=board.astype(np.uint8)), max_bodies=100)


@pytest.mark.parametrize(
    ('changes', 'field'),
    [
        ({'image': None}, 'image'),
        ({'image': 3}, 'image'),
        ({'image': 'none.pgm'}, 'image'),
        ({'image': '../outside.pgm'}, 'image'),
        ({'image': '/etc/passwd'}, 'image'),
        ({'image': '.'}, 'image'),
        ({'resolution': None}, 'resolution'),
        ({'resolution': 0}, 'resolution'),
        ({'resolution': -0.05}, 'resolution'),
        ({'resolution': '.nan'}, 'resolution'),
        ({'resolution': 'fine'}, 'resolution'),
        ({'resolution': 99_999}, 'width'),
        ({'origin': [0, 0]}, 'origin'),
        ({'origin': [0, '.inf', 0]}, 'origin'),
        ({'origin': 3}, 'origin'),
        ({'origin': [1e9, 0, 0]}, 'origin'),
        ({'negate': 2}, 'negate'),
        ({'occupied_thresh': 2}, 'occupied_thresh'),
        ({'free_thresh': 0.9}, 'free_thresh'),
        ({'mode': 'raw'}, 'mode'),
    ],
)
def test_maps_that_cannot_be_are_refused_by_field(folder, changes, field):
    path = add_map(folder, pixels=None, **changes)
    if 'image' not in changes:
        Image.fromarray(PIXELS).save(folder / 'maze.pgm')
    (folder / 'outside.pgm').write_bytes(b'P5\n1 1\n255\n0')

    with pytest.raises(BadWorldFile) as refused:
        load(path)

    assert refused.value.field == field


@pytest.mark.parametrize(
    'value', ['none.yaml', '../maze.yaml', '/etc/passwd', '3', '[a]', '""', '"a\\0b"']
)
def test_maps_that_are_not_there_or_lie_elsewhere_are_refused(folder, value):
    inner = folder / 'inner'
    inner.mkdir()
    add_map(folder)

    with pytest.raises(BadWorldFile) as refused:
        load(write(inner, f'format: 1\nmap: {value}'))

    assert refused.value.field == 'map'


def test_a_link_out_of_the_folder_is_refused(folder):
    inner = folder / 'inner'
    inner.mkdir()
    add_map(folder)
    (inner / 'maze.yaml').symlink_to(folder / 'maze.yaml')

    with pytest.raises(BadWorldFile, match='beside'):
        load(write(inner, 'format: 1\nmap: maze.yaml'))


def test_a_map_that_is_no_yaml_is_refused(folder):
    write(folder, '[', 'maze.yaml')

    with pytest.raises(BadWorldFile, match='map is not YAML'):
        load(write(folder, 'format: 1\nmap: maze.yaml'))


def test_a_body_of_the_same_name_as_a_wall_is_refused(folder):
    path = add_map(folder)
    path.write_text(path.read_text().replace('a/0', 'map/1'))

    with pytest.raises(BadWorldFile, match='twice'):
        load(path)


@pytest.mark.parametrize(
    'late', [(b'iCCP',), (b'iCCP', b'x\0'), (b'tRNS',), (b'pHYs',), (b'eXIf', b'x'), (b'acTL',)]
)
def test_a_png_that_a_decoder_stumbles_over_is_refused_or_read(folder, late):
    rows = zlib.compress(b''.join(b'\0' + row.tobytes() for row in PIXELS))
    path = add_map(folder, pixels=None, image='maze.png')
    (folder / 'maze.png').write_bytes(png(3, 2, rows, late))

    try:
        state = load(path)
    except BadWorldFile as refused:
        assert refused.field == 'image'  # noqa: PT017 - some decoders read it
    else:
        assert both_ways(boxes(state))
