"""Search for films that are missing or older than their frames. Needs no Blender."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Iterator
from typing import Any

from .. import timecode
from ..errors import Error
from ..progress import count
from ..run import times
from ..run.content import fingerprint, stamp
from ..shot import passes
from ..shot.runs import scene_runs
from ..shot.shot import Shot
from . import changes
from .fingerprint import Fingerprints
from .picture import Picture, film
from .store import Store

Film = tuple[str, str, dict[str, Any]]
"""Camera, pass, and the fingerprint of the film's inputs."""


def missing(shot: Shot, store: Store, made_with: Fingerprints) -> Iterator[Film]:
    """Find films of two or more pictures that are missing, damaged or out of date.

    A film consists of the finished pictures of a camera and pass that were made with these settings. Pictures
    are checked one by one only if the film or their folder changed since the last check.
    """
    if not shot.settings.render.video:
        return
    filmed = [known_pass.name for known_pass in passes.known().values() if known_pass.film]
    for camera, name, kind in itertools.product(scene_runs.views(shot.settings), filmed, kinds(shot)):
        if (camera, name) not in made_with:
            continue
        key, path = fingerprint(made_with[camera, name]), film(camera, name, kind, codec(shot, kind))
        state = _state(shot, store, camera, name, kind, key)
        if store.note(path) == state:
            continue
        frames = set(shot.frames_of(shot.camera(camera)))
        hashes = store.pictures(camera, name, key, ".png")
        made_from = _film_inputs(
            shot, camera, name, kind, [[frame, hashes[frame]] for frame in hashes if frame in frames]
        )
        if len(made_from["frames"]) > 1 and not store.is_intact(fingerprint(made_from), [path]):
            yield camera, name, made_from
        else:
            with contextlib.suppress(Error):  # a read-only folder
                store.write_note(path, state)


def kinds(shot: Shot) -> tuple[str, ...]:
    """Return the kinds of films that a scene wants."""
    wanted = shot.settings.render.film
    return ("review", "clean") if wanted == "both" else (wanted,)


def codec(shot: Shot, kind: str) -> str:
    """Return the codec of a kind of film: browsers play every review film."""
    return "h264" if kind == "review" else shot.settings.render.film_codec


def changes_of(shot: Shot, store: Store, made_with: Fingerprints) -> list[tuple[str, list[str]]]:
    """List the films to encode: path, and reasons."""
    return [
        (path_of(inputs), changes.of_film(store.inputs_of(path_of(inputs)), inputs))
        for _, _, inputs in missing(shot, store, made_with)
    ]


def left_over(shot: Shot, store: Store, made_with: Fingerprints) -> list[str]:
    """List earlier films of these cameras and passes whose kind or codec is not wanted any more."""
    pictures = []
    for camera, name in made_with:
        every = {film(camera, name)} | {film(camera, name, "clean", each) for each in ("h264", "prores")}
        wanted = {film(camera, name, kind, codec(shot, kind)) for kind in kinds(shot)}
        pictures += [
            path for path in sorted(every - wanted) if store.inputs_of(path) and (store.out / path).is_file()
        ]
    return pictures


def path_of(film_inputs: dict[str, Any]) -> str:
    """Return the path of a film, relative to the output folder."""
    return film(*(film_inputs[key] for key in ("camera", "film", "kind", "codec")))


def first_count(film_inputs: dict[str, Any], shot: Shot) -> int:
    """Return the timecode of a film's first frame or slate, as frames since 00:00:00:00."""
    frame = film_inputs["frames"][0][0] if film_inputs["frames"] else 1
    return timecode.count_of_frame(frame, shot.settings.time.rate) - ("slate" in film_inputs)


def _film_inputs(shot: Shot, camera: str, name: str, kind: str, pictures: list[list[Any]]) -> dict[str, Any]:
    """Collect the inputs of a film: its pictures (frame, hash), frame rate, captions and slate."""
    time, frames = shot.settings.time, shot.frames
    wants_slate = kind == "review" and shot.settings.render.slate.strip()
    rows = _slate(shot, camera, name, [frame for frame, _ in pictures]) if wants_slate else []
    return {
        "film": name,
        "camera": camera,
        "frames": pictures,
        "fps": str(time.rate),
        "kind": kind,
        "codec": codec(shot, kind),
        "timecode": timecode.of_frame(pictures[0][0] if pictures else 1, time.rate),
        "captions": [
            frames.first,
            frames.last,
            frames.count,
            time.zone,
            shot.run_of(camera).synthetic,
        ],
    } | ({"slate": rows} if rows else {})


def _slate(shot: Shot, camera: str, name: str, frames: list[int]) -> list[list[str]]:
    """List the rows of a film's slate: label and text; headlines have no label."""
    time, run, first = shot.settings.time, shot.run_of(camera), frames[0] if frames else 1
    shown = sorted({first, frames[-1] if frames else 1})
    rate = timecode.format_rate(time.rate)
    return [
        ["", " ".join(shot.settings.render.slate.split())],
        ["Shot", f"{camera}, {name}"],
        ["Run", run.name],
        ["Model time", " to ".join(times.text(shot.utc(frame), time.zone, seconds=True) for frame in shown)],
        ["Frames", f"{' to '.join(map(str, shown))}; {count(len(frames), 'picture')}"],
        ["Rate", f"{rate} frames per second, timecode {timecode.of_frame(first, time.rate)}"],
        *([["", "SYNTHETIC"]] if run.synthetic else []),
    ]


def _state(shot: Shot, store: Store, camera: str, name: str, kind: str, key: str) -> str:
    """Hash the stamps of the film and of its pictures' folder, and the settings, as a cheap change detection.

    The cost does not depend on the number of pictures.
    """
    stamps = []
    for path in (
        store.out / film(camera, name, kind, codec(shot, kind)),
        (store.out / Picture(camera, 1, name).file("png")).parent,
    ):
        try:
            stamps.append(list(stamp(path)))
        except OSError:
            stamps.append([])
    frames = shot.camera(camera).frames
    return fingerprint(
        {"film": _film_inputs(shot, camera, name, kind, []), "key": key, "of": frames, "stamps": stamps}
    )
