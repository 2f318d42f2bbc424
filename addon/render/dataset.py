"""Training data set index ``CAMERA/transforms.json`` in nerfstudio's format.

It lists the frames whose visible picture and sidecar (see `passes.pose`) are finished, with intrinsics
and `transform_matrix`. `passes` lists every finished file of the frame. Cameras without a perspective
projection have no index. ``transforms.json`` of the output folder has the frames of all cameras. `credits`
of a frame name the sources of its tiles. `depth_file_path` and `mask_path` are the files of the pass
`nerfstudio`; as its data parser requires, all frames of an index have them, or none. The file is replaced
atomically when a render ends.
"""

from __future__ import annotations

import functools
import json
from collections import defaultdict
from pathlib import Path, PurePosixPath
from typing import Any

from .. import files
from ..passes import masks
from .store import Store

NAME = "transforms.json"
_LENS = {"width": "w", "height": "h", "fx": "fl_x", "fy": "fl_y", "cx": "cx", "cy": "cy"}


def write(store: Store) -> None:
    """Write the index of every camera that has sidecars."""
    files_of: dict[tuple[str, str], dict[str, list[str]]] = defaultdict(lambda: defaultdict(list))
    for name in store.names():
        camera, kind, *rest = PurePosixPath(name).parts
        if rest:  # films lie next to the folders of passes
            files_of[camera, PurePosixPath(name).stem[-6:]][kind].append(f"{kind}/{rest[0]}")
    frames: dict[str, list[dict[str, Any]]] = defaultdict(list)
    for (camera, _), passes in sorted(files_of.items()):
        shown = next((path for path in passes.get("rgb", ()) if path.endswith(".png")), None)
        if shown and "pose" in passes and (frame := _frame(store.out / camera, shown, passes)):
            frames[camera].append(frame)
    for camera, listed in frames.items():
        _write_index(store.out / camera / NAME, listed)
    merged = [_of_camera(camera, frame) for camera, listed in frames.items() for frame in listed]
    if len(frames) > 1:
        _write_index(store.out / NAME, merged)


def _of_camera(camera: str, frame: dict[str, Any]) -> dict[str, Any]:
    """Return an entry of a camera's index with paths relative to the output folder."""
    passes = {kind: [f"{camera}/{path}" for path in paths] for kind, paths in frame["passes"].items()}
    return frame | {"file_path": f"{camera}/{frame['file_path']}", "camera": camera, "passes": passes}


def _write_index(path: Path, frames: list[dict[str, Any]]) -> None:
    if all("nerfstudio" in frame["passes"] for frame in frames):
        frames = [frame | _training_files(frame["passes"]["nerfstudio"]) for frame in frames]
    index = {"camera_model": "OPENCV", "classes": dict(enumerate(masks.NAMES)), "frames": frames}
    files.write(path, functools.partial(_write_text, json.dumps(index, indent=1) + "\n"))


def _training_files(paths: list[str]) -> dict[str, str]:
    """Return the keys of the depth and mask files of a frame."""
    named = {"depth_file_path": ".npy", "mask_path": ".png"}
    return {key: path for key, suffix in named.items() for path in paths if path.endswith(suffix)}


def _write_text(text: str, part: Path) -> None:
    part.write_text(text, encoding="utf-8", newline="\n")


def _frame(folder: Path, shown: str, passes: dict[str, list[str]]) -> dict[str, Any] | None:
    """Make the index entry of one frame; None if its projection is parallel or its sidecar is missing."""
    try:
        sidecar = files.read_json(folder / passes["pose"][0])
    except (OSError, ValueError):
        return None
    lens, words = sidecar["intrinsics"], [*sidecar.get("services", []), *sidecar.get("credits", [])]
    if lens["projection"] != "perspective":
        return None
    bent = {name: lens["distortion"][name] for name in ("k1", "k2", "p1", "p2")}
    return {
        "file_path": shown,
        "transform_matrix": sidecar["pose"]["camera_to_world"],
        **{ours: lens[name] for name, ours in _LENS.items()},
        **bent,
        "time_utc": sidecar["time_utc"],
        "passes": passes,
        **({"credits": words} if words else {}),
    }
