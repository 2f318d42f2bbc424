"""Check of the labels of one sample: masks, boxes, opacity and pose agree."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import files, truth
from .findings import RESUME, Finding
from .truth import SMOKE, Annotation, Box, Truth

KIND = "labels"
TOLERANCE = 0.5  # pixels
_LEAST_ALPHA = 0.05  # opacity of labelled smoke, unless the metadata have another threshold
_ROUNDING = 1.0e-4  # of opacity in 16 bits


def check(folder: Path, sample: Truth) -> Iterator[Finding]:
    """Compare the boxes, pixel counts and opacity of a sample with its masks."""
    for fault in _faults(folder, sample):
        path = truth.name(sample.index)
        yield Finding(KIND, f"{path}: {fault}; {RESUME.format(path=path, folder=folder)}")


def box_of(mask: NDArray[np.bool_]) -> Box | None:
    """Compute the box of a mask (h, w); None if it is empty."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    if not rows.size:
        return None
    return float(columns[0]), float(rows[0]), float(columns[-1] + 1), float(rows[-1] + 1)


def _differs(a: Box, b: Box) -> bool:
    """Return whether two boxes differ by more than half a pixel."""
    return bool(np.abs(np.subtract(a, b)).max() > TOLERANCE)


def _faults(folder: Path, sample: Truth) -> Iterator[str]:
    rotation = np.array(sample.camera.camera_to_world)[:3, :3]
    if not np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-6) or np.linalg.det(rotation) < 0.0:
        yield "camera_to_world is not a rotation"
    ids = [each.id for each in sample.annotations]
    if len(set(ids)) != len(ids) or min(ids, default=1) < 1:
        yield "ids of annotations are repeated or below 1"
    if "masks" not in sample.files:
        return
    masks = files.read_masks(folder, sample.index)
    shape = sample.camera.height, sample.camera.width
    if masks.smoke.shape != shape:
        found = masks.smoke.shape
        yield f"the masks have {found[1]} x {found[0]} pixels, the camera {shape[1]} x {shape[0]}"
        return
    unknown = set(np.unique(masks.smoke)) | set(np.unique(masks.amodal)) | set(np.unique(masks.fire))
    if more := sorted(int(number) for number in unknown - {0} - set(ids)):
        yield f"the masks have ids without an annotation: {', '.join(map(str, more))}"
    alpha = files.read(folder, "alpha", sample.index) if "alpha" in sample.files else None
    for each in sample.annotations:
        yield from _annotation(each, masks, alpha, sample)


def _annotation(
    each: Annotation, masks: files.Masks, alpha: NDArray[np.float32] | None, sample: Truth
) -> Iterator[str]:
    visible, amodal = masks.visible_pixels(each), masks.amodal_pixels(each)
    for name, mask, box, pixels in (
        ("box", visible, each.box, each.pixels),
        ("amodal box", amodal, each.amodal_box, each.amodal_pixels),
    ):
        found = box_of(mask)
        if found is None:
            yield f"annotation {each.id} has no pixels in the mask of its {name}"
        elif _differs(found, box):
            yield f"annotation {each.id} has the {name} {_text(box)}, its mask {_text(found)}"
        elif int(mask.sum()) != pixels:
            yield f"annotation {each.id} has {pixels:,} pixels, its mask {int(mask.sum()):,}"
    if (visible & ~amodal).any():
        yield f"annotation {each.id} has visible pixels outside of its amodal mask"
    if each.category == SMOKE and alpha is not None and visible.any():
        least = sample.labelling.get("smoke", {}).get("alpha", [_LEAST_ALPHA])[0]
        if clear := int((alpha[visible] < least - _ROUNDING).sum()):
            yield f"annotation {each.id} is smoke, but alpha is below {least:g} in {clear:,} of its pixels"


def _text(box: Box) -> str:
    return ", ".join(f"{value:g}" for value in box)
