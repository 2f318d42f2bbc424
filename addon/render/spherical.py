"""Metadata of stereo 360-degree pictures and films (top-bottom, the left eye above), for VR players.

Stills: XMP in the GPano namespace (https://developers.google.com/streetview/spherical-metadata), with the
size of the file. GPano does not support stereo, so the layout of the eyes is in GSpherical. Films: the boxes
`st3d` and `sv3d` of Spherical Video V2
(https://github.com/google/spatial-media/blob/master/docs/spherical-video-v2-rfc.md).
"""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from ..errors import Error, input_error

_XMP = """\
<?xpacket begin="\ufeff" id="W5M0MpCehiHzreSzNTczkc9d"?>
<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">
<rdf:Description rdf:about=""
 xmlns:GPano="http://ns.google.com/photos/1.0/panorama/"
 xmlns:GSpherical="http://ns.google.com/videos/1.0/spherical/"
 GPano:ProjectionType="equirectangular" GPano:UsePanoramaViewer="True" GPano:StitchingSoftware="Firetwin"
 GPano:PoseHeadingDegrees="{heading:.2f}" GPano:PosePitchDegrees="0" GPano:PoseRollDegrees="0"
 GPano:CroppedAreaImageWidthPixels="{width}" GPano:CroppedAreaImageHeightPixels="{height}"
 GPano:FullPanoWidthPixels="{width}" GPano:FullPanoHeightPixels="{height}"
 GPano:CroppedAreaLeftPixels="0" GPano:CroppedAreaTopPixels="0"
 GSpherical:Spherical="True" GSpherical:Stitched="True" GSpherical:StitchingSoftware="Firetwin"
 GSpherical:ProjectionType="equirectangular" GSpherical:StereoMode="top-bottom"/>
</rdf:RDF></x:xmpmeta>
<?xpacket end="r"?>"""
_PNG_START = 8 + 25  # bytes of the signature and of the first chunk, IHDR
_CONTAINERS = frozenset({b"moov", b"trak", b"mdia", b"minf", b"stbl"})
_ENTRY = 78  # bytes of a VisualSampleEntry before the boxes in it (ISO/IEC 14496-12)


def still(path: Path, size: tuple[int, int], heading: float) -> None:
    """Write XMP into a PNG of `size` (width, height) whose centre has this `heading`, degrees."""
    xmp = _XMP.format(width=size[0], height=size[1], heading=heading % 360.0)
    body = b"iTXt" + b"XML:com.adobe.xmp\0\0\0\0\0" + xmp.encode()
    data = path.read_bytes()
    chunk = struct.pack(">I", len(body) - 4) + body + struct.pack(">I", zlib.crc32(body))
    path.write_bytes(data[:_PNG_START] + chunk + data[_PNG_START:])


def film(path: Path) -> None:
    """Insert the boxes into an H.264 film in MP4; data after its `moov` moves, and chunk offsets are updated.

    Raises
    ------
    InputError
        The film has no H.264 track, or would exceed its 32-bit offsets.
    """
    part = path.with_name(path.name + ".part")
    try:
        with path.open("rb") as film, part.open("wb") as made:
            for kind, start, end in _boxes_of_file(film, path.stat().st_size):
                film.seek(start)
                if kind == b"moov":
                    made.write(_moov(film.read(end - start), end))
                else:
                    _copy(film, made, end - start)
        os.replace(part, path)
    except (struct.error, Error) as error:
        raise input_error(path, f"cannot get the metadata of VR films: {error}") from None
    finally:
        part.unlink(missing_ok=True)


def _boxes_of_file(film: BinaryIO, size: int) -> Iterator[tuple[bytes, int, int]]:
    """Yield kind, start and end of each box of a file."""
    place = 0
    while place < size:
        film.seek(place)
        length, kind = struct.unpack(">I4s", film.read(8))
        length = struct.unpack(">Q", film.read(8))[0] if length == 1 else length or size - place
        yield kind, place, place + length
        place += max(length, 8)


def _copy(film: BinaryIO, made: BinaryIO, count: int) -> None:
    while count > 0:
        count -= made.write(film.read(min(count, 2**20)))


def _moov(box: bytes, end: int) -> bytes:
    """Add our boxes to a `moov`, which ends at `end` in the file."""
    body = _edit(b"moov", box[8:], end, 0)
    if _VR_BOXES not in body:
        raise Error("no H.264 track")
    return _box(b"moov", _edit(b"moov", box[8:], end, len(body) + 8 - len(box)))


def _edit(kind: bytes, body: bytes, end: int, growth: int) -> bytes:
    """Add our boxes to a box's body; offsets of chunks from `end` on grow by `growth` bytes."""
    if kind in _CONTAINERS:
        return b"".join(_box(k, _edit(k, b, end, growth)) for k, b in _boxes(body))
    if kind == b"stsd":
        return body[:8] + b"".join(_box(k, _entry(b) if k == b"avc1" else b) for k, b in _boxes(body[8:]))
    if kind in (b"stco", b"co64"):
        count, letter = struct.unpack_from(">I", body, 4)[0], "I" if kind == b"stco" else "Q"
        places = struct.unpack_from(f">{count}{letter}", body, 8)
        return body[:8] + struct.pack(f">{count}{letter}", *(p + growth * (p >= end) for p in places))
    return body


def _entry(body: bytes) -> bytes:
    """Add our boxes to an `avc1`, after its `avcC` and before its optional boxes."""
    inside = [(k, b) for k, b in _boxes(body[_ENTRY:]) if k not in (b"st3d", b"sv3d")]
    return body[:_ENTRY] + b"".join(_box(k, b) + _VR_BOXES * (k == b"avcC") for k, b in inside)


def _boxes(body: bytes) -> Iterator[tuple[bytes, bytes]]:
    place = 0
    while place + 8 <= len(body):
        length, kind = struct.unpack_from(">I4s", body, place)
        length = max(length, 8)
        yield kind, body[place + 8 : place + length]
        place += length


def _box(kind: bytes, body: bytes) -> bytes:
    return struct.pack(">I4s", 8 + len(body), kind) + body


_VR_BOXES = _box(b"st3d", struct.pack(">IB", 0, 1)) + _box(  # 1: top-bottom
    b"sv3d",
    _box(b"svhd", struct.pack(">I", 0) + b"Firetwin\0")
    + _box(
        b"proj",
        _box(b"prhd", struct.pack(">4I", 0, 0, 0, 0))  # yaw, pitch and roll
        + _box(b"equi", struct.pack(">5I", 0, 0, 0, 0, 0)),  # no crop at the four edges
    ),
)
