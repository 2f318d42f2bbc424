"""Build job: builds the scene and saves it as a .blend file."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from .. import output, unfinished
from ..errors import disk_is_full, full_disk_error, input_error, is_nearly_full
from ..progress import READING, MessageCallback, Progress, count, no_message, notify_if_slow, silent
from ..shot.cameras import camera_warnings
from ..shot.source import ShotSource
from . import worker
from .tiles import imagery, selection
from .tiles.access import TileAccess

if TYPE_CHECKING:
    import bpy

    from ..shot.shot import Shot


def run(
    choice: ShotSource,
    out: Path,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
    access: TileAccess | None = None,
    volumes: bool = False,
    live: bool = False,
) -> None:
    """Build the scene and save it as `out`, a .blend file.

    Parameters
    ----------
    volumes
        Also write the smoke volumes of all frames that cameras film.
    live
        Also build the live scene, and show it in 3D views.
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
    work = partial(in_blender, choice, out, volumes, live)
    missing = worker.run(work, progress, stop=stop, tell=tell)
    if missing:
        scene, have = choice.scene or choice.run, "has" if missing == 1 else "have"
        tell(
            f"{count(missing, 'frame')} of {out.name} {have} no smoke volume yet; to write volumes, choose "
            f"Firetwin > Scene > Smoke of frame in Blender, or run: firetwin bake --volumes {scene}"
        )


def _writable(out: Path) -> None:
    """Check before the build that the file can be written."""
    output.check_blend(out)
    with unfinished.folder(out):
        pass


def in_blender(
    choice: ShotSource, out: Path, volumes: bool, live: bool, progress: Progress, tell: MessageCallback
) -> int:
    """Build the scene and save it; return the number of frames whose smoke volume is missing."""
    from ..blender import viewport
    from ..scene import built
    from ..scene.smoke import notice, volume_files
    from ..shot.settings import scene_file
    from ..shot.stations import station_signs
    from ..smoke import bake
    from . import worker_scene

    shot = choice.shot()
    for text in (*shot.warnings(), *camera_warnings.mono_vr(shot.settings.cameras)):
        tell(text)
    if volumes and shot.settings.smoke.enabled:
        bake.bake(shot, progress)
    stage = worker_scene.build_scene(shot, progress, tell)
    volume_files.store_source(stage, scene_file.portable(choice.settings()), choice.beside)
    landmarks = built.landmarks_text(station_signs.find_moving_points(shot))
    built.store(stage, built.gather(shot, landmarks))
    notice.build(shot, stage)
    if live:
        _build_live(shot, stage.scene, progress, tell)
    viewport.prepare_file()
    filmed = bake.shot_frames(shot) if shot.settings.smoke.enabled else ()
    missing = len(volume_files.missing(stage, filmed))  # before Blender's file is in a temporary folder
    volume_files.make_paths_relative(out)
    save(out, tell)
    return missing


def _build_live(shot: Shot, scene: bpy.types.Scene, progress: Progress, tell: MessageCallback) -> None:
    """Build the live scene, show it in 3D views, and tell what both scenes cost."""
    from ..scene.live import build, cost, switch

    for part in build.steps(shot, scene, tell=tell, progress=progress):
        progress(0, 1, part)
    switch.show_live(scene, True)
    tell(f"film scene in 3D views: {cost.measure(scene, False).text()}")
    tell(f"live scene: {cost.measure(scene, True).text()}")


def save(out: Path, tell: MessageCallback) -> None:
    """Save Blender's current file as `out`, atomically; its relative paths stay as they are.

    Parameters
    ----------
    tell
        Called with a message if a file of others was renamed (see `output.publish_blend`).

    Raises
    ------
    InputError
        The disk is full, or the file cannot be written.
    """
    import bpy

    bpy.context.preferences.filepaths.save_version = 0
    with unfinished.folder(out) as folder:
        try:
            bpy.ops.wm.save_as_mainfile(filepath=str(folder / out.name), compress=True, relative_remap=False)
            if former := output.publish_blend(folder / out.name, out):
                tell(f"{out.name} was not Firetwin's, or had changed; it is now {former.name}")
        except RuntimeError as error:
            if disk_is_full(error) or is_nearly_full(out):
                raise full_disk_error(out) from None
            reason = f"cannot be written: {' '.join(str(error).split())}"
            raise input_error(out, reason) from None
