"""Interchange files of an edit for editing programs: OTIO, Final Cut Pro 7 XML, and EDL."""

from __future__ import annotations

from pathlib import Path

from .. import output, timecode
from ..errors import writing
from ..progress import MessageCallback
from . import edl, fcp_xml, otio
from .cut import Edit

SUFFIXES = (".otio", ".xml", ".edl")


def check(folder: Path, stem: str, overwrite: bool) -> None:
    """Check that the files may be written.

    Raises
    ------
    InputError
        A file there is not Firetwin's.
    """
    for suffix in SUFFIXES:
        output.check(folder / f"{stem}{suffix}", overwrite)


def write(edit: Edit, folder: Path, stem: str, tell: MessageCallback, overwrite: bool = False) -> list[Path]:
    """Write the files, and return their paths; an EDL of a rate without timecode is left out, or removed."""
    texts = dict(zip(SUFFIXES, (otio.text, fcp_xml.text, edl.text), strict=True))
    former = folder / f"{stem}.edl"
    if timecode.nominal_rate(edit.rate) not in edl.RATES:
        del texts[".edl"]
        reason = f"an EDL has no timecode at {timecode.format_rate(edit.rate)} frames per second"
        tell(f"left out {former.name}: {reason}; use {stem}.otio or {stem}.xml, or set fps = 24")
    paths = [folder / f"{stem}{suffix}" for suffix in texts]
    for path, text in zip(paths, texts.values(), strict=True):
        output.write_text(path, text(edit), overwrite)
    if former not in paths and output.is_own(former):
        with writing(former):
            former.unlink()
        tell(f"removed {former} of an earlier edit")
    return paths
