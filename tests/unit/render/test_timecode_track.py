"""Timecode track of a film: what a reader of QuickTime files finds in it."""

import struct
from fractions import Fraction

import made_up_film
import pytest
from firetwin.errors import InputError
from firetwin.render import mp4_boxes, timecode_track


@pytest.mark.parametrize(
    ("rate", "whole", "drops"),
    [(Fraction(24), 24, 0), (Fraction(24000, 1001), 24, 0), (Fraction(30000, 1001), 30, 1)],
)
def test_the_track_has_the_count_rate_and_reference(tmp_path, rate, whole, drops):
    path = tmp_path / "film.mp4"
    made_up_film.write(path)
    timecode_track.add(path, 86400, rate)
    data = path.read_bytes()
    with path.open("rb") as opened:
        start, end = next(part[1:] for part in mp4_boxes.of_file(opened, len(data)) if part[0] == b"moov")
    moov = data[start + 8 : end]
    tracks = [body for kind, body in mp4_boxes.split(moov) if kind == b"trak"]
    assert len(tracks) == 2
    assert mp4_boxes.find(tracks[0], b"tref", b"tmcd") == struct.pack(">I", 2)
    assert struct.unpack_from(">I", mp4_boxes.find(moov, b"mvhd"), 96) == (3,)
    entry = mp4_boxes.find(tracks[1], b"mdia", b"minf", b"stbl", b"stsd")[8:]
    flags, scale, step, frames = struct.unpack_from(">3IB", entry, 8 + 8 + 4)
    assert (flags & 1, Fraction(scale, step), frames) == (drops, rate, whole)
    (place,) = struct.unpack_from(">Q", mp4_boxes.find(tracks[1], b"mdia", b"minf", b"stbl", b"co64"), 8)
    assert struct.unpack_from(">I", data, place) == (86400,)
    assert struct.unpack_from(">I", mp4_boxes.find(tracks[1], b"mdia", b"mdhd"), 16)[0] == 5 * step


def test_a_film_without_pictures_is_refused_unchanged(tmp_path):
    path = tmp_path / "film.mp4"
    made_up_film.write(path, b"soun")
    before = path.read_bytes()
    with pytest.raises(InputError, match="no video track"):
        timecode_track.add(path, 0, Fraction(24))
    assert path.read_bytes() == before
