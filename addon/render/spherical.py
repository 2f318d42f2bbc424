"""Metadata of stereo 360-degree pictures and films (top-bottom, the left eye above), for VR players.

Stills: XMP in the GPano namespace (https://developers.google.com/streetview/spherical-metadata), with the
size of the file. GPano does not support stereo, so the layout of the eyes is in GSpherical. Films: the boxes
`st3d` and `sv3d` of Spherical Video V2
(https://github.com/google/spatial-media/blob/master/docs/spherical-video-v2-rfc.md).
"""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

from ..errors import Error, input_error
from . import mp4_boxes

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
_ENTRY = 78  # bytes of a VisualSampleEntry before the boxes in it (ISO/IEC 14496-12)


def still(path: Path, size: tuple[int, int], heading: float) -> None:
    """Write XMP into a PNG of `size` (width, height) whose centre has this `heading`, degrees."""
    xmp = _XMP.format(width=size[0], height=size[1], heading=heading % 360.0)
    body = b"iTXt" + b"XML:com.adobe.xmp\0\0\0\0\0" + xmp.encode()
    data = path.read_bytes()
    chunk = struct.pack(">I", len(body) - 4) + body + struct.pack(">I", zlib.crc32(body))
    path.write_bytes(data[:_PNG_START] + chunk + data[_PNG_START:])


def film(path: Path) -> None:
    """Insert the boxes into an H.264 film in MP4.

    Raises
    ------
    InputError
        The film has no H.264 track, or would exceed its 32-bit offsets.
    """
    try:
        mp4_boxes.rewrite(path, _moov)
    except (struct.error, Error) as error:
        raise input_error(path, f"cannot get the metadata of VR films: {error}") from None


def _moov(body: bytes) -> bytes:
    """Add our boxes to the body of a `moov`."""
    edited = _edit(body)
    if _VR_BOXES not in edited:
        raise Error("no H.264 track")
    return edited


def _edit(body: bytes) -> bytes:
    """Add our boxes to a container's body."""
    edited = b""
    for kind, inner in mp4_boxes.split(body):
        if kind in mp4_boxes.CONTAINERS:
            inner = _edit(inner)
        elif kind == b"stsd":
            entries = mp4_boxes.split(inner[8:])
            inner = inner[:8] + b"".join(
                mp4_boxes.make(k, _entry(b) if k == b"avc1" else b) for k, b in entries
            )
        edited += mp4_boxes.make(kind, inner)
    return edited


def _entry(body: bytes) -> bytes:
    """Add our boxes to an `avc1`, after its `avcC` and before its optional boxes."""
    inside = [(k, b) for k, b in mp4_boxes.split(body[_ENTRY:]) if k not in (b"st3d", b"sv3d")]
    return body[:_ENTRY] + b"".join(mp4_boxes.make(k, b) + _VR_BOXES * (k == b"avcC") for k, b in inside)


_VR_BOXES = mp4_boxes.make(b"st3d", struct.pack(">IB", 0, 1)) + mp4_boxes.make(  # 1: top-bottom
    b"sv3d",
    mp4_boxes.make(b"svhd", struct.pack(">I", 0) + b"Firetwin\0")
    + mp4_boxes.make(
        b"proj",
        mp4_boxes.make(b"prhd", struct.pack(">4I", 0, 0, 0, 0))  # yaw, pitch and roll
        + mp4_boxes.make(b"equi", struct.pack(">5I", 0, 0, 0, 0, 0)),  # no crop at the four edges
    ),
)
