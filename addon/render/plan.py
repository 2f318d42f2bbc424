"""Which pictures are asked for, and which of them are finished already. Needs no Blender."""

from __future__ import annotations

from ..errors import UsageError
from ..run.content import fingerprint
from ..shot import frame_list, mount, passes
from ..shot.nearest import suggestion
from ..shot.settings import Camera
from ..shot.shot import Shot
from .fingerprint import Fingerprints
from .picture import Picture
from .store import Store


def pictures(
    shot: Shot, frames: str | None = None, camera: str | None = None, names: str | None = None
) -> list[Picture]:
    """Pictures of the scene file, or those of them that the command line picks, camera by camera.

    With them come those of other cameras that they are made from, before them (see `shot.mount`).

    Parameters
    ----------
    frames
        Such as "1-10"; of each camera's own frames, these. None: all.
    camera
        Only this one.
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
    cameras = [shot.camera(camera)] if camera else settings.cameras
    if not cameras:
        raise UsageError(f"{settings.path} has no [[cameras]], so there is nothing to render")
    chosen = _passes(names) if names is not None else None
    found = [
        Picture(c.name, frame, name)
        for c in cameras
        for frame in _frames(shot, c, wanted)
        for name in chosen or [each.name for each in passes.of_camera(settings, c)]
    ]
    if not found:
        raise UsageError(
            f"--frames {frames}: {' and '.join(c.name for c in cameras)} has none of these frames"
        )
    return _with_given(shot, found)


def rounds(shot: Shot, wanted: list[Picture]) -> list[list[Picture]]:
    """Pictures in their order, up to where some are made from those of other cameras, and from there on."""
    last = {each.camera for each in wanted if _given(shot, each.camera, each.name)}
    parts = [[each for each in wanted if (each.camera in last) is second] for second in (False, True)]
    return [part for part in parts if part]


def _with_given(shot: Shot, found: list[Picture]) -> list[Picture]:
    given = [
        Picture(c, each.frame, name) for each in found for c, name in _given(shot, each.camera, each.name)
    ]
    if not given:
        return found
    cameras, names = [camera.name for camera in shot.cameras], list(passes.known())
    every = sorted(
        {*found, *given}, key=lambda each: (cameras.index(each.camera), each.frame, names.index(each.name))
    )
    return [each for part in rounds(shot, every) for each in part]


def _given(shot: Shot, camera: str, name: str) -> list[tuple[str, str]]:
    """Other cameras and passes that a pass of a camera is made from."""
    taken = mount.taken(shot.settings, shot.cameras, camera, passes.known()[name])
    return [pair for pair in taken.values() if pair[0] != camera]


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
