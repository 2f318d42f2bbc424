"""Final Cut Pro 7 XML (xmeml 4): the cut, a track for each camera, films, and markers.

Source: Apple, Final Cut Pro XML Interchange Format. `in` and `out` of a clip count from the start of its
file, whose timecode is in `file`.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from fractions import Fraction

from .. import timecode
from .cut import CameraFilm, Clip, Edit

_HEADER = '<?xml version="1.0" encoding="UTF-8"?>\n<!DOCTYPE xmeml>\n'


def text(edit: Edit) -> str:
    """Return the content of the file."""
    root = ET.Element("xmeml", version="4")
    sequence = ET.SubElement(root, "sequence", id="sequence-1")
    _add(sequence, "name", edit.name)
    _add(sequence, "duration", edit.length)
    _rate(sequence, edit.rate)
    _timecode(sequence, 1, edit.rate)
    video = ET.SubElement(ET.SubElement(sequence, "media"), "video")
    _format(ET.SubElement(video, "format"), edit.films[0], edit.rate)
    files = {film.camera: f"file-{number}" for number, film in enumerate(edit.films, 1)}
    written: set[str] = set()
    for position, (name, clips) in enumerate(edit.tracks):
        track = ET.SubElement(video, "track")
        _add(track, "name", name)
        for clip in clips:
            item = ET.SubElement(track, "clipitem", id=f"clipitem-{position + 1}-{clip.first}")
            _clip(item, clip, edit.rate, files[clip.film.camera], written)
        _add(track, "enabled", "FALSE" if position else "TRUE")
        _add(track, "locked", "FALSE")
    for marker in edit.markers:
        element = ET.SubElement(sequence, "marker")
        _add(element, "name", marker.words)
        _add(element, "in", marker.frame - 1)
        _add(element, "out", -1)
    ET.indent(root, " ")
    return f"{_HEADER}{ET.tostring(root, encoding='unicode')}\n"


def _clip(item: ET.Element, clip: Clip, rate: Fraction, file: str, written: set[str]) -> None:
    """Fill a clip; the first clip of a film describes the file, later ones refer to it."""
    _add(item, "name", clip.title)
    _add(item, "enabled", "TRUE")
    _add(item, "duration", clip.film.length)
    _rate(item, rate)
    _add(item, "start", clip.first - 1)
    _add(item, "end", clip.end - 1)
    start = clip.film.slate + clip.position
    _add(item, "in", start)
    _add(item, "out", start + clip.length)
    element = ET.SubElement(item, "file", id=file)
    if file not in written:
        written.add(file)
        _file(element, clip.film, rate)


def _file(element: ET.Element, film: CameraFilm, rate: Fraction) -> None:
    _add(element, "name", film.camera)
    _add(element, "pathurl", film.url)
    _rate(element, rate)
    _add(element, "duration", film.length)
    _timecode(element, film.frames[0] - film.slate, rate)
    _format(ET.SubElement(ET.SubElement(element, "media"), "video"), film, rate)


def _format(element: ET.Element, film: CameraFilm, rate: Fraction) -> None:
    """Add the size of pictures."""
    sample = ET.SubElement(element, "samplecharacteristics")
    _rate(sample, rate)
    for tag, value in zip(("width", "height"), film.size, strict=True):
        _add(sample, tag, value)
    _add(sample, "pixelaspectratio", "square")
    _add(sample, "fielddominance", "none")


def _timecode(parent: ET.Element, frame: int, rate: Fraction) -> None:
    """Add the timecode of a frame."""
    element = ET.SubElement(parent, "timecode")
    _rate(element, rate)
    _add(element, "string", timecode.of_frame(frame, rate))
    _add(element, "frame", timecode.count_of_frame(frame, rate))
    _add(element, "displayformat", "DF" if timecode.is_drop_frame(rate) else "NDF")


def _rate(parent: ET.Element, rate: Fraction) -> None:
    element = ET.SubElement(parent, "rate")
    _add(element, "timebase", timecode.nominal_rate(rate))
    _add(element, "ntsc", "TRUE" if rate.denominator > 1 else "FALSE")


def _add(parent: ET.Element, tag: str, value: object) -> None:
    ET.SubElement(parent, tag).text = str(value)
