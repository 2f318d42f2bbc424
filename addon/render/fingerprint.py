"""Fingerprint of a picture: hash of all inputs that determine its pixels, to find stale files on resume."""

from __future__ import annotations

import functools
import sys
from dataclasses import replace
from importlib import metadata
from pathlib import Path
from typing import Any

import firetwin_core

from ..progress import Progress, silent
from ..run import content
from ..run.content import fingerprint
from ..shot import comparison, passes, picture_credits, scene_inputs, schema
from ..shot.settings import Camera, Settings, code_fingerprint, mount
from ..shot.shot import Shot
from ..shot.stations import labels, station_signs
from ..shot.surface import globe_picture, land_use, observed, orthophoto
from ..shot.tiles import tile_cut
from ..smoke import sources
from .picture import Picture

Fingerprints = dict[tuple[str, str], dict[str, Any]]
"""Inputs of the pictures, by camera and pass."""

_RENDERING = (
    "blender/text.py",
    "imaging/credits.py",
    "render/credits.py",
    "render/engine.py",
    "render/layers.py",
    "render/pictures.py",
    "render/png.py",
    "render/spherical.py",
    "timecode.py",
)


def collect_inputs(settings: Settings, run: dict[str, str], camera: str, name: str) -> dict[str, Any]:
    """Collect the inputs of a camera's frames in one pass, including settings of the camera that it follows.

    Parameters
    ----------
    run
        Hashes of the run's fields.
    """
    aspects = passes.known()[name].all_aspects
    (mine,) = (each for each in settings.cameras if each.name == camera)
    leader = mine.rig.followed(settings.cameras)
    cameras = [mine] if leader is None else [mine, leader]
    made_with = {
        "versions": versions(),
        "sources": code_fingerprint.hashes(
            aspects, cameras, *_RENDERING, *_modules(name), *_smoke(settings, run, aspects)
        ),
        "run": run,
        "camera": camera,
        "pass": name,
        "settings": schema.select(_built(settings, mine), aspects, camera),
    } | ({"leader": schema.select(settings, {"camera"}, leader.name)} if leader else {})
    taken = mount.taken(settings, settings.cameras, camera, passes.known()[name])
    others = {need: pair for need, pair in taken.items() if pair[0] != camera}
    given = {
        need: [*pair, fingerprint(collect_inputs(settings, run, *pair))] for need, pair in others.items()
    }
    return made_with | ({"given": given} if given else {})


def _smoke(settings: Settings, run: dict[str, str], aspects: frozenset[str]) -> list[str]:
    """List the code files of the smoke source."""
    return sources.choose(settings.smoke.method, run).code_files() if "smoke" in aspects else []


def _built(settings: Settings, camera: Camera) -> Settings:
    """Resolve `render.chunk` for a camera: 0 if all its frames are built at once.

    A build chunk determines the terrain mesh, visible plants, point lights of the flames and firebrands.
    Therefore the pictures of a film in build chunks depend on the frames at which chunks begin. A film of one
    build chunk does not depend on the maximum chunk length.
    """
    chunk = settings.chunk_size(camera)
    return replace(settings, render=replace(settings.render, chunk=chunk))


def _modules(name: str) -> list[str]:
    """List the code files of a pass, and of the passes that it is composed from."""
    each = passes.known()[name]
    return [*passes.code_files(name), *(file for need in each.made_from for file in _modules(need))]


@functools.cache
def versions() -> dict[str, str]:
    """Return the versions of Firetwin and Blender, without loading Blender."""
    if "bpy" in sys.modules:
        blender = ".".join(str(part) for part in sys.modules["bpy"].app.version)
    else:
        try:
            blender = metadata.version("bpy")
        except metadata.PackageNotFoundError:
            blender = "none"
    return {"firetwin": firetwin_core.__version__, "blender": blender}


def compute(shot: Shot, pictures: list[Picture], progress: Progress = silent) -> Fingerprints:
    """Compute the fingerprints of each (camera, pass) of the pictures, and of the passes that they need."""
    asked = {(p.camera, p.name) for p in pictures}
    needed = {(camera, need) for camera, name in asked for need in passes.known()[name].made_from}
    return compute_pairs(shot, asked | needed, progress)


def compute_pairs(shot: Shot, pairs: set[tuple[str, str]], progress: Progress = silent) -> Fingerprints:
    """Compute the fingerprints of each (camera, pass); fields of the runs without a cached hash are read."""
    more = (
        orthophoto.inputs(shot.settings, progress)
        | land_use.inputs(shot.settings, progress)
        | globe_picture.inputs(shot.settings, progress)
        | labels.inputs(shot.settings)
        | station_signs.inputs(shot.settings)
    )
    more |= observed.inputs(shot.settings, progress)
    shots = {
        label: comparison.for_run(shot, label) for label in {view.partition("@")[2] for view, _ in pairs}
    }
    runs = {label: _run_inputs(own, progress) | more for label, own in shots.items()}
    made_with, find = {}, tile_cut.finder(shot)
    for view, name in sorted(pairs):
        label = view.partition("@")[2]
        made_with[view, name] = collect_inputs(shots[label].settings, runs[label], view, name)
        made_with[view, name] |= _other_runs(shots[label], name, progress) | _tiles(shot, view, name, find)
        if further := scene_inputs.inputs(shot.settings, passes.known()[name].all_aspects, progress):
            made_with[view, name] |= {"further": further}
    return made_with


def _run_inputs(shot: Shot, progress: Progress) -> dict[str, str]:
    """Hash the run; runs of other times of one film have one identity."""
    identity = content.identity(Path(shot.run.path))
    if not identity:
        return shot.input_hashes(progress=progress)
    names = content.field_names(shot.run)
    return shot.input_hashes(shot.run.fields, progress) | dict.fromkeys(names, identity)


def _tiles(shot: Shot, view: str, name: str, find: tile_cut.Finder) -> dict[str, Any]:
    """Collect the tiles that a pass shows, and their credits, as far as they are prepared."""
    if "terrain" not in passes.known()[name].all_aspects:
        return {}
    cuts = tile_cut.of_pass(shot, view, name, find)
    words = picture_credits.of_cuts(shot.settings, cuts)
    used: dict[str, Any] = {}
    if words:
        used["credits"] = {"data": list(words.data), "logo": list(words.logo)}
    if cuts:
        used["tiles"] = {
            "chosen": fingerprint({"tiles": [cut.tiles for cut in cuts]}),
            "missing": sorted({reason.partition(": ")[0] for cut in cuts for reason in cut.missing}),
        }
    return used


def _other_runs(shot: Shot, name: str, progress: Progress) -> dict[str, Any]:
    """Collect the inputs of a pass from the other runs that it compares."""
    each = passes.known()[name]
    if not passes.compares(name) and not (shot.settings.fire.fronts and "fire" in each.all_aspects):
        return {}
    cache = shot.settings.cache
    hashes = {label: content.inputs(run, cache, (), progress) for label, run in shot.other_runs().items()}
    return {"beside": hashes} if hashes else {}
