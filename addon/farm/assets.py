"""Files that the tasks of a job read, and that every machine needs. Runs without Blender."""

from __future__ import annotations

import glob
from pathlib import Path

from ..errors import input_error
from ..run import content
from ..shot.shot import Shot
from ..shot.surface import observed, orthophoto


def list_assets(shot: Shot) -> list[Path]:
    """List the scene file and all files that it names: absolute paths, sorted, without duplicates.

    Raises
    ------
    InputError
        A file is missing.
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
    if settings.tiles.root:
        found += _tileset(settings.path.parent / settings.tiles.root)
    every = sorted({path.absolute() for path in found})
    for path in every:
        if not path.is_file():
            raise input_error(
                path, "is missing, but the farm's tasks need it; restore it, or change the scene file"
            )
    return every


def _with_parts(path: Path) -> list[Path]:
    """List a file and its companions: a shapefile consists of several files."""
    companions = path.parent.glob(f"{glob.escape(path.stem)}.*") if path.suffix.lower() == ".shp" else ()
    return [path, *companions]


def _tileset(path: Path) -> list[Path]:
    """List the files of a local tileset: an archive, or all files of a folder; none for a tile server."""
    folder = path.parent if path.suffix.lower() == ".json" else path
    if folder.is_dir():
        return [each for each in folder.rglob("*") if each.is_file()]
    return [path] if path.is_file() else []


def outside_of(paths: list[Path], folder: Path) -> list[Path]:
    """List the files outside a folder, which every machine must find at the same path."""
    return [path for path in paths if not path.is_relative_to(folder)]
