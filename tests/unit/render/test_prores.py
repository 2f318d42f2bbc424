"""Colour tags in frames of ProRes: each frame gets them, wherever its chunk lies; other films are refused."""

import struct

import pytest
from firetwin.errors import InputError
from firetwin.render import mp4_boxes, prores

LENGTHS = (40, 50, 60, 44, 48)


def film(path, mark=b"icpf"):
    """Write five frames in chunks of two, two and one, with a gap between them, and return their offsets."""
    data, places = b"", []
    for number, length in enumerate(LENGTHS):
        if number % 2 == 0:
            data += b"gap"
        places.append(8 + len(data))
        data += (struct.pack(">I", length) + mark + bytes([2]) * length)[:length]
    tables = mp4_boxes.make(b"stsz", struct.pack(">8I", 0, 0, len(LENGTHS), *LENGTHS))
    tables += mp4_boxes.make(b"stsc", struct.pack(">8I", 0, 2, 1, 2, 1, 3, 1, 1))
    tables += mp4_boxes.make(b"stco", struct.pack(">5I", 0, 3, *places[::2]))
    for name in (b"stbl", b"minf", b"mdia", b"trak", b"moov"):
        tables = mp4_boxes.make(name, tables)
    path.write_bytes(mp4_boxes.make(b"mdat", data) + tables)
    return places


def test_each_frame_is_tagged_and_nothing_else_changes(tmp_path):
    path = tmp_path / "film.mov"
    places = film(path)
    before = bytearray(path.read_bytes())
    prores.tag_colours(path)
    for place in places:  # SMPTE RDD 36: primaries, transfer function and matrix after 8 + 14 bytes
        before[place + 22 : place + 25] = bytes([1, 1, 1])
    assert path.read_bytes() == bytes(before)


@pytest.mark.parametrize("kind", ["another codec", "no tables", "empty"])
def test_another_film_is_refused_unchanged(tmp_path, kind):
    path = tmp_path / "film.mov"
    film(path, b"avc1")
    if kind != "another codec":
        path.write_bytes(mp4_boxes.make(b"moov", b"") if kind == "no tables" else b"")
    before = path.read_bytes()
    with pytest.raises(InputError, match="is not a ProRes film"):
        prores.tag_colours(path)
    assert path.read_bytes() == before
