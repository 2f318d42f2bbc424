"""Frame renderer: writes files under temporary names and publishes them when their frame is complete."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from firetwin_core import sensor

from .. import files, memory
from ..blender.owned import Stage
from ..errors import writing
from ..imaging.credits import Credits
from ..progress import MessageCallback, Progress, no_message, silent
from ..shot import exr_tags, passes
from ..shot.cameras import pixel_rays
from ..shot.cameras.path import compass
from ..shot.settings import mount
from ..shot.shot import Shot
from ..smoke.prefetch import Smoke
from . import (
    credits,
    cycles_status,
    engine,
    exr_clock,
    frame_cost,
    integrated,
    layers,
    manifest,
    plan,
    png,
    spherical,
    verify,
)
from .picture import Picture
from .sharing import FrameQueue, RenderSession
from .store import describe

Ready = Callable[[int, list[int]], Smoke | None]


def render(
    shot: Shot,
    stage: Stage,
    session: RenderSession,
    wanted: list[Picture],
    progress: Progress = silent,
    ready: Ready = lambda frame, ahead: None,
    tell: MessageCallback = no_message,
) -> int:
    """Render the pictures of a built scene without a lease of another render, and enter them in the store.

    Parameters
    ----------
    progress
        Its note is the picture of the last frame, relative to the output folder. Frames leased by other
        renders count as not done, even at the end.
    ready
        Called before each frame, with the frames after it. When it returns, the frame's smoke is on disk, or
        is the returned value (see `smoke.prefetch`).
    tell
        Receives warnings about the pictures.

    Returns
    -------
    Number of frames that this render finished.
    """
    engine.set_metadata(shot.run, stage.scene)
    engine.check_working_space()
    rendered, note, stops = 0, "", set[float]()
    marched = integrated.applies(shot, stage.scene) and bool(plan.rendered(shot, wanted))
    cost = frame_cost.FrameCost()
    renderer = integrated.IntegratedRenderer(shot, stage, cost) if marched else None
    with (
        session.leases.part_folder() as part,
        session.queue(wanted, tell) as queue,
        cycles_status.reported(tell),
    ):
        while queue.step():
            progress(queue.done, queue.total, "rendering", note)
            with cost.part(frame_cost.FRAME):
                finished = _frame(shot, stage, session, part, queue, ready, renderer, cost)
            if finished:
                rendered, note = rendered + 1, _preview(finished)
                if _are_exposed(finished):
                    stops.add(engine.exposure(stage.scene))
                if rendered == 1:
                    _tell_costs(cost, queue.camera, stops, tell)
            memory.release_freed()
        progress(queue.done, queue.total, "rendering", note)
    for text in renderer.warnings() if renderer else ():
        tell(text)
    if rendered > 1:
        _tell_costs(cost, wanted[0].camera, stops, tell)
    if rendered:
        session.store.add_cost(wanted[0].camera, cost.mean())
    return rendered


def _are_exposed(pictures: list[Picture]) -> bool:
    return any(passes.known()[picture.name].is_exposed for picture in pictures)


def _tell_costs(
    cost: frame_cost.FrameCost, camera: str, stops: Collection[float], tell: MessageCallback
) -> None:
    """Describe the time and the exposure of the frames so far."""
    tell(cost.sentence())
    if stops:
        tell(engine.describe_exposure(camera, stops))


def _frame(
    shot: Shot,
    stage: Stage,
    session: RenderSession,
    part: Path,
    queue: FrameQueue,
    ready: Ready,
    renderer: integrated.IntegratedRenderer | None,
    cost: frame_cost.FrameCost,
) -> list[Picture]:
    """Render and publish the queue's current frame; empty if another render took over its lease.

    The memory of the frame is freed on return.
    """
    with cost.part(frame_cost.SMOKE):
        smoke = ready(queue.frame, queue.ahead)
    memory.release_freed()
    try:
        frame = _Frame(shot, stage, session, part, queue.camera, queue.frame)
        frame.draw = renderer.frame_renderer(smoke or (), part) if renderer else frame.draw_layers
        finished = frame.render(queue.names)
    except Exception:
        if queue.holds_lease():
            raise
        return []  # the new holder of the lease renders the frame
    if not queue.holds_lease():
        return []
    with cost.part(frame_cost.FILES):
        publish(shot, session, part, finished, frame.words, engine.exposure(stage.scene))
    return finished


def _preview(pictures: list[Picture]) -> str:
    """Choose a file as preview of a frame, relative to the output folder: a PNG if there is one."""
    names = [name for picture in pictures for name in picture.files()]
    return next((name for name in names if name.endswith(".png")), names[0])


class _Frame:
    """One frame of one camera."""

    def __init__(
        self,
        shot: Shot,
        stage: Stage,
        session: RenderSession,
        part: Path,
        camera: str,
        frame: int,
    ) -> None:
        self.shot, self.scene, self.session, self.part = shot, stage.scene, session, part
        self.camera, self.frame = camera, frame
        self.draw: Callable[[list[Picture]], None] = self.draw_layers
        self.pictures = {name: Picture(camera, frame, name) for name in passes.known()}
        self.scene.camera = stage.camera(camera)
        self.scene.frame_set(frame)
        self.words = credits.read_scene(stage)

    def render(self, names: list[str]) -> list[Picture]:
        """Write the files of these passes, and of the passes they need, into the temporary folder."""
        passes_by_name = passes.known()
        taken = {
            name: mount.taken(self.shot.settings, self.shot.cameras, self.camera, passes_by_name[name])
            for name in names
        }
        own = {name for needs in taken.values() for camera, name in needs.values() if camera == self.camera}
        store, made_with = self.session.store, self.session.made_with
        missing = {need for need in own - set(names) if plan.missing(store, [self.pictures[need]], made_with)}
        drawn = [passes_by_name[name] for name in passes_by_name if name in names or name in missing]
        unpublished = {self.pictures[drawn_pass.name] for drawn_pass in drawn}
        self.draw([self.pictures[drawn_pass.name] for drawn_pass in drawn if passes.is_rendered(drawn_pass)])
        for drawn_pass in drawn:
            if drawn_pass.finished:
                pairs = taken.get(drawn_pass.name, {})
                there = {
                    need: self.files(Picture(c, self.frame, name), unpublished)
                    for need, (c, name) in pairs.items()
                }
                mine = self.files(self.pictures[drawn_pass.name], unpublished)
                with writing(mine[drawn_pass.files[0]]):
                    passes.finish(drawn_pass.name, mine, there, self.shot, self.camera, self.frame)
            self._credit(drawn_pass)
        return [self.pictures[name] for name in names]

    def _credit(self, drawn: passes.Pass) -> None:
        """Draw the credits of tiles into a pass's picture."""
        if drawn.film:
            own = manifest.read_credits(self.session.made_with.get((self.camera, drawn.name), {}))
            path = self.part / Path(self.pictures[drawn.name].file("png")).name
            around = self.shot.camera(self.camera).rig.around
            credits.burn(path, own.merge(self.words), self.scene.render.stamp_note_text, around)

    def draw_layers(self, pictures: list[Picture]) -> None:
        """Render the view layers of these passes, with smoke."""
        kinds = defaultdict(list)
        for picture in pictures:
            known = layers.rendered(picture.name)
            kinds[known.pixel_centres, known.through_smoke].append(picture)
        for (centres, through_smoke), group in sorted(kinds.items()):
            names = [each.name for each in group]
            layers.select(self.scene, names)
            layers.write_exr(self.scene, str(self.part), group)
            still = next((each for each in group if layers.has_still(passes.known()[each.name])), None)
            if still:
                self.scene.render.filepath = str(self.part / Path(still.file("png")).name)
            steps = engine.long_steps(self.scene, through_smoke)
            with steps, engine.pixel_centres(self.scene, centres), layers.black_materials(self.scene, names):
                bpy.ops.render.render(write_still=still is not None, scene=self.scene.name)
        for picture in pictures:
            self._tag(picture)

    def _tag(self, picture: Picture) -> None:
        """Write the EXR of a pass that has no `finish` again, with our attributes."""
        known, file = layers.rendered(picture.name), self.part / Path(picture.file("exr")).name
        if known.finished:
            return
        pixels = sensor.read_image(file)[..., :3]
        if known.shading == "light":
            stops = engine.exposure(self.scene)
            exr_tags.write_radiance(file, pixels, self.shot, self.camera, self.frame, stops)
        else:
            sensor.write_image(file, pixels, exr_tags.attributes(self.shot, self.camera, self.frame))

    def files(self, picture: Picture, unpublished: set[Picture]) -> dict[str, Path]:
        """Return files by suffix: temporary ones for a picture in `unpublished`, else published ones."""
        out = self.session.store.out
        paths = map(Path, picture.files())
        return {
            path.suffix[1:]: self.part / path.name if picture in unpublished else out / path for path in paths
        }


