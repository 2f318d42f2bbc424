"""YOLO: a text of boxes for each picture, empty for a negative, `data.yaml`, and a list of pictures by split.

A line is `class cx cy w h`: class from 0, centre and size as fractions of the picture. Trainers find
``labels/000137.txt`` from ``images/000137.jpg``, so the pictures have no second copy.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..truth import Annotation, CameraPose, Truth, stem
from . import common

FORMAT = {"help": "labels/, data.yaml and lists of pictures: YOLO boxes"}
ORDER = 20
FOLDER = "labels"


def write(set_folder: Path, samples: Sequence[Truth], out: Path) -> None:
    """Write the labels, the lists and `data.yaml`."""
    for truth in samples:
        lines = [line(each, truth.camera) for each in truth.annotations]
        common.write_lines(out / FOLDER / f"{stem(truth.index)}.txt", lines)
    splits = common.by_split(samples)
    for name, members in splits.items():
        common.write_lines(out / f"{name}.txt", [f"./{common.picture(truth)}" for truth in members])
    yaml = [f"{name}: {name}.txt" for name in splits]
    if common.UNSPLIT in splits:
        yaml = [f"{name}: {common.UNSPLIT}.txt" for name in ("train", "val")]
    elif "train" in splits and "val" not in splits:  # trainers require it; pictures of tests choose no model
        yaml.append("val: train.txt")
    classes = [f"  {index}: {each.name}" for index, each in enumerate(common.THINGS)]
    common.write_lines(out / "data.yaml", [*yaml, f"nc: {len(classes)}", "names:", *classes])


def line(annotation: Annotation, camera: CameraPose) -> str:
    """Write a box as fractions of the picture."""
    x0, y0, x1, y1 = annotation.box
    values = (
        0.5 * (x0 + x1) / camera.width,
        0.5 * (y0 + y1) / camera.height,
        (x1 - x0) / camera.width,
        (y1 - y0) / camera.height,
    )
    return " ".join([str(common.class_index(annotation)), *(f"{value:.7f}" for value in values)])
