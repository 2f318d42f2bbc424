"""Build job: builds the scene and saves it as a .blend file."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path

from .. import files
from ..errors import disk_is_full, full_disk_error, input_error, is_nearly_full
from ..progress import READING, MessageCallback, Progress, no_message, notify_if_slow, silent
from ..shot.cameras import camera_warnings
from ..shot.source import ShotSource
from . import worker
from .tiles import imagery, selection
from .tiles.access import TileAccess


def run(
    choice: ShotSource,
    out: Path,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
    access: TileAccess | None = None,
) -> None:
    """Build the scene and save it as `out`, a .blend file.

    Parameters
    ----------
    access
        Access to tiles.

    Raises
    ------
    InputError
        `out` cannot be written, or the scene file or the run is invalid.
    """
    out = out.absolute()
    _writable(out)
    with notify_if_slow(READING):
        choice.shot()
    pack = ("pack", "the .blend file (render makes pictures without one)")
    selection.prepare(choice, (), progress, tell, stop, access, [pack])
    imagery.prepare(choice, (), progress, tell, stop, access)
    worker.run(
        f"{__name__}:in_blender", {"choice": choice.plain(), "out": str(out)}, progress, stop=stop, tell=tell
    )


def _writable(out: Path) -> None:
    """Check before the build that the file can be written."""
    if out.is_dir():
        raise input_error(out, "is a folder; name a file in it that ends in .blend")
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        part = files.temporary_path(out)
        part.touch()
        part.unlink()
    except OSError as error:
        reason = f"cannot be written ({error.strerror}); choose another folder"
        raise input_error(out, reason) from None
    if out.exists() and not os.access(out, os.W_OK):
        raise input_error(out, "is write-protected; choose another name")


def in_blender(choice: dict[str, str], out: str, progress: Progress, tell: MessageCallback) -> None:
    """Build the scene and save it."""
    from ..blender import viewport
    from ..scene.smoke import build as smoke
    from ..smoke import bake
    from . import worker_scene

    shot = ShotSource(**choice).shot()
    for text in (*shot.warnings(), *camera_warnings.mono_vr(shot.settings.cameras)):
        tell(text)
    if shot.settings.smoke.enabled:
        bake.bake(shot, progress)
    worker_scene.build_scene(shot, progress, tell)
    viewport.prepare_file()
    smoke.make_paths_relative(Path(out))
    save(Path(out), relative_remap=False)


def save(out: Path, **how: bool) -> None:
    """Save Blender's current file as `out`, atomically by way of a temporary name.

    Parameters
    ----------
    how
        More arguments for `bpy.ops.wm.save_as_mainfile`.

    Raises
    ------
    InputError
        The disk is full, or the file cannot be written.
    """
    import bpy

    part = files.temporary_path(out)
    bpy.context.preferences.filepaths.save_version = 0
    try:
        bpy.ops.wm.save_as_mainfile(filepath=str(part), compress=True, **how)
        files.publish(part, out)
    except RuntimeError as error:
        if disk_is_full(error) or is_nearly_full(out):
            raise full_disk_error(out) from None
        reason = f"cannot be written: {' '.join(str(error).split())}"
        raise input_error(out, reason) from None
    finally:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)
