"""Import job: cameras of a file, added to a scene file."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np

from .. import files
from ..did_you_mean import suggestion
from ..errors import InputError, UsageError, input_error
from ..progress import Reporter, count, result, say
from ..shot import run_checks, schema
from ..shot.cameras import track
from ..shot.cameras.rigs import Rig
from ..shot.cameras.rigs.drone import Drone
from ..shot.schema.bounds import LONGEST_NAME
from ..shot.settings import Camera, Settings, toml_update
from ..shot.shot import Shot
from ..shot.source import ShotSource
from . import alembic, kml, move, placing, usd
from .foreign import ForeignScene
from .move import Move

_USD = (".usd", ".usda", ".usdc", ".usdz")
_SUFFIXES = (*_USD, ".abc", ".kml", ".kmz", ".gpx")


def run(arguments: argparse.Namespace, source: ShotSource) -> None:
    """Add the cameras of a file to the scene file of a source.

    Raises
    ------
    UsageError
        The file has no such camera, or a name exists in the scene.
    InputError
        The file cannot be read, or the scene file cannot be written.
    """
    path, suffix = arguments.file, arguments.file.suffix.lower()
    if suffix not in _SUFFIXES:
        raise input_error(path, f"is not one of {', '.join(_SUFFIXES)}; export the camera as one of them")
    if not path.is_file():
        raise input_error(path, "no such file; name a file with cameras")
    shot = source.shot()
    moves = _choose(path, _read(arguments, shot), arguments.camera)
    if moves:
        rigs = [(each.name, _fit(each, shot, arguments.times)) for each in moves]
    elif suffix in (".kml", ".gpx"):
        rigs = [(path.stem, _follow(path, shot, arguments.times))]
    elif suffix == ".kmz":
        raise input_error(path, "has no tour; save it as .kml to follow a track")
    else:
        raise input_error(path, "has no perspective camera; export one")
    if arguments.name and len(rigs) > 1:
        names = ", ".join(name for name, _ in rigs)
        raise UsageError(f"--name: the file has several cameras; choose one with --camera: {names}")
    named = [(arguments.name or _clean(name), rig) for name, rig in rigs]
    settings = _with_cameras(source.settings(), named, arguments.replace)
    _check(path, settings, shot)
    toml_update.save(settings)
    for name, rig in named:
        keys = getattr(rig, "keys", ())
        say(f"camera {name}: {count(len(keys), 'key')}" if keys else f"camera {name}")
    result(arguments.out)


def _read(arguments: argparse.Namespace, shot: Shot) -> list[Move]:
    """Read the moves of a file; empty if it is a track."""
    path, suffix = arguments.file, arguments.file.suffix.lower()
    if suffix == ".gpx":
        return []
    if suffix in (".kml", ".kmz"):
        undulation = 0.0
        if shot.run.vertical != "orthometric":
            undulation = _known_geoid(placing.find_geoid(shot, arguments.geoid))
        return kml.tours(path, shot.ground, undulation)
    reporter = Reporter("cameras")
    try:
        rate = shot.settings.time.rate
        cameras = (
            usd.read(path, reporter)
            if suffix in _USD
            else alembic.read(path, reporter, (rate.numerator, rate.denominator))
        )
    finally:
        reporter.close()
    if cameras.omitted:
        say(f"omitted cameras that are not perspective: {', '.join(cameras.omitted)}")
    return cameras.moves(path, _matrix(arguments, shot, cameras))


def _matrix(arguments: argparse.Namespace, shot: Shot, found: ForeignScene) -> np.ndarray:
    """Compute the matrix (4, 4) from metres of a file to metres of the scene."""
    sidecar = placing.read_sidecar(arguments.file)
    origin = arguments.origin or found.origin or (sidecar[0] if sidecar else None)
    if origin is None:
        say("the file is not georeferenced; it is read with origin and axes of the scene")
        return np.eye(4)
    undulation = placing.find_geoid(shot, arguments.geoid, sidecar[1] if sidecar else None)
    return placing.scene_from(shot, origin, _known_geoid(undulation))


def _known_geoid(undulation: float | None) -> float:
    if undulation is None:
        say(
            "warning: the height of the geoid is unknown and 0 is assumed, so heights are up to 110 m wrong; "
            "give it with --geoid"
        )
    return undulation or 0.0


def _choose(path: Path, moves: list[Move], name: str | None) -> list[Move]:
    if name is None:
        return moves
    chosen = [each for each in moves if each.name == name]
    if not chosen:
        names = [each.name for each in moves]
        listed = ", ".join(names) or "no cameras with a direction of view"
        raise UsageError(f'--camera: {path} has no "{name}", but {listed}{suggestion(name, names)}')
    return chosen[:1]


def _fit(each: Move, shot: Shot, times: str) -> Rig:
    """Fit a rig to a move, and report the frames that it does not cover."""
    rate, last = float(shot.settings.time.rate), shot.frames.count
    frames = move.film_frames(each, times, rate, last)
    if len(frames) > 1 and (frames[0] > 1.001 or abs(frames[-1] - last) > 0.999):
        say(
            f"{each.name} moves in frames {frames[0]:.4g} to {frames[-1]:.4g}, and the film has frames 1 to "
            f"{last}; --times shot spreads it over all frames"
        )
    return move.fit(each, frames, last, shot.local_frame)


def _follow(path: Path, shot: Shot, times: str) -> Rig:
    """Make a drone that follows a track."""
    recorded = track.read(path)
    if times == "own" and (missed := recorded.missed(shot.run, shot.frames)):
        raise input_error(path, missed.replace('write track_times = "start" or "shot"', "add --times shot"))
    folder = shot.settings.path.absolute().parent
    relative = files.relative(path.absolute(), folder)
    say(f"the camera follows the track {path}, and looks ahead; keep the file")
    return Drone(track=folder / relative, track_times=times)


def _clean(name: str) -> str:
    """Change a name of a file to a name of a camera."""
    clean = re.sub(r"[^A-Za-z0-9_-]+", "-", name).strip("-_")[:LONGEST_NAME]
    return clean or "camera"


def _with_cameras(settings: Settings, rigs: Iterable[tuple[str, Rig]], replacing: bool) -> Settings:
    """Add cameras to settings; replaced cameras keep all but their path."""
    cameras = {each.name: each for each in settings.cameras}
    for name, rig in rigs:
        if name in cameras and not replacing:
            raise UsageError(
                f'--name: {settings.path} has a camera "{name}"; choose another name, or add --replace'
            )
        cameras[name] = replace(cameras[name], rig=rig) if name in cameras else Camera(name, rig)
    return replace(settings, cameras=tuple(cameras.values()))


def _check(path: Path, settings: Settings, shot: Shot) -> None:
    """Check settings with the cameras of a file.

    Raises
    ------
    InputError
        A camera is invalid, or far from the run.
    """
    if mistake := schema.validate(settings):
        raise input_error(path, mistake[1])
    try:
        run_checks.check(settings, shot.run)
    except InputError as error:  # the scene file does not have the line of its place
        raise input_error(path, error.reason) from None
