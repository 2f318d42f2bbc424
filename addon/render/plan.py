"""Which pictures are asked for, and which of them are finished already. Needs no Blender."""

from __future__ import annotations

import itertools

from ..errors import UsageError
from ..run.content import fingerprint
from ..shot import passes, scene_runs
from ..shot.cameras import mount
from ..shot.settings import frame_list
from ..shot.settings.did_you_mean import suggestion
from ..shot.settings.settings import Camera
from ..shot.shot import Shot
from .fingerprint import Fingerprints
from .picture import Picture
from .store import Store


def pictures(
    shot: Shot, frames: str | None = None, camera: str | None = None, names: str | None = None
) -> list[Picture]:
    """Pictures of the scene file, or those of them that the command line picks, camera by camera, run by run.

    With them come those of other cameras that they are made from, before them (see `shot.mount`). What
    compares runs comes last, and what it is made from before it whether or not it was named.

    Parameters
    ----------
    frames
        Such as "1-10"; of each camera's own frames, these. None: all.
    camera
        Only this one, in all runs; or as ``camera@run`` in that one.
    names
        Such as "rgb,thermal"; in place of the passes that the scene file gives.

    Raises
    ------
    UsageError
        A frame, camera or pass that is not there, or nothing left to do.
    """
    settings = shot.settings
    if frames is not None and not frames.strip():
        raise UsageError("--frames: is empty; name some, such as 1-10, or leave --frames out for all")
    try:
        wanted = frame_list.parse(frames or "", shot.frames.count)
    except ValueError as error:
        raise UsageError(f"--frames: {error}") from None
    if camera is not None:
        shot.camera(camera)  # says which there are
    elif not settings.cameras:
        raise UsageError(f"{settings.path} has no [[cameras]], so there is nothing to render")
    views = [
        view for view in scene_runs.views(shot.settings) if camera in (None, view, view.partition("@")[0])
    ]
    chosen = _passes(names) if names is not None else ()
    for name, view in itertools.product(chosen, views):
        if reason := passes.refused(passes.known()[name], shot.camera(view), settings.render.engine):
            raise UsageError(f"--passes: {reason}")
    if chosen and not settings.runs and (alone := [name for name in chosen if passes.compares(name)]):
        raise UsageError(f'--passes: "{alone[0]}" compares runs, and {settings.path} has no [[runs]]')
    drawn, compared = [], []
    for view in views:
        camera_of_view = shot.camera(view)
        listed = _frames(shot, camera_of_view, wanted)
        asked = chosen or tuple(each.name for each in passes.of_camera(settings, camera_of_view))
        first = "@" not in view
        made, last = _in_turn(asked) if first else (passes.in_other_runs(asked), ())
        drawn += [Picture(view, frame, name) for frame in listed for name in made]
        compared += [Picture(view, frame, name) for frame in listed for name in last]
    if not drawn:
        raise UsageError(f"--frames {frames}: {' and '.join(views)} has none of these frames")
    return _with_given(shot, drawn) + compared


def _in_turn(asked: tuple[str, ...]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Passes of the first run that are made by themselves, and those that compare it with others."""
    known = passes.known()
    compared = tuple(name for name in asked if passes.compares(name))
    needed = {need for name in compared for need in known[name].made_from}
    return tuple(name for name in known if name in needed or name in {*asked} - {*compared}), compared


def rounds(shot: Shot, wanted: list[Picture]) -> list[list[Picture]]:
    """Pictures in their order, up to where some are made from those of other cameras, and from there on."""
    last = {each.camera for each in wanted if _given(shot, each.camera, each.name)}
    parts = [[each for each in wanted if (each.camera in last) is second] for second in (False, True)]
    return [part for part in parts if part]


def rendered(shot: Shot, wanted: list[Picture]) -> set[tuple[str, str]]:
    """Cameras and passes that Blender renders for these pictures: some are made from others' files alone."""
    pairs = {(each.camera, each.name) for each in wanted}
    for camera, name in list(pairs):
        pairs |= set(mount.taken(shot.settings, shot.cameras, camera, passes.known()[name]).values())
    own = {each.camera for each in wanted}
    rendered = {name for name, each in passes.known().items() if isinstance(each, passes.RenderedPass)}
    return {(camera, name) for camera, name in pairs if camera in own and name in rendered}


def _with_given(shot: Shot, found: list[Picture]) -> list[Picture]:
    given = [
        Picture(c, each.frame, name) for each in found for c, name in _given(shot, each.camera, each.name)
    ]
    if not given:
        return found
    views, names = scene_runs.views(shot.settings), list(passes.known())
    every = sorted(
        {*found, *given}, key=lambda each: (views.index(each.camera), each.frame, names.index(each.name))
    )
    return [each for part in rounds(shot, every) for each in part]


def _given(shot: Shot, view: str, name: str) -> list[tuple[str, str]]:
    """Other cameras of the same run, and passes, that a pass of a camera is made from."""
    camera, mark, run = view.partition("@")
    taken = mount.taken(shot.settings, shot.cameras, camera, passes.known()[name])
    return [(c + mark + run, need) for c, need in taken.values() if c != camera]


def missing(store: Store, wanted: list[Picture], made_with: Fingerprints, after: int = 0) -> list[Picture]:
    """Those of the pictures whose files are not there, are damaged, or were made with other settings.

    Parameters
    ----------
    after
        Only what was entered after this number of the store counts as there.
    """
    keys = {which: fingerprint(values) for which, values in made_with.items()}
    return [
        picture
        for picture in wanted
        if not store.intact(keys[picture.camera, picture.name], picture.files(), after)
    ]


def _frames(shot: Shot, camera: Camera, asked: list[int]) -> list[int]:
    """Those of the frames that a camera films."""
    if not camera.frames.strip():
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
