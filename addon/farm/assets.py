"""Files that the tasks of a job read, and that every machine needs. Runs without Blender."""

from __future__ import annotations

import glob
import itertools
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from .. import limits
from ..errors import InputError, input_error
from ..run import content
from ..shot import scene_inputs
from ..shot.shot import Shot
from ..shot.surface import observed, orthophoto
from ..tiles.sources.local import relative

_REFERENCE = re.compile(rb'"(?:uri|url)"\s*:\s*"([^"]+)"')


def list_assets(shot: Shot) -> list[Path]:
    """List the scene file and all files that it names: absolute paths, sorted, without duplicates.

    Raises
    ------
    InputError
        A file is missing.
    """
    settings = shot.settings
    paths = [settings.path]
    for run in (shot.run, *shot.others.values()):
        paths += [Path(run.path) / name for name in content.stamps(run)]
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
    paths += [path for path in optional if path is not None]
    paths += scene_inputs.files(settings)
    paths += [part for path in observed.files(settings) for part in _with_parts(path)]
    paths += [path for camera in settings.cameras for path in camera.rig.input_files()]
    above = settings.path.parent / settings.tiles.root if settings.tiles.root else None
    paths += [
        path for place in settings.tiles.sources for path in _tileset(settings.path.parent / place, above)
    ]
    every = sorted({path.absolute() for path in paths})
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


def _tileset(path: Path, above: Path | None) -> list[Path]:
    """List the files of a local tileset: an archive, or all files of a folder; none for a tile server.

    Parameters
    ----------
    above
        Folder within which the files of a tileset may refer to one another. Files in the same folders as the
        files outside of the tileset to which its documents refer are listed, too.

    Raises
    ------
    InputError
        The files are too many.
    """
    folder = path.parent if path.suffix.lower() == ".json" else path
    if not folder.is_dir():
        return [path] if path.is_file() else []
    files: set[Path] = set()
    waiting = _add(files, folder.rglob("*"), folder)
    listed: set[tuple[Path, str]] = set()
    while above is not None and waiting:
        for place, pattern in {*_outside(waiting.pop(), folder, above)} - listed:
            listed.add((place, pattern))
            waiting += _add(files, place.glob(pattern), folder)
    return sorted(files)


def _add(files: set[Path], paths: Iterable[Path], folder: Path) -> list[Path]:
    """Add files to a tileset in a folder; return the new documents.

    Raises
    ------
    InputError
        The files are too many.
    """
    most = limits.FARM_FILES - len(files) + 1
    new = list(itertools.islice((each for each in paths if each not in files and each.is_file()), most))
    if len(new) == most:
        reason = f"has or needs more than {limits.FARM_FILES:,} files; pack the tileset into a .3tz archive"
        raise input_error(folder, reason)
    files.update(new)
    return [each for each in new if each.suffix.lower() == ".json"]


def _outside(document: Path, folder: Path, above: Path) -> Iterator[tuple[Path, str]]:
    """Return folder and pattern of the references of a document that leave a tileset's folder.

    A reference of an implicit tiling has variables, such as ``../tiles/{level}/{x}.glb``: it means all files
    below its part without variables.
    """
    above, folder = above.resolve(), folder.resolve()
    if not document.resolve().is_relative_to(above):
        return
    base = document.resolve().relative_to(above).as_posix()
    for each in _REFERENCE.findall(document.read_bytes()):
        reference, variable, _ = each.decode("utf-8", "replace").replace("\\/", "/").partition("{")
        try:
            there = above / relative(base, f"{reference}x" if variable else reference, str(document))
        except InputError:
            continue  # the selection of tiles reports it
        if not there.is_relative_to(folder):
            yield there.parent, "**/*" if variable else "*"


def outside_of(paths: list[Path], folder: Path) -> list[Path]:
    """List the files outside a folder, which every machine must find at the same path."""
    return [path for path in paths if not path.is_relative_to(folder)]
