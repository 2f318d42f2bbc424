"""Render plan: requested pictures, and missing ones among them. Needs no Blender."""

from __future__ import annotations

import itertools
from collections.abc import Collection

from ..did_you_mean import suggestion
from ..errors import Error, UsageError
from ..run.content import fingerprint
from ..shot import passes
from ..shot.runs import scene_runs
from ..shot.schema.frame_list import FrameList
from ..shot.settings import Camera, mount
from ..shot.shot import Shot
from ..smoke import sources
from .fingerprint import Fingerprints
from .picture import Picture
from .store import Store


def pictures(
    shot: Shot,
    frames: str | None = None,
    camera: str | Collection[str] | None = None,
    names: str | None = None,
) -> list[Picture]:
    """List the requested pictures of a scene file, filtered by the command line; by camera, then run.

    Pictures of other cameras that they are composed from are added and come first (see `shot.cameras.mount`).
    Comparisons of runs come last. The passes that they need are added before them.

    Parameters
    ----------
    frames
        Frame numbers such as "1-10", intersected with each camera's own frames; None: all.
    camera
        Only this camera, or these, in all runs; ``camera@run``: in that run.
    names
        Passes such as "rgb,thermal", in place of the scene file's passes.

    Raises
    ------
    UsageError
        An unknown frame, camera or pass, or an empty selection.
    """
    settings = shot.settings
    if frames is not None and not frames.strip():
        raise UsageError("--frames: is empty; give frames, such as 1-10, or omit --frames for all frames")
    try:
        wanted = FrameList(frames or "").frames(shot.frames.count)
    except ValueError as error:
        raise UsageError(f"--frames: {error}") from None
    chosen_cameras = (camera,) if isinstance(camera, str) else camera
    if chosen_cameras is not None:
        for each in chosen_cameras:
            shot.camera(each)  # its error lists the cameras
    elif not settings.cameras:
        raise UsageError(f"{settings.path} has no [[cameras]]; add one to render pictures")
    views = [
        view
        for view in scene_runs.views(shot.settings)
        if chosen_cameras is None or {view, view.partition("@")[0]} & {*chosen_cameras}
    ]
    chosen = _passes(names) if names is not None else ()
    for name, view in itertools.product(chosen, views):
        if reason := passes.refused(passes.known()[name], shot.camera(view), settings):
            raise UsageError(f"--passes: {reason}")
    if chosen and not settings.runs and (alone := [name for name in chosen if passes.compares(name)]):
        raise UsageError(
            f'--passes: "{alone[0]}" compares runs, but {settings.path} has no [[runs]]; add one'
        )
    drawn, compared = [], []
    for view in views:
        camera_of_view = shot.camera(view)
        listed = _frames(shot, camera_of_view, wanted)
        asked = chosen or tuple(each.name for each in passes.of_camera(settings, camera_of_view))
        first = "@" not in view
        made, last = _split_comparisons(asked) if first else (passes.in_other_runs(asked), ())
        drawn += [Picture(view, frame, name) for frame in listed for name in made]
        compared += [Picture(view, frame, name) for frame in listed for name in last]
    if not drawn:
        raise UsageError(
            f"--frames {frames}: {' and '.join(views)} has none of these frames; choose frames of the camera"
        )
    check_marched(shot, drawn)
    return _with_inputs(shot, drawn) + compared


def check_marched(shot: Shot, wanted: list[Picture]) -> None:
    """Check that the smoke of a shot is ray-marched if a pass needs that; scene files cannot tell for a run.

    Raises
    ------
    Error
        It is not.
    """
    marched = (each.name for each in wanted if passes.is_marched(passes.known()[each.name]))
    name = next(marched, None)
    if name is not None and not sources.is_integrated(shot):
        raise Error(
            f"{name} needs smoke that is rendered apart from surfaces, and Cycles or EEVEE renders the smoke "
            f"of this scene; leave {name} out of the passes"
        )


def _split_comparisons(asked: tuple[str, ...]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Split passes of the first run into passes of this run alone, and comparisons with other runs."""
    known = passes.known()
    compared = tuple(name for name in asked if passes.compares(name))
    needed = {need for name in compared for need in known[name].made_from}
    return tuple(name for name in known if name in needed or name in {*asked} - {*compared}), compared


def rounds(shot: Shot, wanted: list[Picture]) -> list[list[Picture]]:
    """Group pictures into rounds of rendering: pictures that need other cameras' pictures come second."""
    last = {
        picture.camera for picture in wanted if _inputs_of_other_cameras(shot, picture.camera, picture.name)
    }
    parts = [
        [picture for picture in wanted if (picture.camera in last) is second] for second in (False, True)
    ]
    return [part for part in parts if part]


def rendered(shot: Shot, wanted: list[Picture]) -> set[tuple[str, str]]:
    """Find the cameras and passes that Blender must render; the others are composed from files."""
    pairs = {(picture.camera, picture.name) for picture in wanted}
    for camera, name in list(pairs):
        pairs |= set(mount.taken(shot.settings, shot.cameras, camera, passes.known()[name]).values())
    own = {picture.camera for picture in wanted}
    rendered = {name for name, each in passes.known().items() if passes.is_rendered(each)}
    return {(camera, name) for camera, name in pairs if camera in own and name in rendered}


def _with_inputs(shot: Shot, pictures: list[Picture]) -> list[Picture]:
    given = [
        Picture(c, each.frame, name)
        for each in pictures
        for c, name in _inputs_of_other_cameras(shot, each.camera, each.name)
    ]
    if not given:
        return pictures
    views, names = scene_runs.views(shot.settings), list(passes.known())
    every = sorted(
        {*pictures, *given}, key=lambda each: (views.index(each.camera), each.frame, names.index(each.name))
    )
    return [each for part in rounds(shot, every) for each in part]


def _inputs_of_other_cameras(shot: Shot, view: str, name: str) -> list[tuple[str, str]]:
    """Return a pass's inputs from other cameras of the same run: (camera, pass)."""
    camera, mark, run = view.partition("@")
    taken = mount.taken(shot.settings, shot.cameras, camera, passes.known()[name])
    return [(c + mark + run, need) for c, need in taken.values() if c != camera]


def missing(store: Store, wanted: list[Picture], made_with: Fingerprints, after: int = 0) -> list[Picture]:
    """Find pictures whose files are missing, damaged, or made with other settings.

    Parameters
    ----------
    after
        Entries of the store up to this number count as missing.
    """
    keys = {which: fingerprint(values) for which, values in made_with.items()}
    return [
        picture
        for picture in wanted
        if not store.is_intact(keys[picture.camera, picture.name], picture.files(), after)
    ]


def _frames(shot: Shot, camera: Camera, asked: list[int]) -> list[int]:
    """Return the requested frames that a camera films."""
    if FrameList(camera.frames).has_all():
        return asked
    own = set(shot.frames_of(camera))
    return [frame for frame in asked if frame in own]


def _passes(text: str) -> tuple[str, ...]:
    names = [name.strip() for name in text.split(",")]
    known = passes.known()
    for name in names:
        if name not in known:
            raise UsageError(f'--passes: "{name}" is not one of {", ".join(known)}{suggestion(name, known)}')
    return tuple(name for name in known if name in names)