def publish(
    shot: Shot,
    session: RenderSession,
    part: Path,
    pictures: list[Picture],
    words: Credits | None = None,
    stops: float | None = None,
) -> None:
    """Verify the files of a complete frame, rename them into place and enter them in the store.

    Parameters
    ----------
    words
        Credits of tiles in the scene, in addition to the fingerprint's.
    stops
        Exposure of the frame, for entries of passes in visible light; None: unknown.

    Raises
    ------
    InputError
        A file is damaged, or another render writes these pictures with other settings.
    """
    session.check_others()
    paths = {name: part / Path(name).name for each in pictures for name in each.files()}
    for picture, name in ((each, name) for each in pictures for name in each.files()):
        path, size = paths[name], passes.known()[picture.name].size(shot.settings.render.resolution)
        if path.suffix == ".png" and path.exists():
            with writing(path):
                png.remove_render_times(path)
                if shot.camera(picture.camera).rig.around:
                    spherical.still(path, size, _heading(shot, picture))
        verify.picture(path, size)
    for picture in pictures:
        entries = {}
        about: dict[str, Any] = manifest.credit_entry(session.made_with[picture.camera, picture.name], words)
        if stops is not None and passes.known()[picture.name].is_exposed:
            about[manifest.EXPOSURE] = stops
        for name in picture.files():
            entries[name] = describe(paths[name]) | {
                "camera": picture.camera,
                "pass": picture.name,
                "frame": picture.frame,
                "time": shot.utc(picture.frame).isoformat(timespec="seconds"),
                **({exr_clock.KEY: exr_clock.value(shot)} if name.endswith(".exr") else {}),
                **about,
            }
            files.publish(paths[name], session.store.out / name)
        session.enter(picture, entries)


def _heading(shot: Shot, picture: Picture) -> float:
    """Compute the heading of a picture's centre, degrees clockwise from north."""
    view = pixel_rays.path_of(shot.paths, picture.camera)
    east, north, _ = compass(shot.local_frame, view.position[picture.frame - 1])
    ahead = -view.rotation[picture.frame - 1][:, 2]
    return float(np.degrees(np.arctan2(ahead @ east, ahead @ north)))
