"""Boxes of films: they split as they were made, and offsets follow data that moves."""

import struct

from firetwin.render import mp4_boxes
from hypothesis import given
from hypothesis import strategies as st

KINDS = st.sampled_from([b"mvhd", b"udta", b"free"])


@given(st.lists(st.tuples(KINDS, st.binary(max_size=20))))
def test_bodies_split_as_they_were_made(parts):
    body = b"".join(mp4_boxes.make(kind, inner) for kind, inner in parts)
    assert list(mp4_boxes.split(body)) == parts


@given(added=st.binary(max_size=30), wide=st.booleans(), first=st.booleans())
def test_offsets_of_chunks_find_their_data_after_a_rewrite(added, wide, first, tmp_path_factory):
    """The data stand before or after `moov`, and offsets have 32 or 64 bits."""
    kind, letter = (b"co64", "Q") if wide else (b"stco", "I")

    def movie(place):
        table = mp4_boxes.make(kind, struct.pack(f">2I{letter}", 0, 1, place))
        for name in (b"stbl", b"minf", b"mdia", b"trak"):
            table = mp4_boxes.make(name, table)
        return mp4_boxes.make(b"moov", table)

    data = mp4_boxes.make(b"mdat", b"frame")
    place = 8 if first else len(movie(0)) + 8
    path = tmp_path_factory.mktemp("film") / "film.mp4"
    path.write_bytes(data + movie(place) if first else movie(place) + data)
    mp4_boxes.rewrite(path, lambda body: mp4_boxes.make(b"udta", added) + body, b"more")
    rewritten = path.read_bytes()
    with path.open("rb") as film:
        _, start, end = next(
            part for part in mp4_boxes.of_file(film, len(rewritten) - len(b"more")) if part[0] == b"moov"
        )
    body = rewritten[start + 8 : end]
    assert mp4_boxes.find(body, b"udta") == added
    found = mp4_boxes.find(body, b"trak", b"mdia", b"minf", b"stbl", kind)
    (offset,) = struct.unpack_from(f">{letter}", found, 8)
    assert rewritten[offset : offset + 5] == b"frame"
    assert rewritten.endswith(b"more")
