"""A small data set of drawn pictures, for tests of formats, reports and checks."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
from firetwin.dataset import files
from firetwin.dataset import truth as truths
from firetwin.dataset.truth import FIRE, SMOKE, Annotation, CameraPose, Truth
from firetwin.geometry.quaternion import matrices
from firetwin.passes import masks
from PIL import Image

WIDTH, HEIGHT = 64, 48
_SPLITS = {"ridge": "train", "valley": "train", "coast": "test"}


def camera(seed: int) -> CameraPose:
    """Return a camera with any rotation, and a principal point off the centre."""
    random = np.random.default_rng(seed)
    pose = np.eye(4)
    pose[:3, :3] = matrices(random.normal(size=(1, 4)))[0]
    pose[:3, 3] = random.uniform(-2000.0, 2000.0, 3)
    return CameraPose(
        width=WIDTH,
        height=HEIGHT,
        fx=70.0,
        fy=71.0,
        cx=31.2,
        cy=25.1,
        camera_to_world=pose.tolist(),
        latitude=38.9,
        longitude=-120.5,
        ellipsoidal_height_m=1500.0,
        origin_latitude=38.8,
        origin_longitude=-120.4,
        origin_ellipsoidal_height_m=1000.0,
    )


def project(lens: CameraPose, point: np.ndarray) -> np.ndarray:
    """Project a point of the run's local metres as the metadata defines it."""
    pose = np.array(lens.camera_to_world)
    x, y, z = pose[:3, :3].T @ (point - pose[:3, 3])
    return np.array([lens.cx + lens.fx * x / -z, lens.cy - lens.fy * y / -z])


def landmark(lens: CameraPose) -> np.ndarray:
    """Return a point 300 m in front of a camera, off its axis."""
    pose = np.array(lens.camera_to_world)
    return pose[:3, :3] @ np.array([60.0, 40.0, -300.0]) + pose[:3, 3]


def shapes(index: int) -> dict[int, np.ndarray]:
    """Return ragged masks: smoke above fire; every third picture is empty."""
    if index % 3 == 0:
        return {}
    random = np.random.default_rng(index)
    smoke, fire = np.zeros((2, HEIGHT, WIDTH), bool)
    x = int(random.integers(5, 40))
    smoke[4:30, x : x + 20] = random.random((26, 20)) < 0.7
    fire[30:36, x : x + 9] = random.random((6, 9)) < 0.8
    return {SMOKE: smoke, FIRE: fire}


def annotation(number: int, category: int, mask: np.ndarray) -> Annotation:
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    box = float(columns[0]), float(rows[0]), float(columns[-1] + 1), float(rows[-1] + 1)
    pixels = int(mask.sum())
    return Annotation(number, category, box, pixels, box, pixels, 1.0, False, "visible", distance_m=1234.5)


def sample(folder: Path, index: int, place: str) -> Truth:
    """Write the files of one sample, and return its truth."""
    random = np.random.default_rng(1000 + index)
    picture = random.integers(0, 255, (6, 8, 3), np.uint8)
    shown = np.asarray(Image.fromarray(picture).resize((WIDTH, HEIGHT))).copy()
    classes = np.zeros((HEIGHT, WIDTH), np.uint8)
    classes[HEIGHT // 2 :] = masks.GROUND
    ids = np.zeros((HEIGHT, WIDTH, 3), np.uint8)  # smoke, fire, amodal fire
    alpha = np.zeros((HEIGHT, WIDTH), np.uint16)
    listed = []
    for number, (category, mask) in enumerate(shapes(index).items(), 1):
        shown[mask] = 250
        if category == SMOKE:
            ids[mask, 0], classes[mask], alpha[mask] = number, masks.SMOKE, 50_000
        else:
            ids[mask, 1:], classes[mask] = number, masks.FIRE
        listed.append(annotation(number, category, mask))
    written = {}
    for kind, pixels in {"images": shown, "masks": ids, "classes": classes, "alpha": alpha}.items():
        written[kind] = files.name(kind, index)
        (folder / written[kind]).parent.mkdir(parents=True, exist_ok=True)
        Image.fromarray(pixels).save(folder / written[kind])
    moment = datetime(2014, 9, 17, 20, tzinfo=UTC) + timedelta(minutes=7 * index)
    kind = "fire" if listed else ("cloud", "before_ignition")[index % 2]
    truth = Truth(
        index=index,
        camera=camera(index),
        utc=moment.isoformat(),
        model_time_s=420.0 * index,
        seconds_since_ignition=420.0 * index if listed else None,
        annotations=tuple(listed),
        groups={"place": place, "run": f"{place} run", "camera": f"{place} tower {index % 2}"},
        split=_SPLITS[place],
        draw={"kind": kind, "distance": 500.0 * 1.3**index, "values": {"visibility": 30.0 + index}},
        source={"run": place, "licence": "CC0-1.0"},
        files=written,
    )
    truths.write(folder, truth)
    return truth


def data_set(folder: Path, count: int = 9) -> list[Truth]:
    """Write a data set of three places; all pictures of a place are in one split."""
    return [sample(folder, index, list(_SPLITS)[index % 9 // 3]) for index in range(1, 1 + count)]
