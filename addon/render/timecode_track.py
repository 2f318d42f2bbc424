"""Timecode track (`tmcd`) of MP4 and QuickTime films, as in Apple's QuickTime File Format Specification."""

from __future__ import annotations

import struct
from fractions import Fraction
from pathlib import Path

from .. import timecode
from ..errors import Error, input_error
from . import mp4_boxes

_UNITY = struct.pack(">9i", 0x10000, 0, 0, 0, 0x10000, 0, 0, 0, 0x40000000)  # identity matrix


def add(path: Path, count: int, rate: Fraction) -> None:
    """Add a timecode track to a film without one; its pictures stay as they are.

    Parameters
    ----------
    count
        Frames since 00:00:00:00 of the first picture (see `timecode.count_of_frame`).

    Raises
    ------
    InputError
        The film has no video track.
    """
    sample = mp4_boxes.make(b"mdat", struct.pack(">I", count))
    place = path.stat().st_size + 8
    try:
        mp4_boxes.rewrite(path, lambda moov: _with_track(moov, place, rate), sample)
    except (struct.error, Error) as error:
        raise input_error(path, f"cannot get a timecode track: {error}") from None


def _with_track(moov: bytes, place: int, rate: Fraction) -> bytes:
    """Add the track to a `moov`, and a reference to it in the video track; the sample is at `place`."""
    header = mp4_boxes.find(moov, b"mvhd")
    if header is None or header[0] != 0:
        raise Error("no movie header of version 0")
    length = struct.unpack_from(">I", header, 16)[0]
    number = struct.unpack_from(">I", header, 96)[0]
    boxes, has_video = b"", False
    for kind, body in mp4_boxes.split(moov):
        if kind == b"mvhd":
            body = body[:96] + struct.pack(">I", number + 1)
        elif kind == b"trak" and not has_video and _is_video(body):
            has_video = True
            frames = struct.unpack_from(
                ">2I", mp4_boxes.find(body, b"mdia", b"minf", b"stbl", b"stsz") or b"", 4
            )[1]
            body += mp4_boxes.make(b"tref", mp4_boxes.make(b"tmcd", struct.pack(">I", number)))
            boxes += mp4_boxes.make(kind, body)
            kind, body = b"trak", _track(number, length, frames, place, rate)
        boxes += mp4_boxes.make(kind, body)
    if not has_video:
        raise Error("no video track")
    return boxes


def _is_video(track: bytes) -> bool:
    handler = mp4_boxes.find(track, b"mdia", b"hdlr")
    return handler is not None and handler[8:12] == b"vide"


def _track(number: int, length: int, frames: int, place: int, rate: Fraction) -> bytes:
    """Make the body of the track: one sample, the number of the first frame, for all pictures."""
    step = rate.denominator if rate.denominator > 1 else 100  # 2400/100 for 24, as is usual
    scale = int(rate * step)
    flags = timecode.is_drop_frame(rate) | 2  # 2: begins again after 24 hours
    entry = struct.pack(">6xHI", 1, 0) + struct.pack(">3IBx", flags, scale, step, timecode.nominal_rate(rate))
    tables = (
        mp4_boxes.make(b"stsd", struct.pack(">2I", 0, 1) + mp4_boxes.make(b"tmcd", entry))
        + mp4_boxes.make(b"stts", struct.pack(">4I", 0, 1, 1, frames * step))
        + mp4_boxes.make(b"stsc", struct.pack(">5I", 0, 1, 1, 1, 1))
        + mp4_boxes.make(b"stsz", struct.pack(">3I", 0, 4, 1))
        + mp4_boxes.make(b"co64", struct.pack(">2IQ", 0, 1, place))
    )
    text = struct.pack(">I3H2x6H", 0, 0, 0, 12, 0, 0, 0, 0xFFFF, 0xFFFF, 0xFFFF) + b"\0"  # how to draw it
    general = mp4_boxes.make(b"gmin", struct.pack(">I6H", 0, 0x40, 0x8000, 0x8000, 0x8000, 0, 0))
    general += mp4_boxes.make(b"tmcd", mp4_boxes.make(b"tcmi", text))
    data = mp4_boxes.make(b"dref", struct.pack(">2I", 0, 1) + mp4_boxes.make(b"url ", struct.pack(">I", 1)))
    media = (
        mp4_boxes.make(b"mdhd", struct.pack(">5I2H", 0, 0, 0, scale, frames * step, 0x55C4, 0))
        + mp4_boxes.make(b"hdlr", struct.pack(">2I4s12x", 0, 0, b"tmcd") + b"Firetwin\0")
        + mp4_boxes.make(
            b"minf",
            mp4_boxes.make(b"gmhd", general)
            + mp4_boxes.make(b"dinf", data)
            + mp4_boxes.make(b"stbl", tables),
        )
    )
    header = struct.pack(">6I", 3, 0, 0, number, 0, length)  # 3: enabled, in the movie
    header += bytes(8) + bytes(8) + _UNITY + bytes(8)
    return mp4_boxes.make(b"tkhd", header) + mp4_boxes.make(b"mdia", media)
