"""Render job for a .blend file in its current state, with edits by hand, passes and resume as in `render`."""

from __future__ import annotations

import hashlib
import itertools
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import Error
from ..progress import MessageCallback, Progress, count, no_message, share, silent
from ..shot.comparison import for_view
from ..shot.shot import Shot
from ..shot.source import ShotSource
from ..shot.tiles import tile_terms
from . import worker
from .render import RenderRequest, count_frames, make, smoke_frames

if TYPE_CHECKING:
    from ..render.fingerprint import Fingerprints
    from ..render.picture import Picture


def run(
    choice: ShotSource,
    blend: Path,
    scene: str,
    asked: RenderRequest,
    progress: Progress = silent,
    tell: MessageCallback = no_message,
    stop: worker.Stop | None = None,
) -> int:
    """Render the requested passes of a scene in a .blend file, then the films; only for the run it shows.

    Parameters
    ----------
    choice
        Source of the shot that the scene was built from. It sets frames, passes, thermal colours and films.
    asked
        With `resume`, pictures already rendered from this file are retained.

    Returns
    -------
    Number of pictures that were rendered.
    """
    from ..render import exr_clock, plan
    from ..render.store import Store, refuse_others
    from ..shot import passes

    shot = choice.shot()
    planned = plan.pictures(shot, *asked.selection())
    wanted = [
        picture for picture in planned if "@" not in picture.camera and not passes.compares(picture.name)
    ]
    tile_terms.check(shot.settings, tile_terms.of_passes(picture.name for picture in wanted))
    refuse_others(asked.out, dict.fromkeys(picture.camera for picture in wanted))
    with blend.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    made_with = _made_with(digest, wanted)
    with Store(asked.out, create=True) as store:
        begun = store.latest_number()
        undone = plan.missing(store, wanted, made_with, 0 if asked.resume else begun)
        if text := exr_clock.update(shot, store, set(wanted) - set(undone), made_with):
            tell(text)
        own = replace(asked, out=asked.out.absolute())
        job = partial(in_blender, choice, blend, scene, own, made_with, begun)
        tell(f"rendering {count(len(undone), 'picture')} of {blend.name} in its current state")
        make(job, undone, store, shot, progress, tell, stop)
    return len(undone)


def _made_with(digest: str, wanted: list[Picture]) -> Fingerprints:
    """Collect fingerprint inputs of pictures of this .blend file, by camera and pass."""
    from ..render.fingerprint import versions
    from ..shot import passes

    pairs = {(p.camera, p.name) for p in wanted}
    pairs |= {(camera, need) for camera, name in pairs for need in passes.known()[name].made_from}
    about = {"versions": versions(), "blend": digest}
    return {(camera, name): {**about, "camera": camera, "pass": name} for camera, name in sorted(pairs)}


def in_blender(
    choice: ShotSource,
    blend: Path,
    scene: str,
    asked: RenderRequest,
    made_with: Fingerprints,
    begun: int,
    pictures: list[Picture],
    owner: str,
    progress: Progress,
    tell: MessageCallback,
) -> None:
    """Open the file, render these pictures of it, then the films of these cameras and passes."""
    import bpy

    from ..blender import devices, owned
    from ..render import engine, layers, plan, sharing, video
    from ..render import pictures as renderer
    from ..scene.smoke import volume_files
    from ..smoke import bake, prefetch, sources
    from . import device

    bpy.ops.wm.open_mainfile(filepath=str(blend), load_ui=False, use_scripts=False)
    stage = owned.stage(bpy.data.scenes[scene])
    layers.repair(stage.scene)
    shot = _with_scene_settings(choice.shot(), stage.scene)
    if shot.settings.smoke.enabled and not sources.is_integrated(shot):
        volume_files.set_folder(stage, bake.folder(shot))  # in which `prefetch` writes missing volumes
    plan.check_marched(shot, pictures)
    if stage.scene.render.engine == "CYCLES":
        devices.use(device.select(shot.settings, count_frames(pictures), tell), stage.scene)
    frames, done, after = count_frames(pictures), 0, 0 if asked.resume else begun
    with (
        sharing.open_session(asked.out, made_with, owner, after, begun, pictures) as session,
        prefetch.smoke(shot, smoke_frames(shot, pictures), progress, tell) as ready,
    ):
        for camera, group in itertools.groupby(pictures, key=lambda picture: picture.camera):
            if stage.camera(camera) is None:
                raise Error(f'the camera "{camera}" is not in the scene {scene}; build the cameras again')
            wanted, alone = list(group), for_view(shot, camera)
            engine.set_resolution(alone.settings, stage.scene)
            part = share(progress, done, frames, "rendering")
            renderer.render(alone, stage, session, wanted, part, ready, tell)
            done += count_frames(wanted)
        video.make(shot, session, progress)


def _with_scene_settings(shot: Shot, scene: Any) -> Shot:
    """Return the shot with engine and resolution of the Blender scene; a stereo picture stacks both eyes."""
    render, part = scene.render, scene.render.resolution_percentage / 100.0
    sides = render.resolution_x, render.resolution_y * (2 if render.use_multiview else 1)
    size = tuple(2 * max(round(side * part / 2), 8) for side in sides)
    engine = "cycles" if render.engine == "CYCLES" else "eevee"
    settings = shot.settings
    as_drawn = replace(settings.render, resolution=size, engine=engine)
    return Shot(replace(settings, render=as_drawn), shot.run)
