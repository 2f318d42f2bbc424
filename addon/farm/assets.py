"""Files that a job's tasks read: what has to be on every machine. Needs no Blender."""

from __future__ import annotations

import glob
from pathlib import Path

from ..errors import input_error
from ..run import content
from ..shot.shot import Shot
from ..shot.surface import observed, orthophoto


def needed(shot: Shot) -> list[Path]:
    """The scene file and all that it names: absolute paths, each once, in order.

    Raises
    ------
    InputError
        One is missing.
    """
    settings = shot.settings
    found = [settings.path]
    for run in (shot.run, *shot.others.values()):
        found += [Path(run.path) / name for name in content.stamps(run)]
    terrain, labels, stations = settings.terrain, settings.labels, settings.stations
    photo = [terrain.photo, orthophoto.world_file(terrain.photo)] if terrain.photo else []
    optional = [
        terrain.elevation,
        *photo,
        terrain.land_use,
        terrain.buildings,
        terrain.globe,
        labels.file if labels.enabled else None,
    ]
    if stations.enabled:
        optional += [stations.file, stations.footprints, stations.routes_file]
    found += [path for path in optional if path is not None]
    found += [part for path in observed.files(settings) for part in _with_parts(path)]
    found += [path for camera in settings.cameras for path in camera.rig.input_files()]
    found += [path for place in settings.tiles.sources for path in _tileset(settings.path.parent / place)]
    every = sorted({path.absolute() for path in found})
    for path in every:
        if not path.is_file():
            raise input_error(path, "is missing, and tasks of the farm would need it")
    return every


def _with_parts(path: Path) -> list[Path]:
    """A file with those that belong to it: a shapefile has several."""
    beside = path.parent.glob(f"{glob.escape(path.stem)}.*") if path.suffix.lower() == ".shp" else ()
    return [path, *beside]


def _tileset(path: Path) -> list[Path]:
    """Files of a tileset of this machine: an archive, or all of a folder; none of a server's."""
    folder = path.parent if path.suffix.lower() == ".json" else path
    if folder.is_dir():
        return [each for each in folder.rglob("*") if each.is_file()]
    return [path] if path.is_file() else []


def elsewhere(paths: list[Path], folder: Path) -> list[Path]:
    """Those of the files that are not in a folder: every machine must find them at the same path."""
    return [path for path in paths if not path.is_relative_to(folder)]
