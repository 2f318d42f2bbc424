"""Films and EXR sequences of an output folder of `firetwin render`, for an edit."""

from __future__ import annotations

import os
from pathlib import Path, PurePosixPath
from typing import Any
from urllib.parse import quote

from .. import timecode
from ..cuts.cut import CameraFilm, ImageSequence
from ..errors import Error, input_error
from ..render import manifest
from ..render.picture import FILM_SUFFIXES
from ..shot import passes
from ..shot.shot import Shot

COMPOSITING = "comp"
"""Pass of layers for compositors."""


def films(shot: Shot, name: str, film: Path, out: Path) -> list[CameraFilm]:
    """Find the film of each camera in a pass, in the order of the scene.

    A clean film replaces the review film. Panoramas and views of comparison runs are omitted.

    Parameters
    ----------
    film
        Output folder of `firetwin render`.
    out
        Folder of the edit.

    Raises
    ------
    InputError
        The folder has no films of these cameras, or a film's frame rate differs from the scene's.
    """
    content = manifest.read(film)
    entries = {path: entry for path, entry in content["files"].items() if _is_file(film, path)}
    by_camera = []
    for camera in shot.settings.cameras:
        path = _film(entries, camera.name, name)
        if path is None or camera.rig.around:
            continue
        made_from = content["settings"].get(entries[path].get("settings"), {})
        frames = tuple(frame for frame, _ in made_from.get("frames", ()))
        _check(film / path, made_from, frames, shot)
        size = passes.known()[name].size(shot.resolution(camera))
        sequences = {
            key: each
            for key in dict.fromkeys((name, COMPOSITING))
            if (each := _sequence(entries, camera.name, key, film, out))
        }
        slate = entries[path].get("slate_frames", 0)
        by_camera.append(CameraFilm(camera.name, url(film / path, out), frames, size, sequences, slate))
    if not by_camera:
        remedy = "run firetwin render with [render] video = true"
        raise input_error(film, f'has no film of the pass "{name}" of these cameras; {remedy}')
    return by_camera


def url(path: Path, folder: Path) -> str:
    """Return the address of a file relative to a folder, percent-encoded; absolute on another drive."""
    try:
        return quote(Path(os.path.relpath(path, folder)).as_posix())
    except ValueError:
        return path.absolute().as_uri()


def _is_file(folder: Path, path: str) -> bool:
    return (folder / path).resolve().is_relative_to(folder.resolve()) and (folder / path).is_file()


def _film(entries: dict[str, dict[str, Any]], camera: str, name: str) -> str | None:
    """Return the path of a camera's film in a pass, preferably the clean one, relative to the folder."""
    kinds = {
        entry.get("film", "review"): path
        for path, entry in sorted(entries.items())
        if path.endswith(FILM_SUFFIXES) and (entry.get("camera"), entry.get("pass")) == (camera, name)
    }
    return kinds.get("clean", kinds.get("review"))


def _check(path: Path, made_from: dict[str, Any], frames: tuple[int, ...], shot: Shot) -> None:
    """Check the frames and the rate of a film.

    Raises
    ------
    InputError
        The film has no list of frames, or another frame rate than the scene.
    """
    if not frames:
        raise input_error(path, "has no list of frames in manifest.json; render it again with --resume")
    rate = shot.settings.time.rate
    if made_from.get("fps") != str(rate):
        reason = f"does not have the {timecode.format_rate(rate)} frames per second of the scene"
        raise input_error(path, f"{reason}; render it again with --resume")


def _sequence(
    entries: dict[str, dict[str, Any]], camera: str, name: str, film: Path, out: Path
) -> ImageSequence | None:
    """Find the EXR files of a camera in a pass; None without any."""
    frames = {
        entry["frame"]: PurePosixPath(path)
        for path, entry in entries.items()
        if path.endswith(".exr") and (entry.get("camera"), entry.get("pass")) == (camera, name)
    }
    if not frames:
        return None
    frame, path = next(iter(frames.items()))
    prefix, mark, suffix = path.name.rpartition(f"{frame:06d}")
    if not mark:
        raise Error(f"{path} does not have six digits of frame {frame}; render it again")
    folder = url(film / path.parent, out) + "/"
    return ImageSequence(folder, prefix, suffix, frozenset(frames))
