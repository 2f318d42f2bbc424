"""Pascal VOC: an XML file of boxes for each picture, and lists of pictures by split.

Corners count from 1 and are inclusive: our box 0, 0, 1, 1, the first pixel, is 1, 1, 1, 1. `JPEGImages` has
second names of the pictures (hard links where the file system has them).
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path, PurePosixPath
from xml.etree import ElementTree

from ..truth import CATEGORIES, Annotation, Box, Truth, stem
from . import common

FORMAT = {"help": "voc/: Pascal VOC boxes and lists of pictures"}
ORDER = 30
FOLDER = "voc"
_NAMES = {each.id: each.name for each in CATEGORIES}


def write(set_folder: Path, samples: Sequence[Truth], out: Path) -> None:
    """Write annotations, lists and pictures."""
    folder = out / FOLDER
    (folder / "Annotations").mkdir(parents=True)
    for truth in samples:
        document = ElementTree.ElementTree(_annotation(truth))
        ElementTree.indent(document)
        document.write(folder / "Annotations" / f"{stem(truth.index)}.xml", encoding="utf-8")
        name = PurePosixPath(common.picture(truth))
        common.link(set_folder / name, folder / "JPEGImages" / name.name)
    for split, members in common.by_split(samples).items():
        listed = folder / "ImageSets" / "Main" / f"{split}.txt"
        common.write_lines(listed, [PurePosixPath(common.picture(truth)).stem for truth in members])


def _annotation(truth: Truth) -> ElementTree.Element:
    root = ElementTree.Element("annotation")
    _text(root, "folder", "JPEGImages")
    _text(root, "filename", PurePosixPath(common.picture(truth)).name)
    size = ElementTree.SubElement(root, "size")
    for name, value in (("width", truth.camera.width), ("height", truth.camera.height), ("depth", 3)):
        _text(size, name, value)
    _text(root, "segmented", 0)
    for each in truth.annotations:
        root.append(_object(each))
    return root


def _object(annotation: Annotation) -> ElementTree.Element:
    found = ElementTree.Element("object")
    _text(found, "name", _NAMES[annotation.category])
    _text(found, "pose", "Unspecified")
    _text(found, "truncated", int(annotation.cut_by_edge))
    _text(found, "difficult", 0)
    _text(found, "occluded", int(annotation.visible_fraction < 1.0))
    corners = ElementTree.SubElement(found, "bndbox")
    x0, y0, x1, y1 = annotation.box
    for name, value in zip(("xmin", "ymin", "xmax", "ymax"), (x0 + 1, y0 + 1, x1, y1), strict=True):
        _text(corners, name, f"{value:g}")
    return found


def boxes(path: Path) -> list[tuple[str, Box]]:
    """Read the names and boxes, in our pixels, of a file.

    Raises
    ------
    ValueError
        The file is damaged.
    """
    try:
        root = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        raise ValueError(str(error)) from None
    found = []
    for each in root.iter("object"):
        x0, y0, x1, y1 = (float(each.findtext(f"bndbox/{name}", "nan")) for name in _CORNERS)
        found.append((each.findtext("name", ""), (x0 - 1.0, y0 - 1.0, x1, y1)))
    return found


_CORNERS = "xmin", "ymin", "xmax", "ymax"


def _text(parent: ElementTree.Element, name: str, value: object) -> None:
    ElementTree.SubElement(parent, name).text = str(value)
